// A guideway rotated about an axis through a fixed point: both slider joints move by (Rot(axis, angle) - I)(B -
// centre).
//
// Rodrigues: (Rot - I) r = sin(angle) u + (1 - cos(angle)) w, u = axis x r, w = axis x u; r = V - centre + s d is
// affine in the slider coordinate, hence u and w are too.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "columns.hpp"
#include "elements.hpp"
#include "geometric_sizes.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

struct Hinge {
  Vector3 axis;    // unit vector, base frame
  Vector3 centre;  // base frame
};

class GuidewayRotation : public Effect {
 public:
  GuidewayRotation(EffectInfo info, const Machine& machine, const std::vector<Hinge>& hinges)
      : Effect(std::move(info)) {
    for (int i = 0; i < kGuideways; ++i) {
      Lever lever;
      lever.u0 = hinges[i].axis.cross(guideway_vertex(machine, i) - hinges[i].centre);
      lever.u1 = hinges[i].axis.cross(guideway_direction(machine, i));
      lever.w0 = hinges[i].axis.cross(lever.u0);
      lever.w1 = hinges[i].axis.cross(lever.u1);
      levers_.push_back(lever);
    }
  }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      const Lever& lever = levers_[guideway_of(k)];
      const double angle = values[guideway_of(k)];
      if (angle == 0.0) continue;
      const Affine move = lever.at(std::sin(angle), 1.0 - std::cos(angle));
      for (int axis = 0; axis < 3; ++axis) {
        add_affine(block.count, move.constant[axis], move.slope[axis], block.slider_mm(k).data(),
                   ports.col(port::kSliderJoint + 3 * k + axis).data());
      }
    }
  }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (int k = 0; k < kLegs; ++k) {
      const Lever& lever = levers_[guideway_of(k)];
      const double angle = values[guideway_of(k)];
      const Affine rate = lever.at(std::cos(angle), std::sin(angle));
      const double constant[3] = {rate.constant[0], rate.constant[1], rate.constant[2]};
      const double slope[3] = {rate.slope[0], rate.slope[1], rate.slope[2]};
      add_affine_times(block.count, constant, slope, block.slider_mm(k).data(),
                       sensitivity.col(port::kSliderJoint + 3 * k).data(), sensitivity.outerStride(),
                       jacobian.col(guideway_of(k)).data());
    }
  }

 private:
  struct Affine {
    Vector3 constant, slope;
  };
  struct Lever {
    Vector3 u0, u1, w0, w1;
    Affine at(double u_factor, double w_factor) const {
      return {u_factor * u0 + w_factor * w0, u_factor * u1 + w_factor * w1};
    }
  };

  std::vector<Lever> levers_;
};

/// What the three rotations of the thesis have in common; name, physics, formula and source are the effect's own.
inline EffectInfo rotation_info(EffectInfo own) {
  own.group = group::kGeometry;
  own.element_kind = "guideway";
  own.elements = kThreeElements;
  own.parameters = {angle("angle")};
  own.ports = {"slider_joint"};
  return own;
}

/// Return the rotation of every guideway about one of its local axes (0: x, 2: z) through its midpoint.
inline EffectPtr rotation_about_midpoint(EffectInfo own, const Machine& machine, int local_axis) {
  std::vector<Hinge> hinges;
  for (int i = 0; i < kGuideways; ++i) {
    hinges.push_back({guideway_axes(machine, i).col(local_axis), guideway_midpoint(machine, i)});
  }
  return std::make_shared<GuidewayRotation>(rotation_info(std::move(own)), machine, hinges);
}

}  // namespace hexdbb::effects
