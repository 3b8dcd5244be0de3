#include "hexdbb/kinematics.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel_types.hpp"
#include "largest_turns.hpp"
#include "leg_kernel.hpp"
#include "multiversion.hpp"
#include "six_kernel.hpp"
#include "travel_limits.hpp"

namespace hexdbb {

namespace {

using rssr::vec;

// Ratio of a determinant to the size of its terms below which locked sliders do not hold the platform: at 1e-9 an error
// of 1 nm in a leg moves it by a metre.
constexpr double kSingularRatio = 1e-9;

/// The loops of one sample: circles, sides, and the determinant (squared) below which they count as singular, a
/// fraction of its terms' largest possible size.
struct LoopProblem {
  rssr::Circle<double> circle[3];
  double side_squared[3];
  double mm_per_f;
  double limit_squared;
  double open[3] = {};  // F of the start of a tracked solution
};

struct LoopState {
  double c[3], s[3];
  rssr::Loops<double> loops;
  double residual_mm = std::numeric_limits<double>::infinity();
};

bool pose_problem(const Mechanism& mechanism, const PlatformTriangle& triangle, LoopProblem& out) {
  constexpr double kFraction = 64.0 * kSingularRatio * kSingularRatio;
  out.mm_per_f = triangle.mm_per_f;
  out.limit_squared = kFraction;
  for (int i = 0; i < kGuideways; ++i) {
    rssr::Circle<double>& circle = out.circle[i];
    circle = rssr::meeting_circle(vec(mechanism.slider_joint.col(2 * i)), vec(mechanism.slider_joint.col(2 * i + 1)),
                                  mechanism.leg_length[2 * i], mechanism.leg_length[2 * i + 1]);
    if (!(circle.radius_squared > 0.0) || !(circle.span_squared > 0.0)) return false;
    out.side_squared[i] = triangle.side_squared[i];
    out.limit_squared *= circle.radius_squared * triangle.side_squared[i];
  }
  return true;
}

LoopState start_at(const RssrAngles& angles) {
  LoopState out;
  for (int i = 0; i < kGuideways; ++i) {
    out.c[i] = angles.cosine[i];
    out.s[i] = angles.sine[i];
  }
  return out;
}

/// Solve F = `open_part` * open by Newton until the residual is below `tolerance_mm`. Ball joints that all move inward
/// shorten all sides, so that in the actual assembly of the machine the determinant is negative; a search that reaches
/// the other side of a singularity, or takes a step so long that it may have crossed one, would find another assembly
/// and is ended.
Status newton(const LoopProblem& problem, double open_part, double tolerance_mm, double largest_turn, LoopState& state,
              int& iterations) {
  constexpr int kMost = 10;  // steps; quadratic convergence needs fewer
  for (int steps = 0;; ++steps) {
    state.loops = rssr::close_loops(problem.circle, state.c, state.s, problem.side_squared);
    double (&f)[3] = state.loops.f;
    for (int i = 0; i < kGuideways; ++i) f[i] -= open_part * problem.open[i];
    state.residual_mm = problem.mm_per_f * std::max({std::abs(f[0]), std::abs(f[1]), std::abs(f[2])});
    // The step that led here had its determinant checked, so only a solution without a step needs a check of its own.
    if (state.residual_mm <= tolerance_mm && steps > 0) return Status::kOk;
    const rssr::LoopJacobian<double> jacobian = rssr::loop_jacobian(problem.circle, state.c, state.s, state.loops);
    if (!(jacobian.determinant < 0.0) || !(jacobian.determinant * jacobian.determinant > problem.limit_squared)) {
      return Status::kSingular;
    }
    if (steps == kMost) return Status::kIterationLimit;
    double step[3];
    rssr::cramer_step(state.loops, jacobian, step);  // (2.18)-(2.21)
    if (!(std::max({std::abs(step[0]), std::abs(step[1]), std::abs(step[2])}) < largest_turn)) {
      return Status::kIterationLimit;
    }
    for (int i = 0; i < kGuideways; ++i) rssr::turn(step[i], state.c[i], state.s[i]);
    ++iterations;
  }
}

/// Return the machine with its platform level over the base centre and all sliders at equal distance from the middle of
/// their guideways, and its angles: the start of a search without a neighbour.
Mechanism symmetric_start(const Mechanism& target, const PlatformTriangle& triangle, LoopState& state) {
  constexpr double kRadiusPart = 0.66;  // of the squared leg length: half-way up
  Mechanism out = target;
  const Vector3 middle = triangle.joints.rowwise().mean();
  for (int i = 0; i < kGuideways; ++i) {
    const Vector3 first = target.slider_joint.col(2 * i), second = target.slider_joint.col(2 * i + 1);
    const Vector3 along = (second - first).normalized();
    const Vector3 nearest = first - along.dot(first) * along;  // to the base centre
    const double leg = std::min(target.leg_length[2 * i], target.leg_length[2 * i + 1]);
    const double half_span = leg * std::sqrt(1.0 - kRadiusPart);
    out.slider_joint.col(2 * i) = nearest - half_span * along;
    out.slider_joint.col(2 * i + 1) = nearest + half_span * along;
    out.leg_length[2 * i] = out.leg_length[2 * i + 1] = leg;
    const double reach = nearest.norm() - (triangle.joints.col(i) - middle).norm();
    state.s[i] = std::clamp(reach / (leg * std::sqrt(kRadiusPart)), -0.95, 0.95);
    state.c[i] = std::sqrt(1.0 - state.s[i] * state.s[i]);
  }
  return out;
}

/// Solve without a neighbour: the sliders are moved from the symmetric start to their positions, in steps that are
/// halved where Newton does not converge, so that the solution is the assembly the machine reaches without being taken
/// apart.
Status track(const Mechanism& target, const PlatformTriangle& triangle, LoopState& state, int& iterations) {
  constexpr double kCoarse_mm = 1e-3;
  constexpr double kSmallestStep = 1.0 / 1024.0;
  const Mechanism start = symmetric_start(target, triangle, state);
  LoopProblem problem;
  if (!pose_problem(start, triangle, problem)) return Status::kUnreachable;
  const rssr::Loops<double> at_start = rssr::close_loops(problem.circle, state.c, state.s, problem.side_squared);
  double done = 0.0, step = 0.25;
  while (done < 1.0) {
    const double next_done = std::min(done + step, 1.0);
    Mechanism between = target;
    between.slider_joint = (1.0 - next_done) * start.slider_joint + next_done * target.slider_joint;
    between.leg_length = (1.0 - next_done) * start.leg_length + next_done * target.leg_length;
    for (int i = 0; i < kGuideways; ++i) problem.open[i] = at_start.f[i];
    LoopState next = state;
    Status status = pose_problem(between, triangle, problem) ? Status::kOk : Status::kUnreachable;
    if (status == Status::kOk) {
      const double tolerance = next_done < 1.0 ? kCoarse_mm : kResidualTolerance_mm;
      status = newton(problem, 1.0 - next_done, tolerance, kHomeTurn, next, iterations);
    }
    if (status == Status::kOk) {
      state = next;
      done = next_done;
      step *= 2.0;
      continue;
    }
    step *= 0.5;
    if (step < kSmallestStep) {
      state.residual_mm = std::max(next.residual_mm, triangle.mm_per_f * (1.0 - done) * problem.side_squared[0]);
      return status;
    }
  }
  return Status::kOk;
}

InverseResult failed(Status status, int leg) { return {Vector6::Zero(), status, leg}; }

/// Return the largest magnitude; NaN where there is one.
double largest_magnitude(const double (&values)[kLegs]) {
  double out = 0.0;
  for (const double each : values) {
    if (!(std::abs(each) <= out || std::isnan(out))) out = std::abs(each);
  }
  return out;
}

/// Shorten a long step to half a radian or 200 mm, so that a search from a distant start stays on its branch.
rssr::Six<double> shortened(const rssr::Six<double>& step) {
  constexpr double kLongestTurn_rad = 0.5, kLongestMove_mm = 200.0, kTiny = 1e-300;
  const double turn_rad = std::sqrt(rssr::dot(step.moment, step.moment)) / rssr::kLever_mm;
  const double move_mm = std::sqrt(rssr::dot(step.force, step.force));
  return std::min({1.0, kLongestTurn_rad / std::max(turn_rad, kTiny), kLongestMove_mm / std::max(move_mm, kTiny)}) *
         step;
}

}  // namespace

void check_limits(const Machine& machine, InverseResult& out) {
  for (int k = 0; k < kLegs; k += 2) {
    const double low = out.sliders_mm[k], high = out.sliders_mm[k + 1];
    if (!(low >= machine.travel_min_mm[k]) || !(low <= machine.travel_max_mm[k])) {
      out.status = Status::kTravel;
      out.leg = k;
      return;
    }
    if (!(high >= machine.travel_min_mm[k + 1]) || !(high <= machine.travel_max_mm[k + 1])) {
      out.status = Status::kTravel;
      out.leg = k + 1;
      return;
    }
    if (!(high - low >= machine.min_gap_mm)) {
      out.status = Status::kGap;
      out.leg = k + 1;
      return;
    }
  }
}

const char* status_name(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kUnreachable:
      return "unreachable: a leg is too short";
    case Status::kSingular:
      return "singular: locked sliders do not hold the platform";
    case Status::kIterationLimit:
      return "iteration limit: no pose found";
    case Status::kTravel:
      return "travel: a slider would leave its travel";
    case Status::kGap:
      return "gap: two sliders would come closer than the minimum gap";
    case Status::kCorrectionLimit:
      return "correction limit: more than the compensation file allows";
    case Status::kNotANumber:
      return "not a number: pose, coordinates and velocities must be finite";
  }
  return "unknown status";
}

