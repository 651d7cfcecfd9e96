// The rigid sphere on steel of the profile nanoindentation.
#pragma once

#include "plastic/hardening.h"

namespace brinell::physics {

constexpr double kYoung = 210e9, kPoisson = 0.3;
constexpr double kModulus = kYoung / (1 - kPoisson * kPoisson);  // against a rigid body
constexpr double kRadius = 105e-6;
inline const plastic::Swift kSteel{1240e6, 30, 0.085, 1e6};

}  // namespace brinell::physics
