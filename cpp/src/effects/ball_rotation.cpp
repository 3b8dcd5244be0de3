// The holder of the bar's ball, or the platform's triangle of joints, turned about the platform's origin.
//
// The 33 errors hold the triangle's sides and not its orientation. With the ball at one place, the unknown position of
// the ball absorbs it; with the ball at several places it cannot.
#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <utility>

#include "catalogue.hpp"
#include "elements.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

namespace {

// A holder aligned by hand on a pin and a face of some centimetres: a few tenths of a millimetre over them. Beyond
// 0.1 rad the holder is another.
constexpr double kTurnPrior_rad = 5e-3;
constexpr double kTurnLimit_rad = 0.1;

ParameterInfo turn(const std::string& name) {
  return {.name = name, .unit = "rad", .prior_sigma = kTurnPrior_rad, .limit = kTurnLimit_rad};
}

Eigen::Matrix3d cross(const Vector3& v) {
  Eigen::Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

// Rotation about a vector by its length (Rodrigues), and its right Jacobian: R(v + d) = R(v) R(J d) to first order.
struct Turned {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d right = Eigen::Matrix3d::Identity();

  explicit Turned(const Vector3& v) {
    const double angle = v.norm();
    const Eigen::Matrix3d across = cross(v), twice = across * across;
    // Below it the next term of a series is less than rounding: angle^4 / 120.
    const bool is_small = angle < 1e-3;
    const double square = angle * angle;
    const double a = is_small ? 1.0 - square / 6.0 : std::sin(angle) / angle;
    const double b = is_small ? 0.5 - square / 24.0 : (1.0 - std::cos(angle)) / square;
    const double c = is_small ? 1.0 / 6.0 - square / 120.0 : (angle - std::sin(angle)) / (square * angle);
    rotation += a * across + b * twice;
    right += -b * across + c * twice;
  }
};

class BallRotation : public Effect {
 public:
  using Effect::Effect;

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    const Turned turned(values.head<3>());
    for_each_run(block, [&](Eigen::Index first, Eigen::Index count, const Vector3& ball_mm) {
      const Vector3 moved_mm = turned.rotation * ball_mm - ball_mm;
      for (int axis = 0; axis < 3; ++axis) {
        ports.col(port::kBall + axis).segment(first, count).array() += moved_mm[axis];
      }
    });
  }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    const Turned turned(values.head<3>());
    for_each_run(block, [&](Eigen::Index first, Eigen::Index count, const Vector3& ball_mm) {
      const Eigen::Matrix3d rate_mm = -turned.rotation * cross(ball_mm) * turned.right;
      jacobian.middleRows(first, count).leftCols<3>().noalias() =
          sensitivity.block(first, port::kBall, count, 3) * rate_mm;
    });
  }

 private:
  /// Call visit(first row, number of rows, planned place of the ball) for neighbouring rows of one set-up.
  template <class Visit>
  static void for_each_run(const SampleBlock& block, Visit visit) {
    const auto set_up = [&](Eigen::Index row) { return block.samples.set_up[block.first + row]; };
    for (Eigen::Index row = 0, end = 0; row < block.count; row = end) {
      while (end < block.count && set_up(end) == set_up(row)) ++end;
      visit(row, end - row, block.samples.set_ups[static_cast<std::size_t>(set_up(row))].ball_offset_mm);
    }
  }
};

}  // namespace

EffectPtr ball_rotation(const Context&) {
  EffectInfo info = {
      .name = "ball_rotation",
      .group = group::kPlaces,
      .physics =
          "The holder of the bar's ball, or the platform's triangle of joints, is turned: each place of the "
          "ball on the platform is elsewhere than planned, in proportion to its distance from the platform's "
          "origin.",
      .formula = "ball = R(turn) place - place, place planned, platform frame",
      .source = "set-up",
      .element_kind = "machine",
      .elements = kWhole,
      .parameters = {turn("about_x"), turn("about_y"), turn("about_z")},
      .ports = {"ball"},
      .is_set_up = true,
  };
  return std::make_shared<BallRotation>(std::move(info));
}

}  // namespace hexdbb::effects
