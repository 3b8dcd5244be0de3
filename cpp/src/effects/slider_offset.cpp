#include "catalogue.hpp"
#include "constant_effect.hpp"
#include "elements.hpp"
#include "geometric_sizes.hpp"

namespace hexdbb::effects {

EffectPtr slider_offset(const Context&) {
  return one_to_one({.name = "slider_offset",
                     .group = group::kGeometry,
                     .physics = "A slider is further along its guideway than it reports.",
                     .formula = "slider = offset",
                     .source = "thesis 3.2 (2)",
                     .element_kind = "slider",
                     .elements = kSixElements,
                     .parameters = {length("offset")},
                     .ports = {"slider"}},
                    port::kSlider);
}

}  // namespace hexdbb::effects
