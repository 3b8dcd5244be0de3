#include "catalogue.hpp"
#include "constant_effect.hpp"
#include "elements.hpp"
#include "fitted_sizes.hpp"

namespace hexdbb::effects {

EffectPtr joint_offset(const Context&) {
  return one_to_one(
      {.name = "joint_offset",
       .group = group::kCatalogue,
       .physics = "A leg's ball centre misses the joint centre it should share with its neighbour, in the platform's "
                  "axes; to first order the two legs of a pair have the same signature.",
       .formula = "platform_joint = (x, y, z), platform frame",
       .source = "6-6 platform: the joints of a pair no longer coincide",
       .element_kind = "leg",
       .elements = kSixElements,
       .parameters = {fitted_by_hand("x"), fitted_by_hand("y"), fitted_by_hand("z")},
       .ports = {"platform_joint"}},
      port::kPlatformJoint);
}

}  // namespace hexdbb::effects
