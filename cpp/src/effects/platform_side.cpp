// The joint triangle with sides longer than nominal.
//
// Three side lengths leave the triangle's position in its plane open; a ball bar with unknown ball offset cannot
// identify it. It is fixed as the nearest to the nominal one to first order: the centroid stays, and the joints'
// moments about it vanish. Exact in the side lengths, by Newton on the six in-plane coordinates.
#include <Eigen/LU>
#include <optional>
#include <utility>

#include "affine_effect.hpp"
#include "catalogue.hpp"
#include "geometric_sizes.hpp"

namespace hexdbb::effects {

namespace {

class PlatformSides : public AffineEffect {
 public:
  PlatformSides(EffectInfo info, const Machine& machine) : AffineEffect(std::move(info)) {
    for (int i = 0; i < 3; ++i) nominal_.segment<2>(2 * i) = platform_joint(machine, i).head<2>();
  }

  std::optional<AffinePush> affine(Values values) const override {
    const Vector6 at = joints(values), move = at - nominal_;
    const Eigen::Matrix<double, 6, 3> rate = constraints(at, values).gradient.inverse().leftCols<3>();
    AffinePush out;
    for (int value = 0; value < 3; ++value) {
      for (int k = 0; k < kLegs; ++k) {
        for (int axis = 0; axis < 2; ++axis) {
          const int port = port::kPlatformJoint + 3 * k + axis, row = 2 * guideway_of(k) + axis;
          out.constant.value[port] = move[row];
          out.rates.push_back({value, port, rate(row, value)});
        }
      }
    }
    return out;
  }

 private:
  struct Constraints {
    Vector6 error;
    Eigen::Matrix<double, 6, 6> gradient;
  };

  /// Three side lengths, two centroid coordinates, one moment.
  Constraints constraints(const Vector6& at, Values longer_mm) const {
    Constraints out;
    out.gradient.setZero();
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const Eigen::Vector2d side = at.segment<2>(2 * i) - at.segment<2>(2 * j);
      const Eigen::Vector2d nominal_side = nominal_.segment<2>(2 * i) - nominal_.segment<2>(2 * j);
      out.error[i] = side.norm() - nominal_side.norm() - longer_mm[i];
      out.gradient.block<1, 2>(i, 2 * i) = side.normalized().transpose();
      out.gradient.block<1, 2>(i, 2 * j) = -side.normalized().transpose();
      out.gradient(3, 2 * i) = out.gradient(4, 2 * i + 1) = 1.0;
      out.gradient(5, 2 * i) = -nominal_[2 * i + 1];
      out.gradient(5, 2 * i + 1) = nominal_[2 * i];
    }
    out.error.tail<3>() = out.gradient.bottomRows<3>() * (at - nominal_);
    return out;
  }

  Vector6 joints(Values longer_mm) const {
    Vector6 at = nominal_;
    for (int iteration = 0; iteration < 4; ++iteration) {  // quadratic from a fraction of a mm in 200 mm: 3 suffice
      const Constraints now = constraints(at, longer_mm);
      at -= now.gradient.inverse() * now.error;
    }
    return at;
  }

  Vector6 nominal_;
};

}  // namespace

EffectPtr platform_side(const Context& context) {
  EffectInfo info = {
      .name = "platform_side",
      .group = group::kGeometry,
      .physics = "Two ball joints of the platform are further apart than nominal.",
      .formula = "platform_joint: |Qi Qj| = nominal side + longer, centroid and mean rotation unchanged",
      .source = "thesis 3.2 (3), ball joints",
      .element_kind = "side",
      .elements = {"12", "23", "31"},
      .parameters = {length("longer")},
      .ports = {"platform_joint"},
  };
  return std::make_shared<PlatformSides>(std::move(info), context.machine);
}

}  // namespace hexdbb::effects
