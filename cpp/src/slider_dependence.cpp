#include "slider_dependence.hpp"

#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

constexpr Eigen::Index kTrials = 24;

/// Something in every column, alike in all rows.
State generic_state(Eigen::Index rows) {
  State out;
  out.time_s.setZero(rows);
  out.temperature_c.setConstant(rows, 30.0);
  out.warming_k.setConstant(rows, 10.0);
  out.velocity_mm_s.setConstant(rows, int{kLegs}, 30.0);
  out.side.setConstant(rows, int{kLegs}, 0.7);
  out.since_reversal_mm.setConstant(rows, int{kLegs}, kLongAgo);
  out.leg_force.setConstant(rows, int{kLegs}, -0.3);
  return out;
}

/// Sum of magnitudes over the ports of leg k.
double on_leg(const Eigen::Matrix<double, 1, port::kCount>& push, int k) {
  return std::abs(push[port::kSlider + k]) + std::abs(push[port::kLeg + k]) +
         push.segment<3>(port::kSliderJoint + 3 * k).cwiseAbs().sum() +
         push.segment<3>(port::kPlatformJoint + 3 * k).cwiseAbs().sum();
}

}  // namespace

// Places that no period divides: multiples of the golden ratio, another phase a slider.
SliderTable trial_places(const Machine& machine) {
  SliderTable out(kTrials, int{kLegs});
  for (Eigen::Index row = 0; row < kTrials; ++row) {
    for (int k = 0; k < kLegs; ++k) {
      const double turns = 0.6180339887498949 * double(row + 1) + 0.7548776662466927 * (k + 1);
      const double part = turns - std::floor(turns);
      out(row, k) = machine.travel_min_mm + part * (machine.travel_max_mm - machine.travel_min_mm);
    }
  }
  return out;
}

Pushes ask(const Term& term, const SliderTable& sliders_mm) {
  Samples samples;
  samples.sliders_mm = sliders_mm;
  samples.state = generic_state(sliders_mm.rows());
  Pushes out = Pushes::Zero(sliders_mm.rows(), int{port::kCount});
  term.effect->push(SampleBlock{samples, 0, samples.size()}, term.values, out);
  return out;
}

double steepness(const Term& term, const Machine& machine) {
  constexpr double kStep_mm = 0.01;
  const SliderTable places = trial_places(machine);
  const Pushes change = ask(term, (places.array() + kStep_mm).matrix()) - ask(term, places);
  double out = 0.0;
  for (Eigen::Index row = 0; row < change.rows(); ++row) {
    for (int k = 0; k < kLegs; ++k) out = std::max(out, on_leg(change.row(row), k) / kStep_mm);
  }
  return out;
}

}  // namespace hexdbb
