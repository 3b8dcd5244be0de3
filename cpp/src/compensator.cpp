#include <algorithm>
#include <cmath>

#include "hexdbb/compensation.hpp"
#include "joint_state.hpp"
#include "kernel_types.hpp"
#include "multiversion.hpp"
#include "slider_dependence.hpp"

namespace hexdbb {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Change of a slider coordinate per push on its leg, 1 / cos of the angle between leg and guideway: 2.5 at 66 deg;
// nearer to the perpendicular a machine is of no use.
constexpr double kLever = 2.5;
// Curvature of the pushes, as 2 pi / the shortest period, per mm: pitch errors with a period of 1 mm.
constexpr double kCurvature_mm = 6.3;
// Error above which a target that has used all iterations is refused: a tenth of an encoder count.
constexpr double kLargestError_mm = 1e-5;

Samples one_row() {
  Samples out;
  out.sliders_mm.setZero(1, int{kLegs});
  out.state = state_of({InstantState()});
  return out;
}

bool needs(const Effect& effect, const std::string& column) {
  const std::vector<std::string>& all = effect.info().needs;
  return std::find(all.begin(), all.end(), column) != all.end();
}

/// Return whether a table depends on the platform's pose beyond the sliders.
bool needs_platform(const TableSet& tables) {
  using Variable = TableVariable;
  return (tables.legs(Variable::kPlatformJointAngle) | tables.legs(Variable::kPlatformJointRate) |
          tables.legs(Variable::kSwingAngle) | tables.legs(Variable::kSwingRate)) != 0u;
}

double largest(const Vector6& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

Compensator::Compensator(const Machine& machine) : model_(machine), polynomials_(machine), now_(one_row()) {
  prepare();
}

Compensator::Compensator(const CompensationData& data, const std::string& source)
    : model_(compensation_model(data, source)),
      polynomials_(data.machine),
      tables_(data.tables),
      limits_(data.limits),
      reference_temperature_c_(data.reference_temperature_c),
      now_(one_row()) {
  try {
    for (const Term& term : model_.terms) term.effect->require(now_);
  } catch (const std::invalid_argument& error) {
    throw CompensationError(CompensationFault::kUnknownEffect,
                            source + ": " + error.what() + " (expected effects that a controller can correct)");
  }
  prepare();
}

void Compensator::prepare() {
  direction_per_mm_ = 2.0 / limits_.reversal_travel_mm;
  nominal_triangle_ = PlatformTriangle(shared_joints(assemble(model_.nominal, Vector6::Zero(), Ports())));
  has_effects_ = !model_.terms.empty() || !tables_.empty();
  const std::vector<Term> all = std::move(model_.terms);
  model_.terms.clear();
  for (const Term& term : all) {
    contraction_ += kLever * steepness(term, machine());
    needs_leg_force_ = needs_leg_force_ || needs(*term.effect, "leg_force");
    if (needs(*term.effect, "temperature_c") || !polynomials_.fold(term)) model_.terms.push_back(term);
  }
  contraction_ += kLever * tables_.steepest();
  bend_ = kLever * tables_.sharpest();
  needs_leg_force_ = needs_leg_force_ || tables_.legs(TableVariable::kLegForce) != 0u;
  needs_pose_ = needs_leg_force_ || needs_platform(tables_);
  reset();
}

void Compensator::reset() noexcept {
  travel_direction_.setZero();
  joint_direction_.setZero();
  followed_mm_.setConstant(kUnknown);
  checked_mm_.setConstant(kUnknown);
  last_correction_mm_.setZero();
  correction_step_mm_.setZero();
  has_last_ = false;
  angles_ = nominal_angles_ = RssrAngles();
  last_pose_ = home_pose(model_.nominal);
}

/// Update the directions of travel by the play operator of the commanded travel (see the header). Return false, and
/// change nothing, for a pose that is only checked.
bool Compensator::follow(const Vector6& nominal_mm, const Direction& direction) noexcept {
  const Vector6& velocity_mm_s = direction.velocity_mm_s;
  if (velocity_mm_s.isZero(0.0) && largest(nominal_mm - followed_mm_) > kFollow_mm) {
    const bool is_near_checked = largest(nominal_mm - checked_mm_) <= kFollow_mm;
    if (!is_near_checked) {
      checked_mm_ = nominal_mm;
      return false;
    }
    followed_mm_ = checked_mm_;
  }
  checked_mm_.setConstant(kUnknown);
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
    const double turned_mm = moved.length_mm * moved.rate_rad_s(k % 2), rate = moving.rate_rad_s(k % 2);
    const double sense = rate == 0.0 ? 0.0 : std::copysign(1.0, rate);
    const double towards = rate == 0.0 ? turned_mm : std::copysign(turned_mm, rate);
    const double play = std::clamp(joint_direction_[k] + direction_per_mm_ * towards, -1.0, 1.0);
    joint_direction_[k] = is_first ? sense : play;
  }
}

void Compensator::set_state(const Direction& direction, const Vector6& travel_direction,
                            const Vector6& leg_force) noexcept {
  const double warming_k = direction.temperature_c - reference_temperature_c_;
  polynomials_.settle(
      {direction.velocity_mm_s, travel_direction, leg_force, std::isfinite(warming_k) ? warming_k : 0.0});
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
  set(TableVariable::kTravelDirection, travel_direction);
  set(TableVariable::kLegForce, leg_force);
  set(TableVariable::kSliderJointDirection, joint_direction_);
  state[TableVariable::kTemperature].setConstant(direction.temperature_c);
  state[TableVariable::kWarming].setConstant(direction.temperature_c - reference_temperature_c_);
  fill_joints(model_.nominal, nominal_pose, nominal_mm, direction.velocity_mm_s, tables_, state);
  tables_.settle(state);
}

/// Compute the static equilibrium of the nominal machine: forces in the legs under a newton of load at the reference
/// point, tension positive.
HEXDBB_MULTIVERSION
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
  for (int k = 0; k < kLegs; ++k) out[k] = is_held ? -carried.share[k] * nominal.machine.leg_length_mm : 0.0;
  return out;
}

