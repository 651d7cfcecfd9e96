/* Checks for the C tests of the interface, and the scene that most of them press: an elastic sphere under force. */
#ifndef BRINELL_TESTS_CHECK_H
#define BRINELL_TESTS_CHECK_H

#include <brinell.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int check_failures;

static inline void check_that(int holds, const char *what, const char *file, int line) {
  if (holds) return;
  printf("%s:%d: %s\n", file, line, what);
  ++check_failures;
}

static inline void check_status(brn_status expected, brn_status status, const char *call, const char *message,
                                const char *file, int line) {
  if (status == expected) return;
  printf("%s:%d: %s\n  gives %s (%s), expected %s\n", file, line, call, brn_status_name(status), message,
         brn_status_name(expected));
  ++check_failures;
}

/* The message contains each of the words, which are separated by '|'. */
static inline void check_says(const char *message, const char *words, const char *file, int line) {
  char list[256];
  char *word;
  snprintf(list, sizeof list, "%s", words);
  for (word = strtok(list, "|"); word != NULL; word = strtok(NULL, "|")) {
    if (strstr(message, word) == NULL) {
      printf("%s:%d: message \"%s\" does not mention \"%s\"\n", file, line, message, word);
      ++check_failures;
    }
  }
}

#define CHECK(condition) check_that((condition) != 0, #condition, __FILE__, __LINE__)
#define CHECK_STATUS(expected, call) check_status(expected, call, #call, brn_last_message(), __FILE__, __LINE__)
#define CHECK_SAYS(message, words) check_says(message, words, __FILE__, __LINE__)

static inline int check_report(void) {
  if (check_failures != 0) printf("%d checks failed\n", check_failures);
  return check_failures != 0;
}

static inline brn_grid square_grid(int64_t n, double spacing) {
  brn_grid grid;
  brn_grid_init(&grid);
  grid.nx = grid.ny = n;
  grid.dx = grid.dy = spacing;
  return grid;
}

static inline brn_body steel_body(void) {
  brn_body body;
  brn_body_init(&body);
  body.rigid = 0;
  body.youngs_modulus = 210e9;
  body.poissons_ratio = 0.3;
  return body;
}

static inline brn_shape sphere_shape(double radius) {
  brn_shape shape;
  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_SPHERE;
  shape.radius = radius;
  return shape;
}

static inline brn_step force_step(double force, int32_t increments) {
  brn_step step;
  brn_step_init(&step);
  step.drive = BRN_DRIVE_FORCE;
  step.target = force;
  step.increments = increments;
  return step;
}

/* A 1 mm sphere on n x n nodes of steel under 1 N: contact radius 14.8 um. */
static inline brn_scene *sphere_scene(int64_t n, int32_t increments) {
  brn_scene *scene = NULL;
  const brn_grid grid = square_grid(n, 48e-6 / (double)n);
  const brn_body body = steel_body();
  const brn_shape shape = sphere_shape(1e-3);
  const brn_step step = force_step(1.0, increments);
  CHECK_STATUS(BRN_OK, brn_scene_create(&scene));
  CHECK_STATUS(BRN_OK, brn_scene_set_grid(scene, &grid));
  CHECK_STATUS(BRN_OK, brn_scene_set_body(scene, BRN_LOWER, &body));
  CHECK_STATUS(BRN_OK, brn_scene_add_shape(scene, &shape));
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step));
  return scene;
}

static inline brn_engine *plain_engine(int32_t threads) {
  brn_engine *engine = NULL;
  brn_engine_options options;
  brn_engine_options_init(&options);
  options.threads = threads;
  CHECK_STATUS(BRN_OK, brn_engine_create(&options, &engine));
  return engine;
}

static inline brn_run *start(brn_engine *engine, brn_scene *scene) {
  brn_run *run = NULL;
  CHECK_STATUS(BRN_OK, brn_run_create(engine, scene, &run));
  return run;
}

static inline brn_increment increment_of(brn_run *run, int32_t index) {
  brn_increment result;
  brn_increment_init(&result);
  CHECK_STATUS(BRN_OK, brn_run_get_increment(run, index, &result));
  return result;
}

static inline void add(brn_scene *scene, brn_step step) {
  CHECK_STATUS(BRN_OK, brn_scene_add_step(scene, &step));
}

static inline brn_hardening linear_hardening(double yield_stress) {
  brn_hardening hardening;
  brn_hardening_init(&hardening);
  hardening.law = BRN_HARDENING_LINEAR;
  hardening.yield_stress = yield_stress;
  hardening.hardening_modulus = 5e9;
  return hardening;
}

static inline void read_field(brn_run *run, int32_t field, double *values, size_t expected) {
  size_t count = 0;
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, field, values, expected, &count));
  CHECK(count == expected);
}

/* To be freed. */
static inline double *field_of(brn_run *run, int32_t field, size_t expected) {
  size_t count = 0;
  double *values = malloc((expected + 1) * sizeof *values);
  CHECK_STATUS(BRN_OK, brn_run_get_field(run, field, NULL, 0, &count));
  CHECK(count == expected);
  read_field(run, field, values, expected);
  return values;
}

static inline double largest(const double *values, size_t count) {
  double most = 0;
  size_t k;
  for (k = 0; k < count; ++k) {
    const double size = values[k] < 0 ? -values[k] : values[k];
    most = size > most ? size : most;
  }
  return most;
}

#endif
