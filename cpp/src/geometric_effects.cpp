// The thesis' 33 geometric errors (section 3.2, Figures 3.1 and 3.2).
#include "constant_effect.hpp"
#include "guideway_rotation.hpp"
#include "platform_sides.hpp"

namespace hexdbb {

namespace {

constexpr double kLengthPrior_mm = 0.1;
constexpr double kLengthLimit_mm = 5.0;
// A turn that moves the end of a guideway as far as the length prior: lever arm about 300 mm.
constexpr double kAnglePrior_rad = kLengthPrior_mm / 300.0;
constexpr double kAngleLimit_rad = 0.02;

const std::vector<std::string> kSix = {"1", "2", "3", "4", "5", "6"};
const std::vector<std::string> kThree = {"1", "2", "3"};

ParameterInfo length(const std::string& name) { return {name, "mm", kLengthPrior_mm, kLengthLimit_mm}; }
ParameterInfo angle(const std::string& name) { return {name, "rad", kAnglePrior_rad, kAngleLimit_rad}; }

EffectPtr one_to_one(EffectInfo info, int first_port) {
  std::vector<Link> links;
  for (int k = 0; k < info.size(); ++k) links.push_back({k, first_port + k, 1.0});
  return std::make_shared<ConstantEffect>(std::move(info), std::move(links));
}

EffectPtr leg_length() {
  return one_to_one(
      {"leg_length", "A leg is longer than nominal.", "thesis 3.2 (1)", "leg", kSix, {length("longer")}, {"leg"}},
      port::kLeg);
}

EffectPtr slider_offset() {
  return one_to_one({"slider_offset",
                     "A slider stands further along its guideway than it reports.",
                     "thesis 3.2 (2)",
                     "slider",
                     kSix,
                     {length("offset")},
                     {"slider"}},
                    port::kSlider);
}

EffectPtr guideway_translation() {
  std::vector<Link> links;
  for (int k = 0; k < kLegs; ++k) {
    const Matrix3 axes = guideway_axes(guideway_of(k));
    for (int local = 0; local < 3; ++local) {
      for (int base = 0; base < 3; ++base) {
        links.push_back({3 * guideway_of(k) + local, port::kSliderJoint + 3 * k + base, axes(base, local)});
      }
    }
  }
  EffectInfo info{"guideway_translation",
                  "A guideway stands displaced: x outward from the base centre, y towards its vertex, z up.",
                  "thesis 3.2 (3) 1, Figure 3.2 (a)",
                  "guideway",
                  kThree,
                  {length("x"), length("y"), length("z")},
                  {"slider_joint"}};
  return std::make_shared<ConstantEffect>(std::move(info), std::move(links));
}

EffectPtr rotation(const Machine& machine, const char* name, const char* physics, const char* source, int local_axis,
                   bool about_midpoint) {
  std::vector<Hinge> hinges;
  for (int i = 0; i < kGuideways; ++i) {
    hinges.push_back(
        {guideway_axes(i).col(local_axis), about_midpoint ? guideway_midpoint(machine, i) : Vector3(Vector3::Zero())});
  }
  EffectInfo info{name, physics, source, "guideway", kThree, {angle("angle")}, {"slider_joint"}};
  return std::make_shared<GuidewayRotation>(std::move(info), machine, hinges);
}

EffectPtr platform_side(const Machine& machine) {
  return std::make_shared<PlatformSides>(EffectInfo{"platform_side",
                                                    "Two ball joints of the platform are further apart than nominal.",
                                                    "thesis 3.2 (3), ball joints",
                                                    "side",
                                                    {"12", "23", "31"},
                                                    {length("longer")},
                                                    {"platform_joint"}},
                                         machine);
}

}  // namespace

std::vector<EffectPtr> geometric_effects(const Machine& machine) {
  return {
      leg_length(),
      slider_offset(),
      guideway_translation(),
      rotation(machine, "guideway_rotation_xy", "A guideway is turned about the vertical through its midpoint.",
               "thesis 3.2 (3) 2, Figure 3.2 (b)", 2, true),
      rotation(machine, "guideway_rotation_yz",
               "A guideway is tilted in its vertical plane, about the outward axis through its midpoint.",
               "thesis 3.2 (3) 2, Figure 3.2 (b)", 0, true),
      rotation(machine, "guideway_rotation_centre", "A guideway is turned about the vertical through the base centre.",
               "thesis 3.2 (3) 3, Figure 3.2 (c)", 2, false),
      platform_side(machine)};
}

}  // namespace hexdbb
