#include "catalogue.hpp"
#include "elements.hpp"
#include "linear_effect.hpp"

namespace hexdbb::effects {

EffectPtr gravity_sag(const Context& context) {
  const double weight_n = context.machine.moved_mass_kg * kGravity_m_s2;
  std::vector<Shape> shapes;
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back(
        {[k](const SampleBlock& block) -> BlockColumn { return block.of(block.samples.state.leg_force, k).array(); },
         {{0, port::kLeg + k, weight_n}}});
  }
  EffectInfo info = {
      .name = "gravity_sag",
      .group = group::kCatalogue,
      .physics =
          "Legs are elastic under the weight of the platform: each is longer by compliance x mass x gravity x its "
          "axial force per newton of load, tension positive, so that legs in compression shorten; unlike "
          "leg_length the error changes with the pose.",
      .formula = "leg = compliance x mass x gravity x leg_force",
      .source = "static equilibrium, Hooke's law",
      .element_kind = "machine",
      .elements = kWhole,
      // A slender leg with its two joints gives 0.02 to 0.2 um/N; some tenths where a joint is worn. Geometry
      // imitates most of a sag, so that only a large one is seen: the limit is a hundred times the prior, as for a delay.
      .parameters =
          {{.name = "compliance", .unit = "mm/N", .prior_sigma = 2e-4, .limit = 2e-2, .is_nonnegative = true}},
      .ports = {"leg"},
      .needs = {"leg_force"},
  };
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb::effects
