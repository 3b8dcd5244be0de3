// The physical causes beyond geometry and set-up, one function each; grouped in sources by where they arise.
#pragma once

#include "hexdbb/effect.hpp"

namespace hexdbb {

inline const std::vector<std::string> kSixElements = {"1", "2", "3", "4", "5", "6"};
inline const std::vector<std::string> kThreeElements = {"1", "2", "3"};
inline const std::vector<std::string> kWhole = {"1"};

constexpr double kSecondsPerHour = 3600.0;

/// Slider coordinate at mid-travel.
inline double mid_travel_mm(const Machine& machine) { return 0.5 * (machine.travel_min_mm + machine.travel_max_mm); }

// reversal_effects.cpp
EffectPtr backlash();
EffectPtr reversal_spike();

// drive_effects.cpp
EffectPtr pitch_cyclic(const Machine& machine);
EffectPtr lead_error(const Machine& machine);
EffectPtr servo_lag();

// thermal_effects.cpp
EffectPtr leg_thermal();
EffectPtr screw_thermal(const Machine& machine);

// structure_effects.cpp
EffectPtr straightness(const Machine& machine);
EffectPtr gravity_sag(const Machine& machine);
EffectPtr joint_offset();

// measuring_effects.cpp
EffectPtr bar_drift();
EffectPtr bar_gain();
EffectPtr sample_delay();
EffectPtr ball_eccentricity(int mounts);

}  // namespace hexdbb
