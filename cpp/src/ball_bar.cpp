#include "hexdbb/ball_bar.hpp"

#include <Eigen/Geometry>

#include "kernel_types.hpp"
#include "six_kernel.hpp"

namespace hexdbb {

namespace {

using Vec = rssr::Vec<double>;
using rssr::vec;

constexpr double kSingularRatio = 1e-9;  // as in kinematics.cpp

struct Bar {
  Vector3 ball;       // platform frame
  Vector3 arm;        // R ball, base frame
  Vector3 direction;  // unit vector from cup to ball, base frame
  double length_mm;
};

Bar bar(const Pose& pose, const SetUp& set_up, const Ports& push) {
  Bar out;
  out.ball = set_up.ball_offset_mm + push.ball();
  out.arm = pose.rotation * out.ball;
  const Vector3 along = pose.position + out.arm - set_up.cup_mm - push.cup();
  out.length_mm = along.norm();
  out.direction = along / (out.length_mm > 0.0 ? out.length_mm : 1.0);
  return out;
}

/// Fill the sensitivities; `share[k] * leg_k` is the force in leg k, leg_k the vector from slider joint to ball joint.
void fill(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose, const Bar& along,
          const Vec (&leg)[kLegs], const double (&share)[kLegs], Ports& out) {
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 force = share[k] * rssr::vector(leg[k]);
    out.slider()[k] = force.dot(nominal.direction.col(k));
    out.leg()[k] = share[k] * mechanism.leg_length[k];
    out.slider_joint(k) = force;
    out.platform_joint(k).noalias() = -pose.rotation.transpose() * force;
  }
  out.ball().noalias() = pose.rotation.transpose() * along.direction;
  out.cup() = -along.direction;
  out.reading() = 1.0;
}

}  // namespace

double reading_mm(const Pose& pose, const SetUp& set_up, const Ports& push) noexcept {
  const Vector3 ball = set_up.ball_offset_mm + push.ball();
  return (pose.position + pose.rotation * ball - set_up.cup_mm - push.cup()).norm() - set_up.bar_length_mm +
         push.reading();
}

bool reading_sensitivity(const NominalGeometry& nominal, const Mechanism& mechanism, const PlatformTriangle& triangle,
                         const Pose& pose, const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept {
  sensitivity.value.setZero();
  const Bar along = bar(pose, set_up, push);
  if (!(along.length_mm > 0.0)) return false;
  const rssr::LegForces<double> forces =
      rssr::leg_forces(rssr::joints_of(mechanism.slider_joint, triangle), rssr::frame_of(triangle), rssr::placed(pose),
                       vec(along.ball), vec(along.direction));
  if (!(forces.determinant * forces.determinant > kSingularRatio * kSingularRatio * forces.scale)) return false;
  fill(nominal, mechanism, pose, along, forces.leg, forces.share, sensitivity);
  return true;
}

bool reading_sensitivity_six(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose,
                             const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept {
  sensitivity.value.setZero();
  const Bar along = bar(pose, set_up, push);
  if (!(along.length_mm > 0.0)) return false;
  Vec base[kLegs], joint[kLegs];
  double length[kLegs], share[kLegs];
  for (int k = 0; k < kLegs; ++k) {
    base[k] = vec(mechanism.slider_joint.col(k));
    joint[k] = vec(mechanism.platform_joint.col(k));
    length[k] = mechanism.leg_length[k];
  }
  const rssr::SixLegs<double> legs = rssr::six_legs(base, length, joint, rssr::placed(pose));
  const rssr::Wrenches<double> wrenches = rssr::factor(legs.column);
  if (!(wrenches.least_squared > kSingularRatio * kSingularRatio)) return false;
  wrenches.forces(rssr::wrench(vec(along.direction), vec(along.arm)), share);
  for (int k = 0; k < kLegs; ++k) share[k] *= legs.inverse[k];
  fill(nominal, mechanism, pose, along, legs.leg, share, sensitivity);
  return true;
}

}  // namespace hexdbb
