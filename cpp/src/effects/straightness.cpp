#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

EffectPtr straightness(const Context& context) {
  const Machine& machine = context.machine;
  std::vector<Shape> shapes;
  for (int k = 0; k < kLegs; ++k) {
    const Matrix3 axes = guideway_axes(machine, guideway_of(k));
    const Travel travel = guideway_travel(machine, guideway_of(k));
    std::vector<Link> links;
    for (int base = 0; base < 3; ++base) {
      const int port = port::kSliderJoint + 3 * k + base;
      links.push_back({2 * guideway_of(k), port, axes(base, 0)});
      links.push_back({2 * guideway_of(k) + 1, port, axes(base, 2)});
    }
    shapes.push_back({[k, travel](const SampleBlock& block) -> BlockColumn {
                        return 1.0 - ((block.slider_mm(k).array() - travel.middle_mm) / travel.half_mm).square();
                      },
                      std::move(links)});
  }
  EffectInfo info = {
      .name = "straightness",
      .group = group::kCatalogue,
      .physics =
          "A guideway is bowed, outward and up: a parabola over the travel, zero at its ends, that displaces both "
          "sliders; its mean and slope are guideway_translation and guideway_rotation.",
      .formula = "slider_joint = (lateral, vertical) (1 - u^2), u = (s - mid-travel) / half travel of the guideway",
      .source = "ISO 230-1, straightness; parabola as the bow of a beam",
      .element_kind = "guideway",
      .elements = kThreeElements,
      // A rail screwed to a frame that was not scraped: tenths of a millimetre over its length.
      .parameters = {{.name = "lateral", .unit = "mm", .prior_sigma = 0.3, .limit = 5.0},
                     {.name = "vertical", .unit = "mm", .prior_sigma = 0.3, .limit = 5.0}},
      .ports = {"slider_joint"},
  };
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb::effects
