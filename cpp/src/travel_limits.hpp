// Limits of the sliders' coordinates.
#pragma once

#include "hexdbb/kinematics.hpp"

namespace hexdbb {

/// Set status and leg where a coordinate is outside its travel or two sliders are too close.
void check_limits(const Machine& machine, InverseResult& out);

}  // namespace hexdbb
