/* Threads of the caller: a handle in use refuses a second thread, messages belong to the thread, the number of the
 * engine's threads leaves no trace in the bits, and runs on one engine do not disturb each other. */
#include <pthread.h>

#include "check.h"

enum { n = 48, nodes = n * n };

typedef struct {
  brn_run *run;
  brn_status from_second_thread, from_callback;
  int asked;
} intrusion;

static void *use_the_busy_run(void *argument) {
  intrusion *state = argument;
  state->from_second_thread = brn_run_advance(state->run, NULL, NULL);
  CHECK(strlen(brn_run_message(state->run)) > 0);
  return NULL;
}

static int32_t let_another_in(const brn_progress *progress, void *user) {
  intrusion *state = user;
  pthread_t thread;
  (void)progress;
  if (state->asked++ > 0) return 0;
  CHECK(pthread_create(&thread, NULL, use_the_busy_run, state) == 0);
  pthread_join(thread, NULL);
  state->from_callback = brn_run_advance(state->run, NULL, NULL);
  return 0;
}

static void a_busy_run_refuses_a_second_thread(void) {
  brn_engine *engine = plain_engine(2);
  brn_scene *scene = sphere_scene(n, 2);
  intrusion state = {NULL, BRN_OK, BRN_OK, 0};
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &state.run));
  CHECK_STATUS(BRN_OK, brn_run_execute(state.run, let_another_in, &state));
  CHECK(state.asked > 0);
  CHECK(state.from_second_thread == BRN_WRONG_STATE);
  CHECK(state.from_callback == BRN_WRONG_STATE);
  CHECK(brn_run_solved_increments(state.run) == 2);
  brn_run_destroy(state.run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static int32_t on_the_calling_thread(const brn_progress *progress, void *user) {
  (void)progress;
  CHECK(pthread_equal(*(const pthread_t *)user, pthread_self()));
  return 0;
}

static void progress_comes_on_the_calling_thread(void) {
  brn_engine *engine = plain_engine(4);
  brn_scene *scene = sphere_scene(n, 2);
  brn_run *run = NULL;
  pthread_t self = pthread_self();
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  CHECK_STATUS(BRN_OK, brn_run_execute(run, on_the_calling_thread, &self));
  brn_run_destroy(run);
  brn_scene_destroy(scene);
  brn_engine_destroy(engine);
}

static void *fail_elsewhere(void *scene) {
  const brn_grid grid = square_grid(-17, 1.0);
  CHECK(strcmp(brn_last_message(), "") == 0); /* nothing has failed on this thread */
  CHECK(strcmp(brn_scene_message(scene), "") == 0);
  CHECK(brn_scene_set_grid(scene, &grid) == BRN_INVALID_ARGUMENT);
  CHECK_SAYS(brn_scene_message(scene), "-17");
  CHECK(brn_scene_create(NULL) == BRN_INVALID_ARGUMENT);
  return NULL;
}

static void messages_belong_to_the_thread(void) {
  brn_scene *scene = sphere_scene(8, 1);
  brn_step step = force_step(-23.5, 1);
  pthread_t thread;
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_scene_add_step(scene, &step));
  CHECK_STATUS(BRN_INVALID_ARGUMENT, brn_engine_create(NULL, NULL));
  CHECK_SAYS(brn_last_message(), "out");
  CHECK(pthread_create(&thread, NULL, fail_elsewhere, scene) == 0);
  pthread_join(thread, NULL);
  CHECK_SAYS(brn_scene_message(scene), "-23.5");
  CHECK_SAYS(brn_last_message(), "out");
  brn_scene_destroy(scene);
}

static void solve(brn_engine *engine, int64_t size, double *pressure) {
  brn_scene *scene = sphere_scene(size, 2);
  brn_run *run = NULL;
  size_t count = 0;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  brn_scene_destroy(scene);
  CHECK_STATUS(BRN_OK, brn_run_execute(run, NULL, NULL));
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, BRN_FIELD_PRESSURE, pressure, nodes, &count));
  brn_run_destroy(run);
}

static void the_number_of_threads_leaves_the_bits_alone(void) {
  static const int32_t threads[] = {1, 2, 3, 8};
  static double expected[nodes], pressure[nodes];
  size_t k;
  for (k = 0; k < sizeof threads / sizeof *threads; ++k) {
    brn_engine *engine = plain_engine(threads[k]);
    solve(engine, n, k == 0 ? expected : pressure);
    if (k > 0) CHECK(memcmp(expected, pressure, sizeof expected) == 0);
    brn_engine_destroy(engine);
  }
}

typedef struct {
  brn_engine *engine;
  int64_t size;
  double pressure[nodes];
} job;

static void *solve_job(void *argument) {
  job *work = argument;
  int k;
  for (k = 0; k < 3; ++k) solve(work->engine, work->size, work->pressure);
  return NULL;
}

static void runs_on_one_engine_are_independent(void) {
  static job jobs[4];
  static double expected[nodes];
  pthread_t threads[4];
  brn_engine *engine = plain_engine(2);
  int k;
  for (k = 0; k < 4; ++k) { /* two grids, so that the caches are shared and filled by both */
    jobs[k].engine = engine;
    jobs[k].size = k % 2 == 0 ? n : n - 7;
    CHECK(pthread_create(&threads[k], NULL, solve_job, &jobs[k]) == 0);
  }
  for (k = 0; k < 4; ++k) pthread_join(threads[k], NULL);
  for (k = 0; k < 4; ++k) {
    memset(expected, 0, sizeof expected);
    solve(engine, jobs[k].size, expected);
    CHECK(memcmp(expected, jobs[k].pressure, sizeof expected) == 0);
  }
  brn_engine_destroy(engine);
}

int main(void) {
  a_busy_run_refuses_a_second_thread();
  progress_comes_on_the_calling_thread();
  messages_belong_to_the_thread();
  the_number_of_threads_leaves_the_bits_alone();
  runs_on_one_engine_are_independent();
  return check_report();
}
