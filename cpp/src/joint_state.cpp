#include "joint_state.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hexdbb {

namespace {

// Determinant of the three sides' equations, over the product of the sides' lengths, below which the platform can move
// with locked sliders: no machine works there, and rates would be rounding.
constexpr double kSmallest = 1e-6;

/// Compute the speeds w of the ball joints across their guideways from (e_i . t_i) w_i - (e_i . t_j) w_j = f_i, e_i the
/// side from joint j = i + 1 to joint i: the cyclic equations of (2.17), by Cramer's rule.
Vector3 speeds_across(const Matrix3& side, const Matrix3& across, const Vector3& f) {
  Vector3 a, b;
  for (int i = 0; i < 3; ++i) {
    a[i] = side.col(i).dot(across.col(i));
    b[i] = -side.col(i).dot(across.col((i + 1) % 3));
  }
  const double determinant = a.prod() + b.prod();
  const double size_squared = side.col(0).squaredNorm() * side.col(1).squaredNorm() * side.col(2).squaredNorm();
  if (!(determinant * determinant > kSmallest * kSmallest * size_squared)) {
    return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  Vector3 out;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = (f[i] * a[j] * a[k] - f[j] * b[i] * a[k] + f[k] * b[i] * b[j]) / determinant;
  }
  return out;
}

/// The platform's motion under given velocities of the sliders.
class PlatformMotion {
 public:
  PlatformMotion(const NominalGeometry& nominal, const Pose& pose, const Vector6& sliders_mm,
                 const std::array<LegPair, kGuideways>& pairs)
      : nominal_(nominal), sliders_mm_(sliders_mm), pairs_(pairs), normal_(pose.rotation.col(2)) {
    Matrix3 across, side;
    Vector3 f;
    for (int i = 0; i < kGuideways; ++i) {
      const Vector3 d = nominal.direction.col(2 * i);
      joint_.col(i) = pose.position + pose.rotation * nominal.platform_joint.col(2 * i);
      const Vector3 reach = joint_.col(i) - nominal.vertex.col(2 * i);
      outward_.col(i) = pairs[i].per_radius * (reach - reach.dot(d) * d);
      across.col(i) = d.cross(outward_.col(i));
      const double radius_mm_s = -pairs[i].half_mm * pairs[i].half_mm_s * pairs[i].per_radius;
      velocity_.col(i) = pairs[i].along_mm_s * d + radius_mm_s * outward_.col(i);
    }
    for (int i = 0; i < kGuideways; ++i) {
      const int j = (i + 1) % 3;
      side.col(i) = joint_.col(i) - joint_.col(j);
      f[i] = -side.col(i).dot(velocity_.col(i) - velocity_.col(j));
    }
    speed_mm_s_ = speeds_across(side, across, f);
    for (int i = 0; i < kGuideways; ++i) velocity_.col(i) += speed_mm_s_[i] * across.col(i);
    // The normal is parallel to the cross product of two sides.
    const Vector3 one = joint_.col(1) - joint_.col(0), two = joint_.col(2) - joint_.col(0);
    const Vector3 one_rate = velocity_.col(1) - velocity_.col(0), two_rate = velocity_.col(2) - velocity_.col(0);
    normal_rate_ = (one_rate.cross(two) + one.cross(two_rate)) / one.cross(two).dot(normal_);
  }

  double angle_rad(int leg) const { return std::acos(std::clamp(along(leg).dot(normal_), -1.0, 1.0)); }

  double rate_rad_s(int leg) const {
    const int i = guideway_of(leg);
    const LegPair& pair = pairs_[i];
    const double slider_mm_s = pair.along_mm_s + (leg % 2 == 0 ? -pair.half_mm_s : pair.half_mm_s);
    const Vector3 along_rate =
        (velocity_.col(i) - slider_mm_s * nominal_.direction.col(leg)) / nominal_.machine.leg_length_mm;
    const double cosine = along(leg).dot(normal_);
    return -(along_rate.dot(normal_) + along(leg).dot(normal_rate_)) / std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  }

