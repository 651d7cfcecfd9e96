// The interface as C++ sees it: handles in unique_ptr, a callback without captures, the size of the contact as Hertz
// has it (error of the grid: 40 nodes across the contact radius, below 1 %).
#include <brinell.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

namespace {

struct Destroy {
  void operator()(brn_engine *engine) const { brn_engine_destroy(engine); }
  void operator()(brn_scene *scene) const { brn_scene_destroy(scene); }
  void operator()(brn_run *run) const { brn_run_destroy(run); }
};

int failures = 0;

void check(bool holds, const char *what) {
  if (holds) return;
  std::printf("failed: %s (%s)\n", what, brn_last_message());
  ++failures;
}

}  // namespace

int main() {
  constexpr double kModulus = 210e9 / (1.0 - 0.3 * 0.3), kRadius = 1e-3, kForce = 1.0;
  const double contact_radius = std::cbrt(0.75 * kForce * kRadius / kModulus);

  brn_engine *raw_engine = nullptr;
  check(brn_engine_create(nullptr, &raw_engine) == BRN_OK, "engine");
  const std::unique_ptr<brn_engine, Destroy> engine(raw_engine);
  brn_scene *raw_scene = nullptr;
  check(brn_scene_create(&raw_scene) == BRN_OK, "scene");
  const std::unique_ptr<brn_scene, Destroy> scene(raw_scene);

  brn_grid grid;
  brn_grid_init(&grid);
  grid.nx = 128;
  grid.ny = 120;
  grid.dx = grid.dy = contact_radius / 40.0;
  brn_body body;
  brn_body_init(&body);
  body.rigid = 0;
  body.youngs_modulus = 210e9;
  body.poissons_ratio = 0.3;
  brn_shape shape;
  brn_shape_init(&shape);
  shape.kind = BRN_SHAPE_SPHERE;
  shape.radius = kRadius;
  brn_step step;
  brn_step_init(&step);
  step.drive = BRN_DRIVE_FORCE;
  step.target = kForce;
  check(brn_scene_set_grid(scene.get(), &grid) == BRN_OK, "grid");
  check(brn_scene_set_body(scene.get(), BRN_LOWER, &body) == BRN_OK, "body");
  check(brn_scene_add_shape(scene.get(), &shape) == BRN_OK, "shape");
  check(brn_scene_add_step(scene.get(), &step) == BRN_OK, "step");

  brn_run *raw_run = nullptr;
  check(brn_run_create(engine.get(), scene.get(), &raw_run) == BRN_OK, "run");
  const std::unique_ptr<brn_run, Destroy> run(raw_run);
  int calls = 0;
  const auto count_calls = [](const brn_progress *, void *user) -> std::int32_t {
    ++*static_cast<int *>(user);
    return 0;
  };
  check(brn_run_execute(run.get(), count_calls, &calls) == BRN_OK, "execute");
  check(calls > 0, "progress");

  brn_increment result;
  brn_increment_init(&result);
  check(brn_run_get_increment(run.get(), 0, &result) == BRN_OK, "increment");
  const double measured = std::sqrt(result.contact_area / 3.14159265358979323846);
  check(std::fabs(measured / contact_radius - 1.0) < 0.01, "contact radius");
  std::size_t count = 0;
  std::vector<double> pressure(static_cast<std::size_t>(grid.nx * grid.ny));
  check(brn_run_get_field(run.get(), BRN_FIELD_PRESSURE, pressure.data(), pressure.size(), &count) == BRN_OK,
        "pressure");
  check(count == pressure.size(), "size of the field");
  return failures == 0 ? 0 : 1;
}