HEXDBB_MULTIVERSION
InverseResult inverse(const NominalGeometry& nominal, const Pose& pose, const Ports& push) noexcept {
  InverseResult out;
  const Machine& machine = nominal.machine;
  for (int k = 0; k < kLegs; ++k) {
    const rssr::Vec<double> nominal_reach =
        rssr::reach_of(pose, vec(nominal.platform_joint.col(k)), vec(nominal.vertex.col(k)));
    const rssr::Vec<double> reach =
        nominal_reach + rssr::turned(pose.rotation, vec(push.platform_joint(k))) - vec(push.slider_joint(k));
    const double length = machine.leg_length_mm[k] + push.leg()[k], side = k % 2 == 0 ? -1.0 : 1.0;
    const rssr::LegSolution<double> found = rssr::solve_leg(reach, vec(nominal.direction.col(k)), length, side);
    if (!(found.half_span_squared > 0.0)) return failed(Status::kUnreachable, k);
    out.sliders_mm[k] = found.slider_mm - push.slider()[k];
  }
  check_limits(machine, out);
  return out;
}

Vector3 RssrAngles::angle_rad() const {
  return {std::atan2(sine[0], cosine[0]), std::atan2(sine[1], cosine[1]), std::atan2(sine[2], cosine[2])};
}

