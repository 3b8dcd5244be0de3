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

/// Slider coordinates at mid-travel.
inline PerLeg mid_travel_mm(const Machine& machine) {
  PerLeg out;
  for (int k = 0; k < kLegs; ++k) out[k] = slider_travel(machine, k).middle_mm;
  return out;
}

}  // namespace hexdbb::effects
