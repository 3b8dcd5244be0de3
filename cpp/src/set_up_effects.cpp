// Unknowns of the set-up: where the cup really is, where the ball really sits, how long the bar really is.
#include "constant_effect.hpp"
#include "place_per_set_up.hpp"

namespace hexdbb {

namespace {

constexpr double kPlacePrior_mm = 1.0;  // a magnetic mount set by hand
constexpr double kPlaceLimit_mm = 20.0;

ParameterInfo place(const char* axis) { return {axis, "mm", kPlacePrior_mm, kPlaceLimit_mm}; }

EffectPtr cup_position(int mounts) {
  EffectInfo info{"cup_position",
                  "The tool cup is fixed elsewhere than planned.",
                  "set-up",
                  "mount",
                  {},
                  {place("x"), place("y"), place("z")},
                  {"cup"},
                  true,
                  group::kSetUp};
  return std::make_shared<PlacePerSetUp>(std::move(info), mounts, port::kCup);
}

EffectPtr ball_offset() {
  EffectInfo info{"ball_offset", "The bar's ball sits elsewhere on the platform than planned.",
                  "set-up",      "machine",
                  {"1"},         {place("x"), place("y"), place("z")},
                  {"ball"},      true,
                  group::kSetUp};
  return std::make_shared<ConstantEffect>(
      std::move(info), std::vector<Link>{{0, port::kBall, 1.0}, {1, port::kBall + 1, 1.0}, {2, port::kBall + 2, 1.0}});
}

EffectPtr bar_length() {
  // A longer bar makes the gauge, which shows length minus nominal length, read less at one and the same distance.
  EffectInfo info{"bar_length", "The ball bar is longer than its calibration says.",
                  "set-up",     "machine",
                  {"1"},        {{"longer", "mm", 0.01, 1.0}},
                  {"reading"},  true,
                  group::kSetUp};
  return std::make_shared<ConstantEffect>(std::move(info), std::vector<Link>{{0, port::kReading, -1.0}});
}

}  // namespace

std::vector<EffectPtr> set_up_effects(int mounts) { return {cup_position(mounts), ball_offset(), bar_length()}; }

}  // namespace hexdbb
