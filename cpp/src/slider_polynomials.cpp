#include "hexdbb/slider_polynomials.hpp"

#include "multiversion.hpp"
#include "slider_dependence.hpp"

namespace hexdbb {

namespace {

using PortVector = Eigen::Matrix<double, SliderPolynomials::kPorts, 1>;

constexpr double kSame_mm = 1e-11;  // rounding of pushes of some mm

/// Assign each slider's number to every port that belongs to it.
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

/// Return a state with one factor at one and the others at zero.
State unit_state(int factor, Eigen::Index rows) {
  InstantState instant;
  if (factor == 1) instant.velocity_mm_s.setOnes();
  if (factor == 2) instant.travel_direction.setOnes();
  if (factor == 3) instant.leg_force.setOnes();
  if (factor == 4) instant.warming_k = 1.0;
  return state_of(std::vector<InstantState>(static_cast<std::size_t>(rows), instant));
}

}  // namespace

SliderPolynomials::SliderPolynomials(const Machine& machine) : machine_(machine) {
  for (int k = 0; k < kLegs; ++k) {
    const Travel travel = slider_travel(machine, k);
    middle_mm_[k] = travel.middle_mm;
    half_mm_[k] = travel.half_mm;
  }
  for (Coefficients& each : of_factor_) each.setZero();
  settled_.setZero();
}

SliderPolynomials::Coefficients SliderPolynomials::coefficients_of(const Term& term, int factor) const {
  SliderTable positions(3, int{kLegs});
  for (int row = 0; row < 3; ++row) positions.row(row) = (middle_mm_ + (row - 1) * half_mm_).transpose();
  const Pushes known = pushes_of(term, positions, unit_state(factor, 3));
  Coefficients out;
  out.col(0) = known.row(1).head<kPorts>();
  out.col(1) = 0.5 * (known.row(2) - known.row(0)).head<kPorts>();
  out.col(2) = 0.5 * (known.row(2) + known.row(0)).head<kPorts>() - known.row(1).head<kPorts>();
  return out;
}

bool SliderPolynomials::fold(const Term& term) {
  SliderPolynomials alone(machine_);
  for (int factor = 0; factor < kFactors; ++factor) {
    Coefficients& found = alone.of_factor_[factor];
    found = coefficients_of(term, factor);
    if (factor > 0) found -= alone.of_factor_[0];
    for (int power = 0; power < 3; ++power) alone.is_used_[factor][power] = !found.col(power).isZero(0.0);
  }
  alone.varies_ = {true, true, true};
  const SliderTable positions = trial_positions(machine_);
  const std::vector<InstantState> instants = trial_instants();
  const Pushes pushed = pushes_of(term, positions, state_of(instants));
  for (std::size_t row = 0; row < instants.size(); ++row) {
    Ports expected;
    alone.settle(instants[row]);
    alone.evaluate(positions.row(static_cast<Eigen::Index>(row)).transpose(), expected);
    const auto given = pushed.row(static_cast<Eigen::Index>(row)).transpose();
    if (!((given - expected.value).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kSame_mm)) return false;
  }
  for (int factor = 0; factor < kFactors; ++factor) {
    of_factor_[factor] += alone.of_factor_[factor];
    for (int power = 0; power < 3; ++power) {
      is_used_[factor][power] |= alone.is_used_[factor][power];
      varies_[power] |= factor > 0 && alone.is_used_[factor][power];
    }
  }
  settled_ = of_factor_[0];
  return true;
}

// Plain loops, which the compiler vectorizes for each processor the function is compiled for.
HEXDBB_MULTIVERSION
void SliderPolynomials::settle(const InstantState& state) noexcept {
  const Vector6 warming = Vector6::Constant(state.warming_k);
  const Vector6* const factors[] = {nullptr, &state.velocity_mm_s, &state.travel_direction, &state.leg_force, &warming};
  for (int power = 0; power < 3; ++power) {
    if (varies_[power]) settled_.col(power) = of_factor_[0].col(power);
  }
  for (int factor = 1; factor < kFactors; ++factor) {
    const auto& used = is_used_[factor];
    if (!used[0] && !used[1] && !used[2]) continue;
    const PortVector times = of_ports(*factors[factor]);
    const double* x = times.data();
    for (int power = 0; power < 3; ++power) {
      if (!used[power]) continue;
      const double* c = of_factor_[factor].col(power).data();
      double* out = settled_.col(power).data();
      for (int p = 0; p < kPorts; ++p) out[p] += x[p] * c[p];
    }
  }
}

HEXDBB_MULTIVERSION
void SliderPolynomials::evaluate(const Vector6& sliders_mm, Ports& push) const noexcept {
  const PortVector place = of_ports((sliders_mm - middle_mm_).cwiseQuotient(half_mm_));
  const double *u = place.data(), *c = settled_.data();
  double* out = push.value.data();
  for (int p = 0; p < kPorts; ++p) out[p] = c[p] + u[p] * (c[kPorts + p] + u[p] * c[2 * kPorts + p]);
  for (int p = kPorts; p < port::kCount; ++p) out[p] = 0.0;
}

}  // namespace hexdbb
