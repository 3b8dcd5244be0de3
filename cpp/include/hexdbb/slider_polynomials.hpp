// Effects that push every port by a polynomial of its own slider's coordinate, folded into one polynomial a port.
//
// Model: push_p = c0 + c1 u + c2 u^2, u the coordinate of slider k(p) from mid-travel per half travel, k(p) the slider
// or leg to which port p belongs. All of the thesis' geometric errors, lead errors and bows are of this kind. Whether
// an effect is, is found by asking it: three places give the coefficients, others are compared with them.
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

class SliderPolynomials {
 public:
  static constexpr int kPorts = port::kBall;  // slider, leg, slider_joint, platform_joint

  explicit SliderPolynomials(const Machine& machine);

  /// Add an effect that depends on slider places alone; false, and nothing added, where it is no such polynomial.
  bool fold(const Term& term);

  /// Push at the first kPorts ports; the others become zero.
  void evaluate(const Vector6& sliders_mm, Ports& push) const noexcept;

 private:
  Machine machine_;
  double middle_mm_, half_mm_;
  Eigen::Matrix<double, kPorts, 3> coefficient_;
};

}  // namespace hexdbb
