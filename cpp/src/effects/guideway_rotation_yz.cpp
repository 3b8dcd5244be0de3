#include "catalogue.hpp"
#include "guideway_rotation.hpp"

namespace hexdbb::effects {

EffectPtr guideway_rotation_yz(const Context& context) {
  return rotation_about_midpoint(
      {.name = "guideway_rotation_yz",
       .physics = "A guideway is tilted in its vertical plane, about the outward axis through its midpoint.",
       .formula = "slider_joint = (Rot(outward, angle) - 1)(B - midpoint)",
       .source = "thesis 3.2 (3) 2, Figure 3.2 (b)"},
      context.machine, 0);
}

}  // namespace hexdbb::effects