  /// From the guideway's outward axis, z x d, towards z.
  double swing_rad(int guideway) const {
    const Vector3 d = nominal_.direction.col(2 * guideway), u = outward_.col(guideway);
    return std::atan2(u.z(), u.y() * d.x() - u.x() * d.y());
  }
  double swing_rate_rad_s(int guideway) const { return speed_mm_s_[guideway] * pairs_[guideway].per_radius; }

 private:
  /// Unit vector of a leg, from the slider's joint to the platform's.
  Vector3 along(int leg) const {
    const Vector3 slider_joint = nominal_.vertex.col(leg) + sliders_mm_[leg] * nominal_.direction.col(leg);
    return (joint_.col(guideway_of(leg)) - slider_joint) / nominal_.machine.leg_length_mm;
  }

  const NominalGeometry& nominal_;
  const Vector6& sliders_mm_;
  const std::array<LegPair, kGuideways>& pairs_;
  Matrix3 joint_, outward_, velocity_;  // of the ball joints; their radius vectors from the guideways, of length 1
  Vector3 speed_mm_s_, normal_, normal_rate_;
};

/// Call fill(leg, number) for every leg of a mask, the number to be set.
template <class Fill>
void for_legs(unsigned legs, Vector6& column, Fill fill) {
  for (int leg = 0; leg < kLegs; ++leg) {
    if ((legs >> leg) & 1u) column[leg] = fill(leg);
  }
}

}  // namespace

LegPair::LegPair(double length_mm, double first_mm, double second_mm, double first_mm_s, double second_mm_s) noexcept
    : half_mm(0.5 * (second_mm - first_mm)),
      half_mm_s(0.5 * (second_mm_s - first_mm_s)),
      half_per_length(half_mm / length_mm),
      along_mm_s(0.5 * (first_mm_s + second_mm_s)) {
  const double radius_squared = length_mm * length_mm - half_mm * half_mm;
  if (!(radius_squared > 0.0)) return;
  radius_mm = std::sqrt(radius_squared);
  per_radius = 1.0 / radius_mm;
}

double LegPair::angle_rad(int leg) const noexcept {
  return std::acos(std::clamp(leg == 0 ? half_per_length : -half_per_length, -1.0, 1.0));
}

void fill_joints(const NominalGeometry& nominal, const Pose& pose, const Vector6& sliders_mm,
                 const Vector6& velocity_mm_s, const TableSet& tables, TableState& state) noexcept {
  using Variable = TableVariable;
  const unsigned slider_joints = tables.legs(Variable::kSliderJointAngle) | tables.legs(Variable::kSliderJointRate);
  const unsigned platform_joints = tables.legs(Variable::kPlatformJointAngle) |
                                   tables.legs(Variable::kPlatformJointRate) | tables.legs(Variable::kSwingAngle) |
                                   tables.legs(Variable::kSwingRate);
  if ((slider_joints | platform_joints) == 0u) return;
  std::array<LegPair, kGuideways> pairs;
  for (int i = 0; i < kGuideways; ++i) {
    const int a = 2 * i, b = a + 1;
    const bool is_needed = platform_joints != 0u || ((slider_joints >> a) & 3u) != 0u;
    if (!is_needed) continue;
    pairs[i] = LegPair(nominal.machine.leg_length_mm, sliders_mm[a], sliders_mm[b], velocity_mm_s[a], velocity_mm_s[b]);
  }
  const auto fill = [&](Variable variable, auto value) { for_legs(tables.legs(variable), state[variable], value); };
  fill(Variable::kSliderJointAngle, [&](int leg) { return pairs[guideway_of(leg)].angle_rad(leg % 2); });
  fill(Variable::kSliderJointRate, [&](int leg) { return pairs[guideway_of(leg)].rate_rad_s(leg % 2); });
  if (platform_joints == 0u) return;
  const PlatformMotion motion(nominal, pose, sliders_mm, pairs);
  fill(Variable::kPlatformJointAngle, [&](int leg) { return motion.angle_rad(leg); });
  fill(Variable::kPlatformJointRate, [&](int leg) { return motion.rate_rad_s(leg); });
  fill(Variable::kSwingAngle, [&](int leg) { return motion.swing_rad(guideway_of(leg)); });
  fill(Variable::kSwingRate, [&](int leg) { return motion.swing_rate_rad_s(guideway_of(leg)); });
}

}  // namespace hexdbb
