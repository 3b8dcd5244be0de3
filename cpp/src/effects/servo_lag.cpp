#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

EffectPtr servo_lag(const Context&) {
  std::vector<Shape> shapes;
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back({[k](const SampleBlock& block) -> BlockColumn {
                        return block.of(block.samples.state.velocity_mm_s, k).array();
                      },
                      {{k, port::kSlider + k, -1.0}}});
  }
  EffectInfo info = {
      .name = "servo_lag",
      .group = group::kCatalogue,
      .physics =
          "A slider lags behind its drive's encoder in proportion to its speed; unlike backlash it vanishes at "
          "slow feed, unlike sample_delay each slider has its own.",
      .formula = "slider = -lag x velocity",
      .source = "first-order lag",
      .element_kind = "slider",
      .elements = kSixElements,
      // Following errors that the encoder sees are in the reported coordinates already. What remains between encoder
      // and slider is compliance and filtering: milliseconds.
      .parameters = {{.name = "lag", .unit = "s", .prior_sigma = 2e-3, .limit = 0.1, .is_nonnegative = true}},
      .ports = {"slider"},
      .needs = {"velocity_mm_s"},
  };
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb::effects
