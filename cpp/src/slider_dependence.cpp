#include "slider_dependence.hpp"

#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

constexpr int kTrials = 24;         // more than the 15 coefficients a port may have
constexpr double kSame_mm = 1e-11;  // rounding of pushes of some mm

/// Return numbers in -1 to 1 without a period: multiples of the golden ratio, with a phase per column.
double spread(int row, int column) {
  const double turns = 0.6180339887498949 * (row + 1) + 0.7548776662466927 * (column + 1);
  return 2.0 * (turns - std::floor(turns)) - 1.0;
}

/// Sum the magnitudes over the ports of leg k.
double on_leg(const Eigen::Matrix<double, 1, port::kCount>& push, int k) {
  return std::abs(push[port::kSlider + k]) + std::abs(push[port::kLeg + k]) +
         push.segment<3>(port::kSliderJoint + 3 * k).cwiseAbs().sum() +
         push.segment<3>(port::kPlatformJoint + 3 * k).cwiseAbs().sum();
}

}  // namespace

SliderTable trial_positions(const Machine& machine) {
  SliderTable out(int{kTrials}, int{kLegs});
  for (int row = 0; row < kTrials; ++row) {
    for (int k = 0; k < kLegs; ++k) {
      const Travel travel = slider_travel(machine, k);
      out(row, k) = travel.middle_mm + travel.half_mm * spread(row, k);
    }
  }
  return out;
}

std::vector<InstantState> trial_instants() {
  std::vector<InstantState> out(kTrials);
  for (int row = 0; row < kTrials; ++row) {
    InstantState& instant = out[static_cast<std::size_t>(row)];
    for (int k = 0; k < kLegs; ++k) {
      instant.velocity_mm_s[k] = 30.0 * spread(row, 6 + k);
      instant.travel_direction[k] = spread(row, 12 + k);
      instant.leg_force[k] = spread(row, 18 + k);
    }
    instant.warming_k = row % 2 == 0 ? 0.0 : 10.0 * spread(row, 24);
  }
  return out;
}

State state_of(const std::vector<InstantState>& instants) {
  const auto rows = static_cast<Eigen::Index>(instants.size());
  State out;
  out.time_s.setZero(rows);
  out.temperature_c.setConstant(rows, std::numeric_limits<double>::quiet_NaN());
  out.warming_k.setZero(rows);
  out.since_reversal_mm.setConstant(rows, int{kLegs}, kLongAgo);
  out.velocity_mm_s.resize(rows, int{kLegs});
  out.travel_direction.resize(rows, int{kLegs});
  out.leg_force.resize(rows, int{kLegs});
  for (Eigen::Index row = 0; row < rows; ++row) {
    const InstantState& instant = instants[static_cast<std::size_t>(row)];
    out.velocity_mm_s.row(row) = instant.velocity_mm_s.transpose();
    out.travel_direction.row(row) = instant.travel_direction.transpose();
    out.leg_force.row(row) = instant.leg_force.transpose();
    out.warming_k[row] = instant.warming_k;
  }
  return out;
}

Pushes pushes_of(const Term& term, const SliderTable& sliders_mm, const State& state) {
  Samples samples;
  samples.sliders_mm = sliders_mm;
  samples.state = state;
  Pushes out = Pushes::Zero(sliders_mm.rows(), int{port::kCount});
  term.effect->push(SampleBlock{samples, 0, samples.size()}, term.values, out);
  return out;
}

bool agrees_with(const Term& term, const Machine& machine, const Folded& folded) {
  const SliderTable positions = trial_positions(machine);
  const std::vector<InstantState> instants = trial_instants();
  const Pushes pushed = pushes_of(term, positions, state_of(instants));
  for (std::size_t row = 0; row < instants.size(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    const Ports expected = folded(positions.row(at).transpose(), instants[row]).ports();
    const auto given = pushed.row(at).transpose();
    if (!((given - expected.value).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kSame_mm)) return false;
  }
  return true;
}

double steepness(const Term& term, const Machine& machine) {
  constexpr double kStep_mm = 0.01;
  const SliderTable positions = trial_positions(machine), beside = (positions.array() + kStep_mm).matrix();
  const State state = state_of(trial_instants());
  const Pushes change = pushes_of(term, beside, state) - pushes_of(term, positions, state);
  double out = 0.0;
  for (Eigen::Index row = 0; row < change.rows(); ++row) {
    for (int k = 0; k < kLegs; ++k) out = std::max(out, on_leg(change.row(row), k) / kStep_mm);
  }
  return out;
}

}  // namespace hexdbb
