// Guideways that are not straight, legs that give, joints that do not meet.
#include <utility>

#include "catalogue.hpp"
#include "linear_effect.hpp"

namespace hexdbb {

EffectPtr straightness(const Machine& machine) {
  std::vector<Shape> shapes;
  const double mid_mm = mid_travel_mm(machine), half_mm = 0.5 * (machine.travel_max_mm - machine.travel_min_mm);
  for (int k = 0; k < kLegs; ++k) {
    const Matrix3 axes = guideway_axes(guideway_of(k));
    std::vector<Link> links;
    for (int base = 0; base < 3; ++base) {
      const int port = port::kSliderJoint + 3 * k + base;
      links.push_back({2 * guideway_of(k), port, axes(base, 0)});
      links.push_back({2 * guideway_of(k) + 1, port, axes(base, 2)});
    }
    shapes.push_back({[k, mid_mm, half_mm](const SampleBlock& block) -> BlockColumn {
                        return 1.0 - ((block.slider_mm(k).array() - mid_mm) / half_mm).square();
                      },
                      std::move(links)});
  }
  // A rail screwed to a frame that was not scraped: tenths of a millimetre over its length.
  EffectInfo info{
      "straightness",
      "A guideway is bowed, outward and up: a parabola over the travel, zero at its ends, that carries both "
      "sliders; its mean and slope are guideway_translation's and guideway_rotation's.",
      "ISO 230-1, straightness; parabola as the bow of a beam",
      "guideway",
      kThreeElements,
      {{"lateral", "mm", 0.3, 5.0}, {"vertical", "mm", 0.3, 5.0}},
      {"slider_joint"},
      false,
      group::kCatalogue};
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

EffectPtr gravity_sag(const Machine& machine) {
  const double weight_n = machine.moved_mass_kg * kGravity_m_s2;
  std::vector<Shape> shapes;
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back(
        {[k](const SampleBlock& block) -> BlockColumn { return block.of(block.samples.state.leg_force, k).array(); },
         {{0, port::kLeg + k, weight_n}}});
  }
  // A slender leg with its two ball joints gives 0.02 to 0.2 um/N; some tenths where a joint is worn.
  EffectInfo info{
      "gravity_sag",
      "Legs give under the weight they carry: each is longer by compliance x mass x gravity x its axial force "
      "per newton of load, tension positive, so that legs in compression shorten; unlike leg_length it "
      "changes with the pose.",
      "static equilibrium, Hooke's law",
      "machine",
      kWhole,
      {{"compliance", "mm/N", 2e-4, 5e-3}},
      {"leg"},
      false,
      group::kCatalogue,
      {"leg_force"}};
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

EffectPtr joint_offset() {
  std::vector<Link> links;
  for (int value = 0; value < 3 * kLegs; ++value) links.push_back({value, port::kPlatformJoint + value, 1.0});
  // Two balls on one pin, each fitted by hand: hundredths of a millimetre.
  const auto along = [](const char* name) { return ParameterInfo{name, "mm", 0.05, 2.0}; };
  EffectInfo info{"joint_offset",
                  "A leg's ball centre misses the joint centre it should share with its neighbour, in the platform's "
                  "axes; to first order that of one leg of a pair looks like that of the other.",
                  "6-6 platform: the joints of a pair no longer coincide",
                  "leg",
                  kSixElements,
                  {along("x"), along("y"), along("z")},
                  {"platform_joint"},
                  false,
                  group::kCatalogue};
  return std::make_shared<ConstantEffect>(std::move(info), std::move(links));
}

}  // namespace hexdbb
