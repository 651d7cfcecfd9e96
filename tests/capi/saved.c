/* Saved runs: to the same bits from any increment, and damaged ones are refused. */
#include <stdlib.h>

#include "check.h"

enum { n = 24, nodes = n * n, increments = 4 };

static unsigned char *save(brn_run *run, size_t *size) {
  unsigned char *data;
  size_t written = 0;
  CHECK_STATUS(BRN_OK, brn_run_save(run, NULL, 0, size));
  data = malloc(*size + 1);
  memset(data, 0x5a, *size + 1);
  CHECK_STATUS(BRN_SHORT_BUFFER, brn_run_save(run, data, *size - 1, &written));
  CHECK(written == *size && data[0] == 0x5a && data[*size - 1] == 0x5a);
  CHECK_STATUS(BRN_OK, brn_run_save(run, data, *size, &written));
  CHECK(written == *size && data[*size] == 0x5a);
  return data;
}

static void results(brn_run *run, double *pressure, brn_increment *last) {
  size_t count = 0;
  CHECK(brn_run_solved_increments(run) == increments);
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_PRESSURE, pressure, nodes, &count));
  brn_increment_init(last);
  CHECK_STATUS(BRN_OK, brn_run_get_increment(run, increments - 1, last));
}

static void a_run_resumes_from_any_increment(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, increments);
  static double expected[nodes], pressure[nodes];
  brn_increment whole, resumed;
  brn_run *run = NULL;
  int done;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  results(run, expected, &whole);
  brn_run_destroy(run);

  for (done = 0; done <= increments; ++done) {
    size_t size = 0;
    unsigned char *data;
    brn_engine *other = plain_engine(1); /* another process would have its own, with other threads */
    int k;
    CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
    for (k = 0; k < done; ++k) CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
    data = save(run, &size);
    brn_run_destroy(run);
    CHECK_STATUS(BRN_OK, brn_run_load(other, scene, data, size, &run));
    free(data);
    CHECK(brn_run_solved_increments(run) == done);
    CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
    results(run, pressure, &resumed);
    CHECK(memcmp(expected, pressure, sizeof expected) == 0);
    CHECK(whole.approach == resumed.approach && whole.iterations == resumed.iterations);
    CHECK(whole.penetration == resumed.penetration && whole.contact_nodes == resumed.contact_nodes);
    brn_run_destroy(run);
    brn_engine_destroy(other);
  }
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void refused(brn_engine *engine, brn_scene *scene, const void *data, size_t size) {
  int target = 0;
  brn_run *run = (brn_run *)(void *)&target;
  CHECK_STATUS(BRN_DAMAGED_DATA, brn_run_load(engine, scene, data, size, &run));
  CHECK(run == NULL);
  CHECK(strlen(brn_last_message()) > 0);
}

static void damaged_data_are_refused(void) {
  brn_engine *engine = plain_engine(1);
  brn_scene *scene = sphere_scene(n, increments), *other = sphere_scene(n, increments + 1);
  brn_run *run = NULL;
  unsigned char *data;
  size_t size = 0, k;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_advance(run, NULL, NULL));
  data = save(run, &size);
  brn_run_destroy(run);

  refused(engine, scene, data, 0);
  for (k = 1; k < size; k = k < 200 ? k + 1 : k + size / 37) refused(engine, scene, data, k); /* truncated */
  refused(engine, scene, data, size - 1);
  for (k = 0; k < size; k = k < 200 ? k + 1 : k + size / 53) { /* one bit altered */
    data[k] ^= 0x10;
    refused(engine, scene, data, size);
    data[k] ^= 0x10;
  }
  refused(engine, scene, data, size + 1);
  refused(engine, other, data, size);
  CHECK_STATUS(BRN_OK, brn_run_load(engine, scene, data, size, &run)); /* whole again */
  brn_run_destroy(run);
  free(data);
  brn_scene_destroy(other);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

int main(void) {
  a_run_resumes_from_any_increment();
  damaged_data_are_refused();
  return check_report();
}
