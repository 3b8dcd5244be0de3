#include <algorithm>
#include <cmath>

#include "hexdbb/compensation.hpp"
#include "kernel_types.hpp"
#include "leg_kernel.hpp"
#include "multiversion.hpp"
#include "slider_dependence.hpp"
#include "travel_limits.hpp"

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
          tables.legs(Variable::kSwingAngle) | tables.legs(Variable::kSwingRate) |
          tables.legs(Variable::kLegInclination)) != 0u;
}

}  // namespace

Compensator::Compensator(const Machine& machine)
    : model_(machine), polynomials_(machine), waves_(machine), legs_(model_.nominal), now_(one_row()) {
  prepare();
}

Compensator::Compensator(const CompensationData& data, const std::string& source)
    : model_(compensation_model(data, source)),
      polynomials_(data.machine),
      waves_(data.machine),
      tables_(data.tables),
      limits_(data.limits),
      reference_temperature_c_(data.reference_temperature_c),
      legs_(model_.nominal),
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
    const bool is_known_alone = needs(*term.effect, "temperature_c");
    if (is_known_alone || !(polynomials_.fold(term) || waves_.fold(term))) model_.terms.push_back(term);
  }
  is_folded_ = model_.terms.empty() && !tables_.follows_sliders();
  contraction_ += kLever * tables_.steepest();
  bend_ = kLever * tables_.sharpest();
  for (const TableVariable each : {TableVariable::kLegForce, TableVariable::kDriveLoad, TableVariable::kCarriageLoad}) {
    needs_leg_force_ = needs_leg_force_ || tables_.legs(each) != 0u;
  }
  needs_pose_ = needs_leg_force_ || needs_platform(tables_);
  reset();
}

void Compensator::reset() noexcept {
  travel_direction_.setZero();
  joint_direction_.setZero();
  for (Vector6& each : since_reversal_mm_) each.setConstant(kLongAgo);
  followed_mm_.setConstant(kUnknown);
  checked_mm_.setConstant(kUnknown);
  last_correction_mm_ = correction_step_mm_ = LegRow();
  has_last_ = false;
  angles_ = nominal_angles_ = RssrAngles();
  last_pose_ = home_pose(model_.nominal);
}

HEXDBB_MULTIVERSION_WIDE
const LegPorts& Compensator::push_at(const LegRow& sliders_mm) noexcept {
  rssr::push_folded(polynomials_, waves_, rssr::load(sliders_mm), push_);
  push_beside(sliders_mm);
  return push_;
}

/// Add what is not folded, and take the part that is in force.
void Compensator::push_beside(const LegRow& sliders_mm) noexcept {
  if (!model_.terms.empty()) {
    now_.sliders_mm.row(0) = sliders_mm.legs().transpose();
    Ports pushed;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>> row(
        pushed.value.data(), 1, int{port::kCount}, Eigen::OuterStride<>(1));
    for (const Term& term : model_.terms) term.effect->push(SampleBlock{now_, 0, 1}, term.values, row);
    for (int column = 0; column < port::kBall; ++column) {
      push_.value[LegPorts::place(column)] += pushed.value[column];
    }
    push_.repeat();
  }
  tables_.add(sliders_mm, push_);
  if (part_ == 1.0) return;
  for (double& each : push_.value) each *= part_;
}

/// Compute the nominal coordinates of a pose. Return the first leg that is too short, or -1.
HEXDBB_MULTIVERSION_WIDE
int Compensator::reach(const Pose& pose) noexcept {
  const rssr::Vec<Lanes> reach_mm = rssr::reach_of(pose, rssr::load3(legs_.platform_joint), rssr::load3(legs_.vertex));
  const rssr::LegSolution<Lanes> found = rssr::solve_nominal(legs_, reach_mm);
  rssr::store3(reach_mm, reach_mm_);
  store(found.slider_mm, nominal_mm_.of);
  return rssr::too_short(found);
}

