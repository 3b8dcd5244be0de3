#include "catalogue.hpp"
#include "constant_effect.hpp"
#include "elements.hpp"

namespace hexdbb::effects {

// The gauge shows length minus nominal length: a longer bar reads less at the same distance of the balls. The bar is
// calibrated to a few um, hence fixed at first.
EffectPtr bar_length(const Context&) {
  return one_to_one({.name = "bar_length",
                     .group = group::kSetUp,
                     .physics = "The ball bar is longer than its calibration says.",
                     .formula = "reading = -longer",
                     .source = "set-up",
                     .element_kind = "machine",
                     .elements = kWhole,
                     .parameters = {{.name = "longer", .unit = "mm", .prior_sigma = 0.01, .limit = 1.0}},
                     .ports = {"reading"},
                     .is_set_up = true,
                     .is_free_at_first = false},
                    port::kReading, -1.0);
}

}  // namespace hexdbb::effects
