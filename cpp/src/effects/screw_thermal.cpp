#include "catalogue.hpp"
#include "thermal_growth.hpp"

namespace hexdbb::effects {

EffectPtr screw_thermal(const Context& context) {
  EffectInfo info = {
      .name = "screw_thermal",
      .group = group::kCatalogue,
      .physics =
          "A screw's lead grows with the measured temperature, otherwise with time, faster at first, counted from "
          "mid-travel; unlike lead_error it changes during the test, unlike leg_thermal it grows with the "
          "distance from mid-travel.",
      .formula =
          "slider = (s - mid-travel) per_kelvin x warming; without a temperature "
          "(s - mid-travel) per_time tau (1 - exp(-t / tau)), tau = 30 min x exp(log_time)",
      .source = "thermal expansion, ISO 230-3",
      .element_kind = "slider",
      .elements = kSixElements,
      // Steel: 11.5e-6 /K. A driven screw warms faster than the air beside it: twice that, or 5 K per hour; the limits
      // are a hundred times what a thermometer in the air shows.
      .parameters =
          {{.name = "per_kelvin", .unit = "1/K", .prior_sigma = 2e-5, .limit = 2e-3},
           {.name = "per_time", .unit = "1/s", .prior_sigma = 2e-4 / kSecondsPerHour, .limit = 4e-3 / kSecondsPerHour},
           {.name = "log_time", .unit = "1", .prior_sigma = 1.0, .limit = 4.0, .is_shape = true}},
      .ports = {"slider"},
      .needs = {"time_s", "warming_k"},
  };
  return std::make_shared<ThermalGrowth>(std::move(info), ThermalGrowth::Part::kScrews, mid_travel_mm(context.machine));
}

}  // namespace hexdbb::effects
