// Friction in the joints of a leg. While a joint turns, friction loads the leg against the sense of turning; what is
// elastic or loose in its joints yields, so that the distance of the joint centres depends on that sense. After a
// reversal the friction moment changes sign over a presliding angle (Dahl 1968):
//   push = deflection x F,   F = sigma (1 - 2 exp(-a / a0)),
// sigma the sense in which the leg turns at its slider joint, a the angle turned since that reversed. F is a function
// of the angle, not of the rate: dry friction does not depend on speed, and a slow circle shows the same as a fast one.
//
// While the platform keeps its orientation, as along every circle of a test, both joints of a leg turn by the same
// angular velocity, so one sense per leg stands for both.
//
// Assumption: a joint turns by several a0 between two reversals, and had done so before the sweep began.
#include <cmath>

#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

namespace {

// A ball of 10 mm radius slides after about 10 um of elastic shear at its surface.
constexpr double kPresliding_rad = 1e-3;

BlockColumn friction_state(const SampleBlock& block, int k) {
  const State& state = block.samples.state;
  const auto direction = block.of(state.slider_joint_direction, k).array();
  const auto turned_rad = block.of(state.slider_joint_since_reversal_rad, k).array();
  return direction * (1.0 - 2.0 * (-turned_rad / kPresliding_rad).exp());
}

}  // namespace

EffectPtr joint_friction(const Context&) {
  std::vector<Shape> shapes;
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back({[k](const SampleBlock& block) { return friction_state(block, k); }, {{k, port::kLeg + k, 1.0}}});
  }
  EffectInfo info = {
      .name = "joint_friction",
      .group = group::kCatalogue,
      .physics =
          "Friction in a leg's joints deflects them against the sense in which they turn: the leg is longer while "
          "its angle to the guideway grows and shorter while it falls; unlike backlash the error reverses with "
          "the turning of the leg, not with the travel of a slider.",
      .formula = "leg = deflection x slider_joint_direction (1 - 2 exp(-slider_joint_since_reversal / 1 mrad))",
      .source = "Dahl's model of solid friction (Dahl 1968)",
      .element_kind = "leg",
      .elements = kSixElements,
      // Joints of a small machine deflect by some um under their friction; half a millimetre is a seized joint.
      .parameters = {{.name = "deflection", .unit = "mm", .prior_sigma = 0.01, .limit = 0.5}},
      .ports = {"leg"},
      .needs = {"slider_joint_direction", "slider_joint_since_reversal_rad"},
  };
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb::effects
