// Effects that push every port by a polynomial of its own slider's coordinate, folded into one polynomial a port.
//
// Model: push_p = sum over x of x (c0 + c1 u + c2 u^2), u the coordinate of slider k(p) from mid-travel per half
// travel, k(p) the slider or leg to which port p belongs, x one of: 1, the slider's velocity, its direction of travel,
// its leg's force, the warming. All geometric errors of the thesis, and all effects of the catalogue that a controller
// can correct except the pitch error of the screws, have this form. Whether an effect has it is determined by
// evaluating it: some positions and states determine the coefficients, others verify them.
#pragma once

#include <array>

#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// The factors to which pushes may be proportional, at one instant.
struct InstantState {
  Vector6 velocity_mm_s = Vector6::Zero();
  Vector6 travel_direction = Vector6::Zero();  // -1 to 1
  Vector6 leg_force = Vector6::Zero();
  double warming_k = 0.0;  // 0 where not measured
};

class SliderPolynomials {
 public:
  static constexpr int kPorts = port::kBall;  // slider, leg, slider_joint, platform_joint

  explicit SliderPolynomials(const Machine& machine);

  /// Add an effect. Return false, and add nothing, where it does not have this form.
  bool fold(const Term& term);

  /// Set the state for the following calls of evaluate().
  void settle(const InstantState& state) noexcept;

  /// Compute the push at the first kPorts ports; the others become zero.
  void evaluate(const Vector6& sliders_mm, Ports& push) const noexcept;

 private:
  static constexpr int kFactors = 5;  // 1, velocity, direction of travel, leg force, warming
  using Coefficients = Eigen::Matrix<double, kPorts, 3>;

  Coefficients coefficients_of(const Term& term, int factor) const;

  Machine machine_;
  Vector6 middle_mm_, half_mm_;
  std::array<Coefficients, kFactors> of_factor_;
  std::array<std::array<bool, 3>, kFactors> is_used_{};  // of factor and power
  std::array<bool, 3> varies_{};                         // of power: any factor but 1
  Coefficients settled_;
};

}  // namespace hexdbb
