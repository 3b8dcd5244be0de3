// A guideway rotated about an axis through a fixed point: both slider joints move by (Rot(axis, angle) - I)(B -
// centre).
//
// Rodrigues: (Rot - I) r = sin(angle) u + (1 - cos(angle)) w, u = axis x r, w = axis x u; r = V - centre + s d is
// affine in the slider coordinate, hence u and w are too.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <utility>

#include "affine_effect.hpp"
#include "elements.hpp"
#include "geometric_sizes.hpp"

namespace hexdbb::effects {

struct Hinge {
  Vector3 axis;    // unit vector, base frame
  Vector3 centre;  // base frame
};

class GuidewayRotation : public AffineEffect {
 public:
  GuidewayRotation(EffectInfo info, const Machine& machine, const std::vector<Hinge>& hinges)
      : AffineEffect(std::move(info)) {
    for (int i = 0; i < kGuideways; ++i) {
      Lever lever;
      lever.u0 = hinges[i].axis.cross(guideway_vertex(machine, i) - hinges[i].centre);
      lever.u1 = hinges[i].axis.cross(guideway_direction(machine, i));
      lever.w0 = hinges[i].axis.cross(lever.u0);
      lever.w1 = hinges[i].axis.cross(lever.u1);
      levers_.push_back(lever);
    }
  }

  std::optional<AffinePush> affine(Values values) const override {
    AffinePush out;
    for (int i = 0; i < kGuideways; ++i) {
      const double angle = values[i], cosine = std::cos(angle), sine = std::sin(angle);
      const Move move = levers_[i].at(sine, 1.0 - cosine), rate = levers_[i].at(cosine, sine);
      for (const int k : {2 * i, 2 * i + 1}) {
        for (int axis = 0; axis < 3; ++axis) {
          const int port = port::kSliderJoint + 3 * k + axis;
          out.constant.value[port] = move.constant[axis];
          out.slope.value[port] = move.slope[axis];
          out.rates.push_back({i, port, rate.constant[axis], rate.slope[axis]});
        }
      }
    }
    return out;
  }

 private:
  struct Move {
    Vector3 constant, slope;
  };
  struct Lever {
    Vector3 u0, u1, w0, w1;
    Move at(double u_factor, double w_factor) const {
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
