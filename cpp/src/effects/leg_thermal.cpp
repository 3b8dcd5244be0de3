#include "catalogue.hpp"
#include "thermal_growth.hpp"

namespace hexdbb::effects {

EffectPtr leg_thermal(const Context&) {
  EffectInfo info = {
      .name = "leg_thermal",
      .group = group::kCatalogue,
      .physics =
          "All legs grow alike with the measured temperature, otherwise with time, faster at first; unlike "
          "leg_length the error changes during the test, unlike bar_drift it moves the platform.",
      .formula =
          "leg = per_kelvin x warming; without a temperature per_time tau (1 - exp(-t / tau)), "
          "tau = 30 min x exp(log_time)",
      .source = "thermal expansion, ISO 230-3",
      .element_kind = "machine",
      .elements = kWhole,
      // 400 mm of steel grow by 4.6 um/K, of aluminium by 9; a machine warms up by some 5 K in its first hour.
      .parameters =
          {{.name = "per_kelvin", .unit = "mm/K", .prior_sigma = 0.01, .limit = 0.5},
           {.name = "per_time", .unit = "mm/s", .prior_sigma = 0.1 / kSecondsPerHour, .limit = 2.0 / kSecondsPerHour},
           {.name = "log_time", .unit = "1", .prior_sigma = 1.0, .limit = 4.0, .is_shape = true}},
      .ports = {"leg"},
      .needs = {"time_s", "warming_k"},
  };
  return std::make_shared<ThermalGrowth>(std::move(info), ThermalGrowth::Part::kLegs);
}

}  // namespace hexdbb::effects