/// Solve the fixed point, starting where the last two corrections lead in a straight line. A slider's coordinate depends
/// almost only on itself: two steps determine the ratio r at which they shrink, and the sum of all that follow is
/// step r / (1 - r) (Aitken). The remaining error is of second order in the steps.
HEXDBB_MULTIVERSION_WIDE
bool Compensator::solve(const Pose& pose, SliderTargets& out) noexcept {
  const Lanes nominal_mm = rssr::load(nominal_mm_);
  const rssr::Vec<Lanes> reach_mm = rssr::load3(reach_mm_);
  Lanes at = nominal_mm + rssr::load(last_correction_mm_) + rssr::load(correction_step_mm_), step_before = {}, solved;
  double left_mm = 0.0, largest_before = 0.0;
  for (out.iterations = 1;; ++out.iterations) {
    rssr::push_folded(polynomials_, waves_, at, push_);
    if (!is_folded_ || part_ != 1.0) {
      LegRow sliders_mm;
      store(at, sliders_mm.of);
      push_beside(sliders_mm);
    }
    const rssr::LegSolution<Lanes> found = rssr::solve_pushed(legs_, pose.rotation, reach_mm, push_);
    out.slider = rssr::too_short(found);
    out.status = Status::kUnreachable;
    if (out.slider >= 0) return false;
    solved = found.slider_mm;
    const Lanes step = solved - at;
    const double largest_step = rssr::largest_magnitude(step);
    Lanes further = solved;
    left_mm = contraction_ * largest_step;
    if (out.iterations > 1) {
      left_mm *= std::min(kCurvature_mm * largest_before, 1.0);
      left_mm += bend_ * largest_step;
      const Lanes rest = step * step / (step_before - step);
      further += rssr::magnitude(step) < 0.5 * rssr::magnitude(step_before) ? rest : Lanes{};
    }
    at = further;
    if (left_mm <= kTolerance_mm || out.iterations == kMaxIterations) break;
    step_before = step;
    largest_before = largest_step;
  }
  InverseResult last;
  LegRow row;
  store(solved, row.of);
  last.sliders_mm = row.legs();
  check_limits(machine(), last);
  out.status = left_mm <= kLargestError_mm ? last.status : Status::kIterationLimit;
  out.slider = last.leg;
  store(at, row.of);
  out.sliders_mm = row.legs();
  store(at - nominal_mm, correction_mm_.of);
  out.correction_mm = correction_mm_.legs();
  return out.status == Status::kOk;
}

/// Make a call's corrections the start of the next.
HEXDBB_MULTIVERSION_WIDE
void Compensator::remember(const SliderTargets& out) noexcept {
  const Lanes correction_mm = rssr::load(correction_mm_);
  store(has_last_ ? correction_mm - rssr::load(last_correction_mm_) : Lanes{}, correction_step_mm_.of);
  last_correction_mm_ = correction_mm_;
  last_targets_mm_ = out.sliders_mm;
  has_last_ = true;
}

SliderTargets Compensator::sliders(const Pose& pose, const Direction& direction) noexcept {
  SliderTargets out;
  const auto refuse = [&](Status status) {
    out.status = status;
    out.sliders_mm = last_targets_mm_;
    out.correction_mm = last_correction_mm_.legs();
    return out;
  };
  if (!pose.position.allFinite() || !pose.rotation.allFinite() || !direction.velocity_mm_s.allFinite()) {
    return refuse(Status::kNotANumber);
  }
  const double fade = 1.0 / kFadeCalls;
  part_ = part_ < wanted_part_ ? std::min(part_ + fade, wanted_part_) : std::max(part_ - fade, wanted_part_);

  out.slider = reach(pose);
  if (out.slider >= 0) return refuse(Status::kUnreachable);
  const Vector6 nominal_mm = nominal_mm_.legs();
  const bool is_followed = follow(nominal_mm, direction);
  const Vector6 force = needs_leg_force_ ? leg_force(pose, nominal_mm) : Vector6::Zero();
  set_tables(direction, travel_direction_, force, pose, nominal_mm);
  set_state(direction, travel_direction_, force);
  if (!solve(pose, out)) return refuse(out.status);
  out.largest_correction_mm = out.correction_mm.cwiseAbs().maxCoeff(&out.slider);
  if (!(out.largest_correction_mm <= limits_.max_correction_mm)) return refuse(Status::kCorrectionLimit);
  out.slider = -1;
  if (is_followed) remember(out);
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
    const Mechanism nominal = assemble(model_.nominal, sliders_mm, Ports());
    const ForwardResult standing = forward(nominal, nominal_triangle_, nominal_angles_);
    if (standing.status == Status::kOk) {
      nominal_pose = standing.pose;
      if (needs_leg_force_) force = leg_force(standing.pose, sliders_mm);
    }
  }
  set_tables(direction, travel_direction, force, nominal_pose, sliders_mm);
  set_state(direction, travel_direction, force);
  const Mechanism mechanism = assemble(model_.nominal, sliders_mm, push_at(LegRow(sliders_mm)).ports());
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

Direction direction_through(const Vector6& before_mm, const Vector6& at_mm, const Vector6& after_mm, double before_s,
                            double after_s) noexcept {
  Direction out;
  if (!(before_s > 0.0) || !(after_s > 0.0)) return out;
  const Vector6 arriving_mm_s = (at_mm - before_mm) / before_s, leaving_mm_s = (after_mm - at_mm) / after_s;
  out.velocity_mm_s = (after_s * arriving_mm_s + before_s * leaving_mm_s) / (before_s + after_s);
  out.acceleration_mm_s2 = 2.0 * (leaving_mm_s - arriving_mm_s) / (before_s + after_s);
  return out;
}

Compensator load_compensation(const std::string& path) { return Compensator(read_compensation(path), path); }

Compensator load_compensation(const std::string& path, const Machine& machine) {
  const CompensationData data = read_compensation(path);
  require_machine(data.machine, machine, path);
  return Compensator(data, path);
}

}  // namespace hexdbb
