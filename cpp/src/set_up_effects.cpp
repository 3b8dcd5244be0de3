// Unknowns of the set-up: where the cup really is, where the ball really sits, how long the bar really is.
#include <stdexcept>
#include <string>

#include "constant_effect.hpp"

namespace hexdbb {

namespace {

constexpr double kPlacePrior_mm = 1.0;  // a magnetic mount set by hand
constexpr double kPlaceLimit_mm = 20.0;

ParameterInfo place(const char* axis) { return {axis, "mm", kPlacePrior_mm, kPlaceLimit_mm}; }

/// The tool cup stands elsewhere than planned, once for every time it was mounted.
class CupPosition : public Effect {
 public:
  explicit CupPosition(int mounts) {
    info_ = {"cup_position",
             "The tool cup is fixed elsewhere than planned.",
             "set-up",
             "mount",
             {},
             {place("x"), place("y"), place("z")},
             {"cup"},
             true};
    for (int m = 0; m < mounts; ++m) info_.elements.push_back(std::to_string(m + 1));
  }

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      if (3 * block.mount(row) >= values.size()) {
        throw std::invalid_argument("mount[" + std::to_string(block.first + row) + "] is " +
                                    std::to_string(block.mount(row)) + ", expected 0 to " +
                                    std::to_string(values.size() / 3 - 1));
      }
      ports.block<1, 3>(row, port::kCup) += values.segment<3>(3 * block.mount(row)).transpose();
    }
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (Eigen::Index row = 0; row < block.count; ++row) {
      jacobian.block<1, 3>(row, 3 * block.mount(row)) = sensitivity.block<1, 3>(row, port::kCup);
    }
  }

 private:
  EffectInfo info_;
};

EffectPtr ball_offset() {
  EffectInfo info{"ball_offset", "The bar's ball sits elsewhere on the platform than planned.",
                  "set-up",      "machine",
                  {"1"},         {place("x"), place("y"), place("z")},
                  {"ball"},      true};
  return std::make_shared<ConstantEffect>(
      std::move(info), std::vector<Link>{{0, port::kBall, 1.0}, {1, port::kBall + 1, 1.0}, {2, port::kBall + 2, 1.0}});
}

EffectPtr bar_length() {
  // A longer bar makes the gauge, which shows length minus nominal length, read less at one and the same distance.
  EffectInfo info{"bar_length", "The ball bar is longer than its calibration says.",
                  "set-up",     "machine",
                  {"1"},        {{"longer", "mm", 0.01, 1.0}},
                  {"reading"},  true};
  return std::make_shared<ConstantEffect>(std::move(info), std::vector<Link>{{0, port::kReading, -1.0}});
}

}  // namespace

std::vector<EffectPtr> set_up_effects(int mounts) {
  return {std::make_shared<CupPosition>(mounts), ball_offset(), bar_length()};
}

}  // namespace hexdbb
