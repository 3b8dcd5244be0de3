#include "hexdbb/mechanism.hpp"

#include <cmath>

#include "hexdbb/leg_ports.hpp"
#include "kernel_types.hpp"

namespace hexdbb {

NominalGeometry::NominalGeometry(const Machine& machine_in) : machine(machine_in) {
  for (int k = 0; k < kLegs; ++k) {
    vertex.col(k) = guideway_vertex(machine, guideway_of(k));
    direction.col(k) = guideway_direction(machine, guideway_of(k));
    platform_joint.col(k) = hexdbb::platform_joint(machine, guideway_of(k));
  }
}

NominalLegs::NominalLegs(const NominalGeometry& nominal) {
  Vector6 outward;
  for (int k = 0; k < kLegs; ++k) outward[k] = k % 2 == 0 ? -1.0 : 1.0;
  side = LegRow(outward);
  length = LegRow(Eigen::Map<const Vector6>(nominal.machine.leg_length_mm.data()));
  for (int axis = 0; axis < 3; ++axis) {
    platform_joint[axis] = LegRow(nominal.platform_joint.row(axis).transpose());
    vertex[axis] = LegRow(nominal.vertex.row(axis).transpose());
    direction[axis] = LegRow(nominal.direction.row(axis).transpose());
  }
}

PlatformTriangle::PlatformTriangle(const Matrix3& joints_in) : joints(joints_in) {
  const rssr::Vec<double> q[] = {rssr::vec(joints.col(0)), rssr::vec(joints.col(1)), rssr::vec(joints.col(2))};
  const rssr::TriangleFrame<double> frame = rssr::triangle_frame(q);
  for (int i = 0; i < 3; ++i) {
    frame_inverse.row(i) = rssr::vector(frame.row[i]).transpose();
    side_squared[i] = frame.side_squared[i];
  }
  mm_per_f = 0.5 / std::sqrt(side_squared.minCoeff());
}

Mechanism assemble(const NominalGeometry& nominal, const Vector6& sliders_mm, const Ports& push) noexcept {
  Mechanism out;
  for (int k = 0; k < kLegs; ++k) {
    const double along = sliders_mm[k] + push.slider()[k];
    out.slider_joint.col(k) = nominal.vertex.col(k) + along * nominal.direction.col(k) + push.slider_joint(k);
    out.leg_length[k] = nominal.machine.leg_length_mm[k] + push.leg()[k];
    out.platform_joint.col(k) = nominal.platform_joint.col(k) + push.platform_joint(k);
  }
  return out;
}

bool joints_are_shared(const Mechanism& mechanism) noexcept {
  for (int i = 0; i < kGuideways; ++i) {
    if (mechanism.platform_joint.col(2 * i) != mechanism.platform_joint.col(2 * i + 1)) return false;
  }
  return true;
}

Matrix3 shared_joints(const Mechanism& mechanism) noexcept {
  Matrix3 joints;
  joints << mechanism.platform_joint.col(0), mechanism.platform_joint.col(2), mechanism.platform_joint.col(4);
  return joints;
}

}  // namespace hexdbb
