#include "catalogue.hpp"
#include "constant_effect.hpp"
#include "elements.hpp"
#include "geometric_sizes.hpp"

namespace hexdbb::effects {

EffectPtr leg_length(const Context&) {
  return one_to_one({.name = "leg_length",
                     .group = group::kGeometry,
                     .physics = "A leg is longer than nominal.",
                     .formula = "leg = longer",
                     .source = "thesis 3.2 (1)",
                     .element_kind = "leg",
                     .elements = kSixElements,
                     .parameters = {length("longer")},
                     .ports = {"leg"}},
                    port::kLeg);
}

}  // namespace hexdbb::effects
