#include "joint_state.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "multiversion.hpp"

namespace hexdbb {

namespace {

// Determinant of the three sides' equations, over the product of their lengths and the radii, below which the platform
// can move with locked sliders: no machine works there, and rates would be rounding.
constexpr double kSmallest = 1e-6;

/// Compute the swing rates w of the ball joints about their guideways from (e_i . t_i) w_i - (e_i . t_j) w_j = f_i, e_i
/// the side from joint j = i + 1 to joint i, t_i the velocity at w_i = 1: the cyclic equations of (2.17), by Cramer's
/// rule.
Vector3 swing_rates(const Matrix3& side, const Matrix3& turning, const Vector3& f) {
  Vector3 a, b;
  for (int i = 0; i < 3; ++i) {
    a[i] = side.col(i).dot(turning.col(i));
    b[i] = -side.col(i).dot(turning.col(i == 2 ? 0 : i + 1));
  }
  const double determinant = a.prod() + b.prod();
  double size_squared = 1.0;
  for (int i = 0; i < 3; ++i) size_squared *= side.col(i).squaredNorm() * turning.col(i).squaredNorm();
  if (!(determinant * determinant > kSmallest * kSmallest * size_squared)) {
    return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const double inverse = 1.0 / determinant;
  Vector3 out;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
    out[i] = inverse * (f[i] * a[j] * a[k] - f[j] * b[i] * a[k] + f[k] * b[i] * b[j]);
  }
  return out;
}

/// The legs of the nominal machine at a pose.
class Legs {
 public:
  Legs(const NominalGeometry& nominal, const Pose& pose, const Vector6& sliders_mm)
      : nominal_(nominal), sliders_mm_(sliders_mm), normal_(pose.rotation.col(2)) {
    for (int i = 0; i < kGuideways; ++i) {
      joint_.col(i) = pose.position + pose.rotation * nominal.platform_joint.col(2 * i);
    }
  }

  const Matrix3& joint() const { return joint_; }  // ball joints as columns
  const Vector3& normal() const { return normal_; }

  /// Vector of a leg, from the slider's joint to the platform's.
  Vector3 along(int leg) const {
    return joint_.col(guideway_of(leg)) - nominal_.vertex.col(leg) - sliders_mm_[leg] * nominal_.direction.col(leg);
  }

  /// Vector from a guideway to its ball joint, perpendicular to the guideway.
  Vector3 outward(int guideway) const {
    const Vector3 d = nominal_.direction.col(2 * guideway);
    const Vector3 reach = joint_.col(guideway) - nominal_.vertex.col(2 * guideway);
    return reach - reach.dot(d) * d;
  }

  double platform_angle_rad(int leg) const {
    return std::acos(std::clamp(along(leg).dot(normal_) / nominal_.machine.leg_length_mm[leg], -1.0, 1.0));
  }

  /// To the vertical.
  double inclination_rad(int leg) const {
    const Vector3 reach = along(leg);
    return std::atan2(std::hypot(reach.x(), reach.y()), reach.z());
  }

  /// From the guideway's outward axis, z x d, towards z.
  double swing_rad(int guideway) const {
    const Vector3 d = nominal_.direction.col(2 * guideway), r = outward(guideway);
    return std::atan2(r.z(), r.y() * d.x() - r.x() * d.y());
  }

 private:
  const NominalGeometry& nominal_;
  const Vector6& sliders_mm_;
  Vector3 normal_;
  Matrix3 joint_;
};

/// The ball joints' motion under given velocities of the sliders.
class PlatformMotion {
 public:
  PlatformMotion(const NominalGeometry& nominal, const Legs& legs, const std::array<LegPair, kGuideways>& pairs)
      : nominal_(nominal), legs_(legs), pairs_(pairs) {
    Matrix3 turning, side;
    Vector3 f;
    for (int i = 0; i < kGuideways; ++i) {
      const Vector3 d = nominal.direction.col(2 * i), outward = legs.outward(i);
      turning.col(i) = d.cross(outward);
      const double growing = -pairs[i].foot_mm[0] * pairs[i].foot_mm_s[0] / pairs[i].radius_squared;
      velocity_.col(i) = pairs[i].along_mm_s * d + growing * outward;
    }
    for (int i = 0; i < kGuideways; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      side.col(i) = legs.joint().col(i) - legs.joint().col(j);
      f[i] = -side.col(i).dot(velocity_.col(i) - velocity_.col(j));
    }
    swing_rate_rad_s_ = swing_rates(side, turning, f);
    for (int i = 0; i < kGuideways; ++i) velocity_.col(i) += swing_rate_rad_s_[i] * turning.col(i);
  }

  double swing_rate_rad_s(int guideway) const { return swing_rate_rad_s_[guideway]; }

  /// With u the leg's unit vector and n the normal, the angle's cosine is u . n.
  double platform_rate_rad_s(int leg) const {
    const int i = guideway_of(leg);
    const LegPair& pair = pairs_[i];
    const Vector3 along = legs_.along(leg);
    const Vector3 along_rate = velocity_.col(i) - pair.slider_mm_s[leg % 2] * nominal_.direction.col(leg);
    const double length_mm = pair.length_mm[leg % 2], cosine = along.dot(legs_.normal()) / length_mm;
    const double cosine_rate = (along_rate.dot(legs_.normal()) + along.dot(normal_rate())) / length_mm;
    return -cosine_rate / std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  }

 private:
  /// The normal is parallel to the cross product of two sides, whose length does not change.
  Vector3 normal_rate() const {
    const Matrix3& q = legs_.joint();
    const Vector3 one = q.col(1) - q.col(0), two = q.col(2) - q.col(0);
    const Vector3 one_rate = velocity_.col(1) - velocity_.col(0), two_rate = velocity_.col(2) - velocity_.col(0);
    return (one_rate.cross(two) + one.cross(two_rate)) / one.cross(two).dot(legs_.normal());
  }

