// What effects and tables depend on at one pose: directions followed from call to call, forces and joints.
#include <algorithm>
#include <cmath>
#include <limits>

#include "hexdbb/compensation.hpp"
#include "joint_state.hpp"
#include "kernel_types.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

// Part of a function that is no longer in force where a direction of travel is given by rounded numbers.
constexpr double kNothing = 1e-9;

/// Return the largest distance of a slider; NaN where one of the two is unknown.
double distance_mm(const Vector6& one, const Vector6& other) { return (one - other).cwiseAbs().maxCoeff(); }

}  // namespace

/// Update the directions of travel by the play operator of the commanded travel (see the header). Return false, and
/// change nothing, for a pose that is only checked.
bool Compensator::follow(const Vector6& nominal_mm, const Direction& direction) noexcept {
  const Vector6& velocity_mm_s = direction.velocity_mm_s;
  if (velocity_mm_s.isZero(0.0) && distance_mm(nominal_mm, followed_mm_) > kFollow_mm) {
    const bool is_near_checked = distance_mm(nominal_mm, checked_mm_) <= kFollow_mm;
    if (!is_near_checked) {
      checked_mm_ = nominal_mm;
      return false;
    }
    followed_mm_ = checked_mm_;
  }
  checked_mm_.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (tables_.legs(TableVariable::kSliderJointDirection) != 0u) follow_joints(nominal_mm, velocity_mm_s);
  if (std::isnan(followed_mm_[0])) {  // a slider that moves at the first call is assumed to have moved so before
    for (int k = 0; k < kLegs; ++k)
      travel_direction_[k] = velocity_mm_s[k] == 0.0 ? 0.0 : std::copysign(1.0, velocity_mm_s[k]);
  } else {
    for (int k = 0; k < kLegs; ++k) {
      const double travel = nominal_mm[k] - followed_mm_[k];
      const double towards = velocity_mm_s[k] == 0.0 ? travel : std::copysign(travel, velocity_mm_s[k]);
      travel_direction_[k] = std::clamp(travel_direction_[k] + direction_per_mm_ * towards, -1.0, 1.0);
    }
  }
  travel_direction_ = direction.travel_direction.array().isNaN().select(travel_direction_, direction.travel_direction);
  if (tables_.legs(TableVariable::kSinceReversal) != 0u) follow_reversals(nominal_mm, direction);
  followed_mm_ = nominal_mm;
  return true;
}

/// Update the senses in which the legs turn at their slider joints, as follow() does for the sliders.
void Compensator::follow_joints(const Vector6& nominal_mm, const Vector6& velocity_mm_s) noexcept {
  const bool is_first = std::isnan(followed_mm_[0]);
  const Vector6 travel_mm = is_first ? Vector6(Vector6::Zero()) : Vector6(nominal_mm - followed_mm_);
  for (int k = 0; k < kLegs; ++k) {
    const LegPair moved(model_.nominal, guideway_of(k), nominal_mm, travel_mm);  // within one unit of time
    const LegPair moving(model_.nominal, guideway_of(k), nominal_mm, velocity_mm_s);
    const double turned_mm = moved.length_mm[k % 2] * moved.rate_rad_s(k % 2), rate = moving.rate_rad_s(k % 2);
    const double sense = rate == 0.0 ? 0.0 : std::copysign(1.0, rate);
    const double towards = rate == 0.0 ? turned_mm : std::copysign(turned_mm, rate);
    const double play = std::clamp(joint_direction_[k] + direction_per_mm_ * towards, -1.0, 1.0);
    joint_direction_[k] = is_first ? sense : play;
  }
}

