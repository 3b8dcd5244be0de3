// The gain acts on the true reading: the nominal one (what the programme asks of the bar) plus that of the errors,
// which is a thousandth of a tenth of a millimetre and is absorbed by geometry. The measured reading must not replace
// the nominal one: the gain could then explain whatever the model misses.
#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

EffectPtr bar_gain(const Context&) {
  Shape in_proportion{
      [](const SampleBlock& block) -> BlockColumn { return block.of(block.samples.state.nominal_reading_mm).array(); },
      {{0, port::kReading, 1.0}}};
  EffectInfo info = {
      .name = "bar_gain",
      .group = group::kCatalogue,
      .physics =
          "The gauge reads too much in proportion to its deflection, here that of the nominal machine; it is "
          "distinguishable from geometry only where a circle is run off its nominal radius.",
      .formula = "reading = gain x nominal_reading",
      .source = "gauge scale error",
      .element_kind = "machine",
      .elements = kWhole,
      // Gauges are calibrated to some tenths of a percent.
      .parameters = {{.name = "gain", .unit = "1", .prior_sigma = 5e-3, .limit = 0.2}},
      .ports = {"reading"},
      .needs = {"nominal_reading_mm"},
      .is_set_up = true,
  };
  return std::make_shared<LinearEffect>(std::move(info), std::vector<Shape>{std::move(in_proportion)});
}

}  // namespace hexdbb::effects
