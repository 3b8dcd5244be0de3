#include "hexdbb/slider_polynomials.hpp"

#include <algorithm>

#include "leg_kernel.hpp"
#include "multiversion.hpp"
#include "slider_dependence.hpp"

namespace hexdbb {

namespace {

bool is_zero(const double* row) {
  return std::all_of(row, row + kLegLanes, [](double each) { return each == 0.0; });
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
  Vector6 middle_mm, per_half;
  for (int k = 0; k < kLegs; ++k) {
    const Travel travel = slider_travel(machine, k);
    middle_mm[k] = travel.middle_mm;
    per_half[k] = 1.0 / travel.half_mm;
  }
  middle_mm_ = LegRow(middle_mm);
  per_half_ = LegRow(per_half);
}

SliderPolynomials::Coefficients SliderPolynomials::coefficients_of(const Term& term, int factor) const {
  SliderTable positions(3, int{kLegs});
  for (int row = 0; row < 3; ++row) {
    positions.row(row) = (middle_mm_.legs() + (row - 1) * per_half_.legs().cwiseInverse()).transpose();
  }
  const Pushes known = pushes_of(term, positions, unit_state(factor, 3));
  Coefficients out;
  for (int column = 0; column < kPorts; ++column) {
    const int place = LegPorts::place(column);
    const double before = known(0, column), middle = known(1, column), after = known(2, column);
    out[0].value[place] = middle;
    out[1].value[place] = 0.5 * (after - before);
    out[2].value[place] = 0.5 * (after + before) - middle;
  }
  for (LegPorts& each : out) each.repeat();
  return out;
}

bool SliderPolynomials::fold(const Term& term) {
  SliderPolynomials alone(machine_);
  for (int factor = 0; factor < kFactors; ++factor) {
    alone.of_factor_[factor] = coefficients_of(term, factor);
    if (factor == 0) continue;
    for (int power = 0; power < kPowers; ++power) {
      for (int at = 0; at < LegPorts::kQuantities * kLegLanes; ++at) {
        alone.of_factor_[factor][power].value[at] -= alone.of_factor_[0][power].value[at];
      }
    }
  }
  alone.find_varying();
  const bool is_sum = agrees_with(term, machine_, [&](const Vector6& sliders_mm, const InstantState& instant) {
    LegPorts out;
    alone.settle(instant);
    rssr::push_folded(alone, SliderWaves(machine_), rssr::load(LegRow(sliders_mm)), out);
    return out;
  });
  if (!is_sum) return false;
  for (int factor = 0; factor < kFactors; ++factor) {
    for (int power = 0; power < kPowers; ++power) {
      for (int at = 0; at < LegPorts::kQuantities * kLegLanes; ++at) {
        of_factor_[factor][power].value[at] += alone.of_factor_[factor][power].value[at];
      }
    }
  }
  find_varying();
  return true;
}

void SliderPolynomials::find_varying() {
  settled_ = of_factor_[0];
  varying_.clear();
  for (int factor = 1; factor < kFactors; ++factor) {
    for (int power = 0; power < kPowers; ++power) {
      for (int quantity = 0; quantity < LegPorts::kQuantities; ++quantity) {
        if (!is_zero(of_factor_[factor][power].row(quantity))) varying_.push_back({factor, power, quantity});
      }
    }
  }
}

inline void SliderPolynomials::settle_varying(const InstantState& state) noexcept {
  const LegRow factors[] = {LegRow(), LegRow(state.velocity_mm_s), LegRow(state.travel_direction),
                            LegRow(state.leg_force), LegRow(Vector6::Constant(state.warming_k))};
  for (const Varying& each : varying_) {
    store(load(of_factor_[0][each.power].row(each.quantity)), settled_[each.power].row(each.quantity));
  }
  for (const Varying& each : varying_) {
    double* const out = settled_[each.power].row(each.quantity);
    store(load(out) + load(factors[each.factor].of) * load(of_factor_[each.factor][each.power].row(each.quantity)),
          out);
  }
}

HEXDBB_MULTIVERSION_WIDE
void SliderPolynomials::settle(const InstantState& state, const LegPorts& beside,
                               const std::vector<int>& quantities) noexcept {
  for (const int quantity : quantities) store(load(of_factor_[0][0].row(quantity)), settled_[0].row(quantity));
  if (!varying_.empty()) settle_varying(state);
  for (const int quantity : quantities) {
    double* const out = settled_[0].row(quantity);
    store(load(out) + load(beside.row(quantity)), out);
  }
}

}  // namespace hexdbb