/// Update the travel since a reversal: that of the direction in which a slider moves grows, that of the other begins anew
/// as soon as nothing of it is in force.
void Compensator::follow_reversals(const Vector6& nominal_mm, const Direction& direction) noexcept {
  const bool is_first = std::isnan(followed_mm_[0]);
  for (int k = 0; k < kLegs; ++k) {
    const double travel_mm = is_first ? 0.0 : nominal_mm[k] - followed_mm_[k];
    const double velocity = direction.velocity_mm_s[k], towards = velocity == 0.0 ? travel_mm : velocity;
    for (const std::size_t side : {0u, 1u}) {
      const double sign = side == 0 ? -1.0 : 1.0;
      double& since_mm = since_reversal_mm_[side][k];
      const bool is_in_force = sign * travel_direction_[k] > kNothing - 1.0;
      if (sign * towards > 0.0) {
        since_mm += std::abs(travel_mm);
      } else if (!is_in_force) {
        since_mm = 0.0;
      }
      const double stated_mm = direction.since_reversal_mm[side][k];
      if (!std::isnan(stated_mm)) since_mm = stated_mm;
    }
  }
}

/// Set the state of all effects, once that of the tables is set.
void Compensator::set_state(const Direction& direction, const Vector6& travel_direction,
                            const Vector6& leg_force) noexcept {
  const double warming_k = direction.temperature_c - reference_temperature_c_;
  polynomials_.settle(
      {direction.velocity_mm_s, travel_direction, leg_force, std::isfinite(warming_k) ? warming_k : 0.0},
      tables_.settled(), tables_.settled_quantities());
  if (model_.terms.empty()) return;
  State& state = now_.state;
  state.velocity_mm_s.row(0) = direction.velocity_mm_s.transpose();
  state.travel_direction.row(0) = travel_direction.transpose();
  state.leg_force.row(0) = leg_force.transpose();
  state.temperature_c[0] = direction.temperature_c;
  state.warming_k[0] = warming_k;
}

/// Set the state of the tables; `nominal_pose` is that of the nominal machine with its sliders at `nominal_mm`, needed
/// only where needs_pose_ is set.
void Compensator::set_tables(const Direction& direction, const Vector6& travel_direction, const Vector6& leg_force,
                             const Pose& nominal_pose, const Vector6& nominal_mm) noexcept {
  if (tables_.empty()) return;
  TableState& state = table_state_;
  const auto set = [&](TableVariable variable, const Vector6& value) {
    if (tables_.legs(variable) != 0u) state[variable] = value;
  };
  set(TableVariable::kVelocity, direction.velocity_mm_s);
  set(TableVariable::kAcceleration, direction.acceleration_mm_s2);
  if (tables_.legs(TableVariable::kSinceReversal) != 0u) state.since_reversal_mm = since_reversal_mm_;
  set(TableVariable::kTravelDirection, travel_direction);
  set(TableVariable::kLegForce, leg_force);
  set(TableVariable::kSliderJointDirection, joint_direction_);
  state[TableVariable::kTemperature].setConstant(direction.temperature_c);
  state[TableVariable::kWarming].setConstant(direction.temperature_c - reference_temperature_c_);
  fill_joints(model_.nominal, nominal_pose, nominal_mm, direction.velocity_mm_s, leg_force, tables_, state);
  tables_.settle(state);
}

/// Compute the static equilibrium of the nominal machine: forces in the legs under a newton of load at the reference
/// point, tension positive.
HEXDBB_MULTIVERSION_WIDE
Vector6 Compensator::leg_force(const Pose& pose, const Vector6& nominal_mm) const noexcept {
  const NominalGeometry& nominal = model_.nominal;
  Matrix36 slider_joint;
  for (int k = 0; k < kLegs; ++k) {
    slider_joint.col(k) = nominal.vertex.col(k) + nominal_mm[k] * nominal.direction.col(k);
  }
  const rssr::LegForces<double> carried =
      rssr::leg_forces(rssr::joints_of(slider_joint, nominal_triangle_), rssr::frame_of(nominal_triangle_),
                       rssr::placed(pose), rssr::vec(Vector3::Zero()), rssr::vec(Vector3::UnitZ()));
  const bool is_held = carried.determinant * carried.determinant > 1e-18 * carried.scale;
  Vector6 out;
  for (int k = 0; k < kLegs; ++k) out[k] = is_held ? -carried.share[k] * nominal.machine.leg_length_mm[k] : 0.0;
  return out;
}

}  // namespace hexdbb
