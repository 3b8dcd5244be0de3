// Effects that push every port by a polynomial of its own slider's coordinate, folded into one polynomial a port.
//
// Model: push_p = sum over x of x (c0 + c1 u + c2 u^2), u the coordinate of slider k(p) from mid-travel per half
// travel, k(p) the slider or leg to which port p belongs, x one of: 1, the slider's velocity, its side, its leg's
// force, the warming. All of the thesis' geometric errors, and all of the catalogue's that a controller can correct but
// the screws' pitch errors, are of this kind. Whether an effect is, is found by asking it: some places and states give
// the coefficients, others are compared with them.
#pragma once

#include <array>

#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// What pushes may be proportional to, in one instant.
struct InstantState {
  Vector6 velocity_mm_s = Vector6::Zero();
  Vector6 side = Vector6::Zero();
  Vector6 leg_force = Vector6::Zero();
  double warming_k = 0.0;  // 0 where not measured
};

class SliderPolynomials {
 public:
  static constexpr int kPorts = port::kBall;  // slider, leg, slider_joint, platform_joint

  explicit SliderPolynomials(const Machine& machine);

  /// Add an effect; false, and nothing added, where it is no such polynomial.
  bool fold(const Term& term);

  /// Fix the state for the calls of evaluate() that follow.
  void settle(const InstantState& state) noexcept;

  /// Push at the first kPorts ports; the others become zero.
  void evaluate(const Vector6& sliders_mm, Ports& push) const noexcept;

 private:
  static constexpr int kFactors = 5;  // 1, velocity, side, leg force, warming
  using Coefficients = Eigen::Matrix<double, kPorts, 3>;

  Coefficients asked(const Term& term, int factor) const;

  Machine machine_;
  double middle_mm_, half_mm_;
  std::array<Coefficients, kFactors> of_factor_;
  std::array<std::array<bool, 3>, kFactors> is_used_{};  // of factor and power
  std::array<bool, 3> varies_{};                         // of power: any factor but 1
  Coefficients settled_;
};

}  // namespace hexdbb