HEXDBB_MULTIVERSION_WIDE
ForwardResult forward(const Mechanism& mechanism, const PlatformTriangle& triangle, RssrAngles& angles) noexcept {
  ForwardResult out;
  LoopProblem problem;
  if (!pose_problem(mechanism, triangle, problem)) {
    out.status = Status::kUnreachable;
    return out;
  }
  const RssrAngles home;
  LoopState state = start_at(angles);
  const bool from_home = angles.cosine == home.cosine && angles.sine == home.sine;
  const double turn = from_home ? kHomeTurn : kNeighbourTurn;
  out.status = newton(problem, 0.0, kResidualTolerance_mm, turn, state, out.iterations);
  if (out.status != Status::kOk && !from_home) {
    state = start_at(home);
    out.status = newton(problem, 0.0, kResidualTolerance_mm, kHomeTurn, state, out.iterations);
  }
  if (out.status != Status::kOk) out.status = track(mechanism, triangle, state, out.iterations);
  out.residual_mm = std::isnan(state.residual_mm) ? std::numeric_limits<double>::infinity() : state.residual_mm;
  if (out.status != Status::kOk) return out;
  out.pose = rssr::pose_of(rssr::align(state.loops.q, rssr::frame_of(triangle), vec(triangle.joints.col(0))));
  angles.cosine << state.c[0], state.c[1], state.c[2];
  angles.sine << state.s[0], state.s[1], state.s[2];
  return out;
}

ForwardResult forward(const Mechanism& mechanism, RssrAngles& angles) noexcept {
  return forward(mechanism, PlatformTriangle(shared_joints(mechanism)), angles);
}

ForwardResult forward_six(const Mechanism& mechanism, const Pose& start) noexcept {
  ForwardResult out;
  out.pose = start;
  rssr::Vec<double> base[kLegs], joint[kLegs];
  double length[kLegs];
  for (int k = 0; k < kLegs; ++k) {
    base[k] = vec(mechanism.slider_joint.col(k));
    joint[k] = vec(mechanism.platform_joint.col(k));
    length[k] = mechanism.leg_length[k];
  }
  rssr::PlacedPlatform<double> platform = rssr::placed(start);
  for (;; ++out.iterations) {
    const rssr::SixLegs<double> legs = rssr::six_legs(base, length, joint, platform);
    out.residual_mm = largest_magnitude(legs.too_long);
    if (!(out.residual_mm < 1e6)) {
      out.residual_mm = std::numeric_limits<double>::infinity();
      out.status = Status::kUnreachable;
      return out;
    }
    if (out.residual_mm <= kResidualTolerance_mm) {
      out.pose = rssr::pose_of(platform);
      return out;
    }
    if (out.iterations == kMaxIterations) {
      out.status = Status::kIterationLimit;
      return out;
    }
    const rssr::Wrenches<double> wrenches = rssr::factor(legs.column);
    if (!(wrenches.least_squared > kSingularRatio * kSingularRatio)) {
      out.status = Status::kSingular;
      return out;
    }
    rssr::move_back(shortened(wrenches.movement(legs.too_long)), platform);
  }
}

Pose home_pose(const NominalGeometry& nominal) {
  const Machine& machine = nominal.machine;
  const double lean = machine.base_inradius_mm - machine.platform_circumradius_mm;
  const double leg = *std::min_element(machine.leg_length_mm.begin(), machine.leg_length_mm.end());
  const double height_squared = 0.66 * leg * leg - lean * lean;
  Pose pose;
  pose.position.z() = std::sqrt(std::max(height_squared, 0.01 * leg * leg)) - machine.joint_plane_height_mm;
  return pose;
}

}  // namespace hexdbb
