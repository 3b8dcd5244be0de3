#include "catalogue.hpp"
#include "guideway_rotation.hpp"

namespace hexdbb::effects {

EffectPtr guideway_rotation_xy(const Context& context) {
  return rotation_about_midpoint({.name = "guideway_rotation_xy",
                                  .physics = "A guideway is rotated about the vertical through its midpoint.",
                                  .formula = "slider_joint = (Rot(z, angle) - 1)(B - midpoint)",
                                  .source = "thesis 3.2 (3) 2, Figure 3.2 (b)"},
                                 context.machine, 2);
}

}  // namespace hexdbb::effects
