#include <algorithm>
#include <cmath>

#include "hexdbb/compensation.hpp"

namespace hexdbb {

namespace {

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
// A push answers to a change of the slider's place by less than this part of it: 20 um of pitch error twice a turn of
// 5 mm are a twentieth.
constexpr double kContraction = 0.1;
// What four iterations must reach at least.
constexpr double kGoodEnough_mm = 1e-5;

/// One row with every column of the state a controller can fill; what it cannot stays empty.
Samples one_row() {
  Samples out;
  out.sliders_mm.setZero(1, int{kLegs});
  out.state.time_s.setZero(1);  // the time at which nothing has drifted yet
  out.state.temperature_c.setConstant(1, kNowhere);
  out.state.warming_k.setConstant(1, kNowhere);
  out.state.velocity_mm_s.setZero(1, int{kLegs});
  out.state.side.setZero(1, int{kLegs});
  out.state.since_reversal_mm.setConstant(1, int{kLegs}, kLongAgo);  // any play is crossed
  out.state.leg_force.setZero(1, int{kLegs});
  return out;
}

bool needs(const Effect& effect, const std::string& column) {
  const std::vector<std::string>& all = effect.info().needs;
  return std::find(all.begin(), all.end(), column) != all.end();
}

double largest(const Vector6& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

Compensator::Compensator(const Machine& machine) : model_(machine), polynomials_(machine) { prepare(); }

Compensator::Compensator(const CompensationData& data, const std::string& source)
    : model_(compensation_model(data, source)),
      polynomials_(data.machine),
      limits_(data.limits),
      reference_temperature_c_(data.reference_temperature_c) {
  prepare();
  try {
    for (const Term& term : model_.terms) term.effect->require(now_);
  } catch (const std::invalid_argument& error) {
    throw CompensationError(CompensationFault::kUnknownEffect,
                            source + ": " + error.what() + " (expected effects that a controller can correct)");
  }
}

void Compensator::prepare() {
  now_ = one_row();
  nominal_triangle_ = PlatformTriangle(shared_joints(assemble(model_.nominal, Vector6::Zero(), Ports())));
  has_effects_ = !model_.terms.empty();
  std::vector<Term> asked;
  for (Term& term : model_.terms) {
    if (term.effect->info().needs.empty() && polynomials_.fold(term)) continue;
    needs_leg_force_ = needs_leg_force_ || needs(*term.effect, "leg_force");
    asked.push_back(std::move(term));
  }
  model_.terms = std::move(asked);
  reset();
}

void Compensator::reset() noexcept {
  side_.setZero();
  followed_mm_.setConstant(kNowhere);
  visited_mm_.setConstant(kNowhere);
  last_correction_mm_.setZero();
  angles_ = nominal_angles_ = RssrAngles();
  last_pose_ = home_pose(model_.nominal);
}

/// Play operator of the commanded travel; see the header. False, and nothing changed, for a pose that is only visited.
bool Compensator::follow(const Vector6& nominal_mm, const Vector6& velocity_mm_s) noexcept {
  if (velocity_mm_s.isZero(0.0) && largest(nominal_mm - followed_mm_) > kFollow_mm) {
    const bool is_near_visited = largest(nominal_mm - visited_mm_) <= kFollow_mm;
    if (!is_near_visited) {
      visited_mm_ = nominal_mm;
      return false;
    }
    followed_mm_ = visited_mm_;
  }
  visited_mm_.setConstant(kNowhere);
  if (!std::isnan(followed_mm_[0])) {
    for (int k = 0; k < kLegs; ++k) {
      const double travel = nominal_mm[k] - followed_mm_[k];
      const double towards = velocity_mm_s[k] == 0.0 ? travel : std::copysign(travel, velocity_mm_s[k]);
      side_[k] = std::clamp(side_[k] + 2.0 * towards / limits_.reversal_travel_mm, -1.0, 1.0);
    }
  }
  followed_mm_ = nominal_mm;
  return true;
}

void Compensator::set_state(const Direction& direction, const Vector6& side) noexcept {
  State& state = now_.state;
  state.velocity_mm_s.row(0) = direction.velocity_mm_s.transpose();
  state.side.row(0) = side.transpose();
  state.temperature_c[0] = direction.temperature_c;
  state.warming_k[0] = direction.temperature_c - reference_temperature_c_;
}

/// Static equilibrium of the nominal machine; by virtual work -dz / dl, read off a plumb bar 1000 km long (state.hpp).
void Compensator::set_leg_force(const Pose& pose, const Vector6& nominal_mm) noexcept {
  const SetUp plumb{Vector3(0.0, 0.0, -1e9), Vector3::Zero(), 0.0};
  Ports sensitivity;
  reading_sensitivity(model_.nominal, assemble(model_.nominal, nominal_mm, Ports()), nominal_triangle_, pose, plumb,
                      Ports(), sensitivity);
  now_.state.leg_force.row(0) = -sensitivity.leg().transpose();
}

const Ports& Compensator::push_at(const Vector6& sliders_mm) noexcept {
  polynomials_.evaluate(sliders_mm, push_);
  if (!model_.terms.empty()) {
    now_.sliders_mm.row(0) = sliders_mm.transpose();
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>> row(
        push_.value.data(), 1, int{port::kCount}, Eigen::OuterStride<>(1));
    for (const Term& term : model_.terms) term.effect->push(SampleBlock{now_, 0, 1}, term.values, row);
  }
  if (part_ != 1.0) push_.value *= part_;
  return push_;
}

/// Fixed point from the last correction. Stops where the next change would be below the tolerance, taking each to be
/// the same part of the one before.
bool Compensator::solve(const Pose& pose, const Vector6& nominal_mm, SliderTargets& out) noexcept {
  Vector6 at = nominal_mm + last_correction_mm_;
  double before = 0.0, next = 0.0;
  for (out.iterations = 1;; ++out.iterations) {
    const InverseResult result = inverse(model_.nominal, pose, push_at(at));
    out.status = result.status;
    out.slider = result.leg;
    out.sliders_mm = result.sliders_mm;
    if (result.status == Status::kUnreachable) return false;
    const double change = largest(result.sliders_mm - at);
    next = change * (out.iterations == 1 ? kContraction : std::min(change / before, 1.0));
    if (next <= kTolerance_mm || out.iterations == kMaxIterations) break;
    at = result.sliders_mm;
    before = change;
  }
  if (!(next <= kGoodEnough_mm)) out.status = Status::kIterationLimit;
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

  const InverseResult nominal = inverse(model_.nominal, pose);
  out.slider = nominal.leg;
  if (nominal.status == Status::kUnreachable) return refuse(nominal.status);
  const bool is_followed = follow(nominal.sliders_mm, direction.velocity_mm_s);
  set_state(direction, side_);
  if (needs_leg_force_) set_leg_force(pose, nominal.sliders_mm);
  if (!solve(pose, nominal.sliders_mm, out)) return refuse(out.status);
  out.largest_correction_mm = out.correction_mm.cwiseAbs().maxCoeff(&out.slider);
  if (!(out.largest_correction_mm <= limits_.max_correction_mm)) return refuse(Status::kCorrectionLimit);
  out.slider = -1;
  if (is_followed) {
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
  Vector6 side = side_;
  for (int k = 0; k < kLegs; ++k) {
    if (direction.velocity_mm_s[k] != 0.0) side[k] = std::copysign(1.0, direction.velocity_mm_s[k]);
  }
  set_state(direction, side);
  if (needs_leg_force_) {
    const Mechanism nominal = assemble(model_.nominal, sliders_mm, Ports());
    const ForwardResult standing = forward(nominal, nominal_triangle_, nominal_angles_);
    if (standing.status == Status::kOk) set_leg_force(standing.pose, sliders_mm);
  }
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
