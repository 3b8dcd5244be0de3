#include "hexdbb/kinematics.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "multiversion.hpp"
#include "rssr_kernel.hpp"

namespace hexdbb {

namespace {

using rssr::Vec;

Vec<double> vec(const Matrix36& columns, int k) { return {columns(0, k), columns(1, k), columns(2, k)}; }

Vector3 vector(const Vec<double>& v) { return {v.x, v.y, v.z}; }

// A determinant this small against its two terms means that locked sliders do not hold the platform.
constexpr double kSingularRatio = 1e-9;
// Largest turn of one Newton step, as a tangent: keeps a search from afar on its own branch.
constexpr double kLargestTurn = 0.5;

/// Square of the determinant below which the loops count as singular: a fraction of its terms' largest possible size.
double singular_limit_squared(const rssr::Circle<double> (&circle)[3], const PlatformTriangle& triangle) {
  constexpr double kFraction = 64.0 * kSingularRatio * kSingularRatio;
  return kFraction * (circle[0].radius_squared * triangle.side_squared[0]) *
         (circle[1].radius_squared * triangle.side_squared[1]) * (circle[2].radius_squared * triangle.side_squared[2]);
}

InverseResult failed(Status status, int leg) { return {Vector6::Zero(), status, leg}; }

void check_limits(const Machine& machine, InverseResult& out) {
  for (int k = 0; k < kLegs; k += 2) {
    const double low = out.sliders_mm[k], high = out.sliders_mm[k + 1];
    if (!(low >= machine.travel_min_mm) || !(low <= machine.travel_max_mm)) {
      out.status = Status::kTravel;
      out.leg = k;
      return;
    }
    if (!(high >= machine.travel_min_mm) || !(high <= machine.travel_max_mm)) {
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

/// Position and orientation from three ball joints: R maps Q2-Q1, Q3-Q1 and their cross product. The reference point lies
/// below the joint plane along the platform's own normal, not along base z as thesis (2.26) has it.
Pose align(const PlatformTriangle& triangle, const rssr::Loops<double>& loops) {
  const Vec<double> x = loops.q[1] - loops.q[0];
  const Vec<double> y = loops.q[2] - loops.q[0];
  const Vec<double> n = rssr::cross(x, y);
  Matrix3 frame;
  frame << x.x, y.x, n.x, x.y, y.y, n.y, x.z, y.z, n.z;
  Pose pose;
  pose.rotation.noalias() = frame.lazyProduct(triangle.frame_inverse);
  pose.position = vector(loops.q[0]) - pose.rotation * triangle.joints.col(0);
  return pose;
}

}  // namespace

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
      return "gap: two sliders would come closer than the smallest gap";
  }
  return "unknown status";
}

HEXDBB_MULTIVERSION
InverseResult inverse(const NominalGeometry& nominal, const Pose& pose, const Ports& push) noexcept {
  InverseResult out;
  const Machine& machine = nominal.machine;
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 joint = nominal.platform_joint.col(k) + push.platform_joint(k);
    const Vector3 base = nominal.vertex.col(k) + push.slider_joint(k);
    const Vector3 from_base = pose.rotation * joint + (pose.position - base);
    const double leg = machine.leg_length_mm + push.leg()[k];
    const double foot = from_base.dot(nominal.direction.col(k));
    const double half_span_squared = leg * leg - (from_base.squaredNorm() - foot * foot);
    if (!(half_span_squared > 0.0)) return failed(Status::kUnreachable, k);
    const double half_span = std::sqrt(half_span_squared);
    out.sliders_mm[k] = (k % 2 == 0 ? foot - half_span : foot + half_span) - push.slider()[k];
  }
  check_limits(machine, out);
  return out;
}

Vector3 RssrAngles::angle_rad() const {
  return {std::atan2(sine[0], cosine[0]), std::atan2(sine[1], cosine[1]), std::atan2(sine[2], cosine[2])};
}

HEXDBB_MULTIVERSION
ForwardResult forward(const Mechanism& mechanism, const PlatformTriangle& triangle, RssrAngles& angles) noexcept {
  ForwardResult out;
  const auto& leg = mechanism.leg_length;
  rssr::Circle<double> circle[3];
  for (int i = 0; i < kGuideways; ++i) {
    circle[i] = rssr::meeting_circle(vec(mechanism.slider_joint, 2 * i), vec(mechanism.slider_joint, 2 * i + 1),
                                     leg[2 * i], leg[2 * i + 1]);
    if (!(circle[i].radius_squared > 0.0) || !(circle[i].span_squared > 0.0)) {
      out.status = Status::kUnreachable;
      return out;
    }
  }
  const double side_squared[3] = {triangle.side_squared[0], triangle.side_squared[1], triangle.side_squared[2]};
  const double limit_squared = singular_limit_squared(circle, triangle);
  double c[3] = {angles.cosine[0], angles.cosine[1], angles.cosine[2]};
  double s[3] = {angles.sine[0], angles.sine[1], angles.sine[2]};

  for (;;) {
    const rssr::Loops<double> loops = rssr::close_loops(circle, c, s, side_squared);
    out.residual_mm =
        triangle.mm_per_f * std::max({std::abs(loops.f[0]), std::abs(loops.f[1]), std::abs(loops.f[2])});
    // The step that led here was checked for singularity, so only a solution without a step takes one to be checked.
    const bool solved = out.residual_mm <= kResidualTolerance_mm;
    if (solved && out.iterations > 0) {
      out.pose = align(triangle, loops);
      angles.cosine << c[0], c[1], c[2];
      angles.sine << s[0], s[1], s[2];
      return out;
    }
    const rssr::LoopJacobian<double> jacobian = rssr::loop_jacobian(circle, c, s, loops);
    if (!(jacobian.determinant * jacobian.determinant > limit_squared)) {
      if (std::isnan(out.residual_mm)) out.residual_mm = std::numeric_limits<double>::infinity();
      out.status = Status::kSingular;
      return out;
    }
    if (out.iterations == kMaxIterations) {
      out.status = Status::kIterationLimit;
      return out;
    }
    double step[3];
    rssr::cramer_step(loops, jacobian, step);  // (2.18)-(2.21)
    for (int i = 0; i < kGuideways; ++i) rssr::turn(std::clamp(step[i], -kLargestTurn, kLargestTurn), c[i], s[i]);
    ++out.iterations;
  }
}

ForwardResult forward(const Mechanism& mechanism, RssrAngles& angles) noexcept {
  return forward(mechanism, PlatformTriangle(shared_joints(mechanism)), angles);
}

ForwardResult forward_six(const Mechanism& mechanism, const Pose& start) noexcept {
  ForwardResult out;
  out.pose = start;
  for (;;) {
    Eigen::Matrix<double, 6, 6> jacobian;
    Vector6 error;
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 arm = out.pose.rotation * mechanism.platform_joint.col(k);
      const Vector3 leg = out.pose.position + arm - mechanism.slider_joint.col(k);
      const double length = leg.norm();
      error[k] = length - mechanism.leg_length[k];
      jacobian.row(k) << leg.transpose() / length, arm.cross(leg).transpose() / length;
    }
    out.residual_mm = error.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!(out.residual_mm < 1e6)) {
      out.residual_mm = std::numeric_limits<double>::infinity();
      out.pose = start;
      out.status = Status::kUnreachable;
      return out;
    }
    if (out.residual_mm <= kResidualTolerance_mm) return out;
    if (out.iterations == kMaxIterations) {
      out.pose = start;
      out.status = Status::kIterationLimit;
      return out;
    }
    const Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>> lu(jacobian);
    if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff<Eigen::PropagateNaN>() > kSingularRatio)) {
      out.pose = start;
      out.status = Status::kSingular;
      return out;
    }
    const Vector6 step = -lu.solve(error);
    const Vector3 turn = step.tail<3>();
    const double angle = turn.norm();
    // Long steps are shortened to half a radian or 200 mm, so that a search from afar stays on its branch.
    const double fraction = std::min({1.0, 0.5 / std::max(angle, 1e-300), 200.0 / std::max(step.head<3>().norm(), 1e-300)});
    out.pose.position += fraction * step.head<3>();
    if (angle > 0.0) {
      out.pose.rotation = Eigen::AngleAxisd(fraction * angle, turn / angle).toRotationMatrix() * out.pose.rotation;
    }
    ++out.iterations;
  }
}

Pose home_pose(const NominalGeometry& nominal) {
  const Machine& machine = nominal.machine;
  const double lean = machine.base_inradius_mm - machine.platform_circumradius_mm;
  const double height_squared = 0.66 * machine.leg_length_mm * machine.leg_length_mm - lean * lean;
  Pose pose;
  pose.position.z() = std::sqrt(std::max(height_squared, 0.01 * machine.leg_length_mm * machine.leg_length_mm)) -
                      machine.joint_plane_height_mm;
  return pose;
}

}  // namespace hexdbb