  const NominalGeometry& nominal_;
  const Legs& legs_;
  const std::array<LegPair, kGuideways>& pairs_;
  Matrix3 velocity_;
  Vector3 swing_rate_rad_s_;
};

/// Set column[leg] to value(leg) for every leg of a mask.
template <class Value>
void for_legs(unsigned legs, Vector6& column, Value value) {
  for (unsigned rest = legs; rest != 0u; rest &= rest - 1u) {
    const int leg = std::countr_zero(rest);
    column[leg] = value(leg);
  }
}

/// Fill in what the pairs of legs alone determine.
void fill_slider_joints(const std::array<LegPair, kGuideways>& pairs, const Vector6& leg_force, const TableSet& tables,
                        TableState& state) {
  const auto fill = [&](TableVariable variable, auto value) {
    for_legs(tables.legs(variable), state[variable], value);
  };
  fill(TableVariable::kSliderJointAngle, [&](int leg) { return pairs[guideway_of(leg)].angle_rad(leg % 2); });
  fill(TableVariable::kSliderJointRate, [&](int leg) { return pairs[guideway_of(leg)].rate_rad_s(leg % 2); });
  fill(TableVariable::kDriveLoad, [&](int leg) { return leg_force[leg] * pairs[guideway_of(leg)].along(leg % 2); });
  fill(TableVariable::kCarriageLoad, [&](int leg) { return leg_force[leg] * pairs[guideway_of(leg)].across(leg % 2); });
}

unsigned union_of(const TableSet& tables, TableVariable one, TableVariable other) {
  return tables.legs(one) | tables.legs(other);
}

}  // namespace

LegPair::LegPair(const NominalGeometry& nominal, int guideway, const Vector6& sliders_mm,
                 const Vector6& velocity_mm_s) noexcept {
  const int first = 2 * guideway;
  for (int leg = 0; leg < 2; ++leg) {
    length_mm[leg] = nominal.machine.leg_length_mm[first + leg];
    slider_mm_s[leg] = velocity_mm_s[first + leg];
  }
  const double distance = sliders_mm[first + 1] - sliders_mm[first], distance_rate = slider_mm_s[1] - slider_mm_s[0];
  const double longer_squared = (length_mm[0] - length_mm[1]) * (length_mm[0] + length_mm[1]);
  const double aside = longer_squared == 0.0 ? 0.0 : 0.5 * longer_squared / distance;
  foot_mm[0] = 0.5 * distance + aside;
  foot_mm[1] = aside - 0.5 * distance;
  const double aside_rate = aside == 0.0 ? 0.0 : -aside * distance_rate / distance;
  foot_mm_s[0] = 0.5 * distance_rate + aside_rate;
  foot_mm_s[1] = aside_rate - 0.5 * distance_rate;
  along_mm_s = 0.5 * (slider_mm_s[0] + slider_mm_s[1]) + aside_rate;
  radius_squared = length_mm[0] * length_mm[0] - foot_mm[0] * foot_mm[0];
}

double LegPair::angle_rad(int leg) const noexcept { return std::acos(foot_mm[leg] / length_mm[leg]); }

double LegPair::along(int leg) const noexcept { return foot_mm[leg] / length_mm[leg]; }

double LegPair::across(int leg) const noexcept { return std::sqrt(radius_squared) / length_mm[leg]; }

double LegPair::rate_rad_s(int leg) const noexcept { return -foot_mm_s[leg] / std::sqrt(radius_squared); }

HEXDBB_MULTIVERSION_WIDE
void fill_joints(const NominalGeometry& nominal, const Pose& pose, const Vector6& sliders_mm,
                 const Vector6& velocity_mm_s, const Vector6& leg_force, const TableSet& tables,
                 TableState& state) noexcept {
  using Variable = TableVariable;
  const unsigned at_sliders = union_of(tables, Variable::kSliderJointAngle, Variable::kSliderJointRate) |
                              union_of(tables, Variable::kDriveLoad, Variable::kCarriageLoad);
  const unsigned angles =
      union_of(tables, Variable::kPlatformJointAngle, Variable::kSwingAngle) | tables.legs(Variable::kLegInclination);
  const unsigned rates = union_of(tables, Variable::kPlatformJointRate, Variable::kSwingRate);
  if ((at_sliders | angles | rates) == 0u) return;
  std::array<LegPair, kGuideways> pairs;
  for (int i = 0; i < kGuideways; ++i) {
    if (rates == 0u && ((at_sliders >> (2 * i)) & 3u) == 0u) continue;
    pairs[i] = LegPair(nominal, i, sliders_mm, velocity_mm_s);
  }
  fill_slider_joints(pairs, leg_force, tables, state);
  if ((angles | rates) == 0u) return;
  const auto fill = [&](Variable variable, auto value) { for_legs(tables.legs(variable), state[variable], value); };
  const Legs legs(nominal, pose, sliders_mm);
  fill(Variable::kPlatformJointAngle, [&](int leg) { return legs.platform_angle_rad(leg); });
  fill(Variable::kLegInclination, [&](int leg) { return legs.inclination_rad(leg); });
  fill(Variable::kSwingAngle, [&](int leg) { return legs.swing_rad(guideway_of(leg)); });
  if (rates == 0u) return;
  const PlatformMotion motion(nominal, legs, pairs);
  fill(Variable::kPlatformJointRate, [&](int leg) { return motion.platform_rate_rad_s(leg); });
  fill(Variable::kSwingRate, [&](int leg) { return motion.swing_rate_rad_s(guideway_of(leg)); });
}

}  // namespace hexdbb
