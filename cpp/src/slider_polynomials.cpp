#include "hexdbb/slider_polynomials.hpp"

#include "multiversion.hpp"
#include "slider_dependence.hpp"

namespace hexdbb {

namespace {

using PortVector = Eigen::Matrix<double, SliderPolynomials::kPorts, 1>;

constexpr double kSame_mm = 1e-11;

/// The slider to which a port belongs, for the whole row of ports.
PortVector of_ports(const Vector6& of_sliders) {
  PortVector out;
  for (int k = 0; k < kLegs; ++k) {
    out[port::kSlider + k] = out[port::kLeg + k] = of_sliders[k];
    for (int axis = 0; axis < 3; ++axis) {
      out[port::kSliderJoint + 3 * k + axis] = out[port::kPlatformJoint + 3 * k + axis] = of_sliders[k];
    }
  }
  return out;
}

}  // namespace

SliderPolynomials::SliderPolynomials(const Machine& machine)
    : machine_(machine),
      middle_mm_(0.5 * (machine.travel_min_mm + machine.travel_max_mm)),
      half_mm_(0.5 * (machine.travel_max_mm - machine.travel_min_mm)) {
  coefficient_.setZero();
}

bool SliderPolynomials::fold(const Term& term) {
  SliderTable three(3, int{kLegs});
  for (int row = 0; row < 3; ++row) three.row(row).setConstant(middle_mm_ + (row - 1) * half_mm_);
  const Pushes known = ask(term, three);
  Eigen::Matrix<double, kPorts, 3> found;
  found.col(0) = known.row(1).head<kPorts>();
  found.col(1) = 0.5 * (known.row(2) - known.row(0)).head<kPorts>();
  found.col(2) = 0.5 * (known.row(2) + known.row(0)).head<kPorts>() - known.row(1).head<kPorts>();

  const SliderTable trials = trial_places(machine_);
  const Pushes asked = ask(term, trials);
  SliderPolynomials alone = *this;
  alone.coefficient_ = found;
  for (Eigen::Index row = 0; row < trials.rows(); ++row) {
    Ports expected;
    alone.evaluate(trials.row(row).transpose(), expected);
    if (!((asked.row(row).transpose() - expected.value).cwiseAbs().maxCoeff() <= kSame_mm)) return false;
  }
  coefficient_ += found;
  return true;
}

HEXDBB_MULTIVERSION
void SliderPolynomials::evaluate(const Vector6& sliders_mm, Ports& push) const noexcept {
  const PortVector u = of_ports((sliders_mm.array() - middle_mm_) / half_mm_);
  push.value.head<kPorts>() =
      coefficient_.col(0).array() + u.array() * (coefficient_.col(1).array() + u.array() * coefficient_.col(2).array());
  push.value.tail<port::kCount - kPorts>().setZero();
}

}  // namespace hexdbb
