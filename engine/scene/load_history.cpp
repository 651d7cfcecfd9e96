#include "scene/load_history.h"

namespace brinell::scene {

std::int32_t total_increments(const std::vector<Step>& steps) {
  std::int32_t total = 0;
  for (const Step& step : steps) total += step.increments;
  return total;
}

Position position_of(const std::vector<Step>& steps, std::int32_t n) {
  Position position{0, n};
  while (position.increment >= steps[static_cast<std::size_t>(position.step)].increments) {
    position.increment -= steps[static_cast<std::size_t>(position.step)].increments;
    ++position.step;
  }
  return position;
}

contact::Load load_of(const Step& step, std::int32_t increment, const Origin& origin, const Grid& grid) {
  const bool approach = step.drive == StepDrive::approach;
  const double area =
      step.drive == StepDrive::mean_pressure ? static_cast<double>(grid.nodes()) * grid.cell_area() : 1;
  const double begin = approach ? origin.approach : origin.force;
  const double end = step.target * area;
  const bool last = increment + 1 == step.increments;
  const double part = static_cast<double>(increment + 1) / static_cast<double>(step.increments);
  contact::Load load;
  load.drive = approach ? contact::Drive::approach : contact::Drive::force;
  load.target = last ? end : begin + (end - begin) * part;
  load.moments = step.free_rotation;
  if (load.moments) {
    load.force_x = step.eccentricity[0];
    load.force_y = step.eccentricity[1];
  } else {
    load.slope_x = step.tilt[0];
    load.slope_y = step.tilt[1];
  }
  return load;
}

}  // namespace brinell::scene
