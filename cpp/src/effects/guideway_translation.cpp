#include "catalogue.hpp"
#include "constant_effect.hpp"
#include "elements.hpp"
#include "geometric_sizes.hpp"

namespace hexdbb::effects {

EffectPtr guideway_translation(const Context& context) {
  std::vector<Link> links;
  for (int k = 0; k < kLegs; ++k) {
    const Matrix3 axes = guideway_axes(context.machine, guideway_of(k));
    for (int local = 0; local < 3; ++local) {
      for (int base = 0; base < 3; ++base) {
        links.push_back({3 * guideway_of(k) + local, port::kSliderJoint + 3 * k + base, axes(base, local)});
      }
    }
  }
  EffectInfo info = {
      .name = "guideway_translation",
      .group = group::kGeometry,
      .physics = "A guideway is displaced: x outward from the base centre, y towards its vertex, z up.",
      .formula = "slider_joint = (x, y, z) in the guideway's axes",
      .source = "thesis 3.2 (3) 1, Figure 3.2 (a)",
      .element_kind = "guideway",
      .elements = kThreeElements,
      .parameters = {length("x"), length("y"), length("z")},
      .ports = {"slider_joint"},
  };
  return std::make_shared<ConstantEffect>(std::move(info), std::move(links));
}

}  // namespace hexdbb::effects
