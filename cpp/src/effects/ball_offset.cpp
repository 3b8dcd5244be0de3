#include "catalogue.hpp"
#include "constant_effect.hpp"
#include "elements.hpp"
#include "set_up_sizes.hpp"

namespace hexdbb::effects {

EffectPtr ball_offset(const Context&) {
  return one_to_one({.name = "ball_offset",
                     .group = group::kSetUp,
                     .physics = "The bar's ball is not where planned on the platform.",
                     .formula = "ball = (x, y, z), platform frame",
                     .source = "set-up",
                     .element_kind = "machine",
                     .elements = kWhole,
                     .parameters = {place("x"), place("y"), place("z")},
                     .ports = {"ball"},
                     .is_set_up = true},
                    port::kBall);
}

}  // namespace hexdbb::effects