const Ports& Compensator::push_at(const Vector6& sliders_mm) noexcept {
  polynomials_.evaluate(sliders_mm, push_);
  if (!model_.terms.empty()) {
    now_.sliders_mm.row(0) = sliders_mm.transpose();
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>> row(
        push_.value.data(), 1, int{port::kCount}, Eigen::OuterStride<>(1));
    for (const Term& term : model_.terms) term.effect->push(SampleBlock{now_, 0, 1}, term.values, row);
  }
  if (!tables_.empty()) tables_.add(sliders_mm, push_);
  if (part_ != 1.0) push_.value *= part_;
  return push_;
}

/// Solve the fixed point, starting where the last two corrections lead in a straight line. A slider's coordinate depends almost only on itself: two steps
/// determine the ratio r at which they shrink, and the sum of all that follow is step r / (1 - r) (Aitken). The
/// remaining error is of second order in the steps.
bool Compensator::solve(const Pose& pose, const Vector6& nominal_mm, SliderTargets& out) noexcept {
  Vector6 at = nominal_mm + last_correction_mm_ + correction_step_mm_, step_before;
  double left_mm = 0.0, largest_before = 0.0;
  for (out.iterations = 1;; ++out.iterations) {
    const InverseResult result = inverse(model_.nominal, pose, push_at(at));
    out.status = result.status;
    out.slider = result.leg;
    out.sliders_mm = result.sliders_mm;
    if (result.status == Status::kUnreachable) return false;
    const Vector6 step = result.sliders_mm - at;
    const double largest_step = largest(step);
    left_mm = contraction_ * largest_step;
    if (out.iterations > 1) {
      left_mm *= std::min(kCurvature_mm * largest_before, 1.0);
      left_mm += bend_ * largest_step;
      const auto one = step_before.array();
      const auto two = step.array();
      out.sliders_mm.array() += (two.abs() < 0.5 * one.abs()).select(two.square() / (one - two), 0.0);
    }
    if (left_mm <= kTolerance_mm || out.iterations == kMaxIterations) break;
    at = out.sliders_mm;
    step_before = step;
    largest_before = largest_step;
  }
  if (!(left_mm <= kLargestError_mm)) out.status = Status::kIterationLimit;
  out.correction_mm = out.sliders_mm - nominal_mm;
  return out.status == Status::kOk;
}

