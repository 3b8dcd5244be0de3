#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

EffectPtr bar_drift(const Context&) {
  Shape with_time{[](const SampleBlock& block) -> BlockColumn { return block.of(block.samples.state.time_s).array(); },
                  {{0, port::kReading, 1.0}}};
  EffectInfo info = {
      .name = "bar_drift",
      .group = group::kCatalogue,
      .physics =
          "The gauge's reading drifts steadily with time since the record began; unlike bar_length it changes "
          "during the test, unlike leg_thermal it is the same at every angle.",
      .formula = "reading = rate x time",
      .source = "ISO 230-4, thermal conditions of the instrument",
      .element_kind = "machine",
      .elements = kWhole,
      // A carbon-fibre bar held in a warm hand changes by 10 um in the hour after.
      .parameters =
          {{.name = "rate", .unit = "mm/s", .prior_sigma = 0.05 / kSecondsPerHour, .limit = 2.0 / kSecondsPerHour}},
      .ports = {"reading"},
      .needs = {"time_s"},
      .is_set_up = true,
  };
  return std::make_shared<LinearEffect>(std::move(info), std::vector<Shape>{std::move(with_time)});
}

}  // namespace hexdbb::effects
