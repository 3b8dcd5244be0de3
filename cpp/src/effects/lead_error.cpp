#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

EffectPtr lead_error(const Context& context) {
  std::vector<Shape> shapes;
  const PerLeg middle_mm = mid_travel_mm(context.machine);
  for (int k = 0; k < kLegs; ++k) {
    const double mid_mm = middle_mm[k];
    shapes.push_back(
        {[k, mid_mm](const SampleBlock& block) -> BlockColumn { return block.slider_mm(k).array() - mid_mm; },
         {{k, port::kSlider + k, 1.0}}});
  }
  EffectInfo info = {
      .name = "lead_error",
      .group = group::kCatalogue,
      .physics =
          "The screw's lead is longer than nominal: a slider goes too far in proportion to its distance from "
          "mid-travel, from where the error is counted because its constant part is slider_offset.",
      .formula = "slider = lead (s - mid-travel)",
      .source = "ISO 3408-3, specified travel deviation",
      .element_kind = "slider",
      .elements = kSixElements,
      // A rolled screw of tolerance class T10 may err by 210 um over 300 mm.
      .parameters = {{.name = "lead", .unit = "mm/mm", .prior_sigma = 5e-4, .limit = 1e-2}},
      .ports = {"slider"},
  };
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb::effects
