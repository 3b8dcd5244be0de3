#include "catalogue.hpp"
#include "guideway_rotation.hpp"

namespace hexdbb::effects {

EffectPtr guideway_rotation_centre(const Context& context) {
  EffectInfo info = rotation_info({.name = "guideway_rotation_centre",
                                   .physics = "A guideway is rotated about the vertical through the base centre.",
                                   .formula = "slider_joint = (Rot(z, angle) - 1) B",
                                   .source = "thesis 3.2 (3) 3, Figure 3.2 (c)"});
  std::vector<Hinge> hinges;
  for (int i = 0; i < kGuideways; ++i) hinges.push_back({guideway_axes(context.machine, i).col(2), Vector3::Zero()});
  return std::make_shared<GuidewayRotation>(std::move(info), context.machine, hinges);
}

}  // namespace hexdbb::effects