SliderTargets Compensator::sliders(const Pose& pose, const Direction& direction) noexcept {
  SliderTargets out;
  const auto refuse = [&](Status status) {
    out.status = status;
    out.sliders_mm = last_targets_mm_;
    out.correction_mm = last_correction_mm_;
    return out;
  };
  if (!pose.position.allFinite() || !pose.rotation.allFinite() || !direction.velocity_mm_s.allFinite()) {
    return refuse(Status::kNotANumber);
  }
  const double fade = 1.0 / kFadeCalls;
  part_ = part_ < wanted_part_ ? std::min(part_ + fade, wanted_part_) : std::max(part_ - fade, wanted_part_);

  const InverseResult nominal = inverse(model_.nominal, pose, none_);
  out.slider = nominal.leg;
  if (nominal.status == Status::kUnreachable) return refuse(nominal.status);
  const bool is_followed = follow(nominal.sliders_mm, direction);
  const Vector6 force = needs_leg_force_ ? leg_force(pose, nominal.sliders_mm) : Vector6::Zero();
  set_state(direction, travel_direction_, force);
  set_tables(direction, travel_direction_, force, pose, nominal.sliders_mm);
  if (!solve(pose, nominal.sliders_mm, out)) return refuse(out.status);
  out.largest_correction_mm = out.correction_mm.cwiseAbs().maxCoeff(&out.slider);
  if (!(out.largest_correction_mm <= limits_.max_correction_mm)) return refuse(Status::kCorrectionLimit);
  out.slider = -1;
  if (is_followed) {
    correction_step_mm_ = has_last_ ? Vector6(out.correction_mm - last_correction_mm_) : Vector6(Vector6::Zero());
    has_last_ = true;
    last_targets_mm_ = out.sliders_mm;
    last_correction_mm_ = out.correction_mm;
  }
  return out;
}

PoseEstimate Compensator::pose(const Vector6& sliders_mm, const Direction& direction) noexcept {
  PoseEstimate out;
  out.pose = last_pose_;
  if (!sliders_mm.allFinite() || !direction.velocity_mm_s.allFinite()) {
    out.status = Status::kNotANumber;
    return out;
  }
  Vector6 travel_direction = travel_direction_;
  for (int k = 0; k < kLegs; ++k) {
    if (direction.velocity_mm_s[k] != 0.0) travel_direction[k] = std::copysign(1.0, direction.velocity_mm_s[k]);
  }
  Vector6 force = Vector6::Zero();
  Pose nominal_pose = last_pose_;
  if (needs_pose_) {
    const Mechanism nominal = assemble(model_.nominal, sliders_mm, none_);
    const ForwardResult standing = forward(nominal, nominal_triangle_, nominal_angles_);
    if (standing.status == Status::kOk) {
      nominal_pose = standing.pose;
      if (needs_leg_force_) force = leg_force(standing.pose, sliders_mm);
    }
  }
  set_state(direction, travel_direction, force);
  set_tables(direction, travel_direction, force, nominal_pose, sliders_mm);
  const Mechanism mechanism = assemble(model_.nominal, sliders_mm, push_at(sliders_mm));
  const ForwardResult found =
      joints_are_shared(mechanism) ? forward(mechanism, angles_) : forward_six(mechanism, last_pose_);
  out.residual_mm = found.residual_mm;
  out.iterations = found.iterations;
  out.status = found.status;
  if (found.status == Status::kOk) out.pose = last_pose_ = found.pose;
  return out;
}

Direction direction_between(const NominalGeometry& nominal, const Pose& from, const Pose& to, double step_s) noexcept {
  Direction out;
  const InverseResult first = inverse(nominal, from), second = inverse(nominal, to);
  const bool are_reached = first.status != Status::kUnreachable && second.status != Status::kUnreachable;
  if (are_reached && step_s > 0.0) out.velocity_mm_s = (second.sliders_mm - first.sliders_mm) / step_s;
  return out;
}

Compensator load_compensation(const std::string& path) { return Compensator(read_compensation(path), path); }

Compensator load_compensation(const std::string& path, const Machine& machine) {
  const CompensationData data = read_compensation(path);
  require_machine(data.machine, machine, path);
  return Compensator(data, path);
}

}  // namespace hexdbb
