#include "hexdbb/slider_waves.hpp"

#include <algorithm>
#include <cmath>

#include "leg_kernel.hpp"
#include "slider_dependence.hpp"

namespace hexdbb {

namespace {

// Positions over one turn of the screw: as many as determine a constant and two harmonics.
constexpr int kPositions = 2 * kWaveHarmonics + 1;

SliderTable positions_over_a_turn(const Machine& machine) {
  SliderTable out(int{kPositions}, int{kLegs});
  for (int row = 0; row < kPositions; ++row) {
    for (int k = 0; k < kLegs; ++k) {
      out(row, k) = slider_travel(machine, k).middle_mm + machine.screw_lead_mm * row / kPositions;
    }
  }
  return out;
}

}  // namespace

bool SliderWaves::fold(const Term& term) {
  const SliderTable positions = positions_over_a_turn(machine_);
  const Pushes known =
      pushes_of(term, positions, state_of(std::vector<InstantState>(std::size_t{kPositions}, InstantState())));
  SliderWaves alone(machine_);
  for (int quantity = 0; quantity < LegPorts::kQuantities; ++quantity) alone.waves_.push_back({quantity, {}, {}});
  for (int column = 0; column < port::kBall; ++column) {
    const int place = LegPorts::place(column), leg = place % kLegLanes;
    SliderWave& wave = alone.waves_[static_cast<std::size_t>(place / kLegLanes)];
    for (int harmonic = 1; harmonic <= kWaveHarmonics; ++harmonic) {
      double& cosine = wave.cosine[harmonic - 1].of[leg];
      double& sine = wave.sine[harmonic - 1].of[leg];
      for (int row = 0; row < kPositions; ++row) {  // positions are equally spaced over the turn
        const double angle = 2.0 * M_PI * harmonic * turns_per_mm() * positions(row, leg);
        cosine += 2.0 / kPositions * std::cos(angle) * known(row, column);
        sine += 2.0 / kPositions * std::sin(angle) * known(row, column);
      }
    }
  }
  std::erase_if(alone.waves_, [&](const SliderWave& wave) {
    for (int column = 0; column < port::kBall; ++column) {
      if (LegPorts::place(column) / kLegLanes == wave.quantity && !known.col(column).isZero(0.0)) return false;
    }
    return true;
  });
  for (SliderWave& wave : alone.waves_) {
    for (int harmonic = 0; harmonic < kWaveHarmonics; ++harmonic) {
      wave.cosine[harmonic] = LegRow(wave.cosine[harmonic].legs());
      wave.sine[harmonic] = LegRow(wave.sine[harmonic].legs());
    }
  }
  const SliderPolynomials nothing(machine_);
  const bool is_sum = agrees_with(term, machine_, [&](const Vector6& sliders_mm, const InstantState&) {
    LegPorts out;
    rssr::push_folded(nothing, alone, rssr::load(LegRow(sliders_mm)), out);
    return out;
  });
  if (is_sum) waves_.insert(waves_.end(), alone.waves_.begin(), alone.waves_.end());
  return is_sum;
}

}  // namespace hexdbb
