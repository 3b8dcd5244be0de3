// Labels of elements, and the quantities that several effects share.
#pragma once

#include <string>
#include <vector>

#include "hexdbb/machine.hpp"

namespace hexdbb::effects {

inline const std::vector<std::string> kSixElements = {"1", "2", "3", "4", "5", "6"};  // legs or sliders
inline const std::vector<std::string> kThreeElements = {"1", "2", "3"};               // guideways
inline const std::vector<std::string> kWhole = {"1"};                                 // the whole machine

constexpr double kSecondsPerHour = 3600.0;

/// Slider coordinate at mid-travel.
inline double mid_travel_mm(const Machine& machine) { return 0.5 * (machine.travel_min_mm + machine.travel_max_mm); }

}  // namespace hexdbb::effects
