#include "read_late.hpp"

#include <algorithm>
#include <cmath>

#include "block.hpp"

namespace hexdbb {

namespace {

/// Motion of a slider from one instant on, to the fourth order.
struct Onward {
  double velocity, acceleration, jerk, snap;

  double speed(double t) const { return velocity + t * (acceleration + t / 2.0 * (jerk + t / 3.0 * snap)); }
  double way(double t) const { return t * (velocity + t / 2.0 * (acceleration + t / 3.0 * (jerk + t / 4.0 * snap))); }

  /// Return when the slider turns, between now and `late_s`, at whose ends its speed has different signs.
  double turn_s(double late_s) const {
    constexpr int kHalvings = 30;  // 0.5 s to a nanosecond
    double before = 0.0, after = late_s;
    const double sign = speed(late_s);
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (before + after);
      (speed(middle) * sign > 0.0 ? after : before) = middle;
    }
    return 0.5 * (before + after);
  }
};

/// Let one slider's direction and what has passed since its reversal be those of `late_s` later.
void pass_on(const Onward& onward, double late_s, double& direction, double& since_s, double& since_mm) {
  if (direction * onward.speed(late_s) < 0.0) {
    const double turn_s = direction * onward.velocity > 0.0 ? onward.turn_s(late_s) : 0.0;
    direction = -direction;
    since_s = late_s - turn_s;
    since_mm = std::max(direction * (onward.way(late_s) - onward.way(turn_s)), 0.0);
  } else if (since_s < kLongAgo) {
    since_s += late_s;
    since_mm = std::max(since_mm + direction * onward.way(late_s), 0.0);
  }
}

void pass_on(double late_s, State& state) {
  const bool has_s = state.since_reversal_s.size() > 0, has_mm = state.since_reversal_mm.size() > 0;
  if (state.travel_direction.size() == 0) return;
  for (Eigen::Index row = 0; row < state.travel_direction.rows(); ++row) {
    for (int k = 0; k < kLegs; ++k) {
      const Onward onward{state.velocity_mm_s(row, k), state.acceleration_mm_s2(row, k), state.jerk_mm_s3(row, k),
                          state.snap_mm_s4(row, k)};
      double since_s = has_s ? state.since_reversal_s(row, k) : kLongAgo;
      double since_mm = has_mm ? state.since_reversal_mm(row, k) : kLongAgo;
      pass_on(onward, late_s, state.travel_direction(row, k), since_s, since_mm);
      if (has_s) state.since_reversal_s(row, k) = since_s;
      if (has_mm) state.since_reversal_mm(row, k) = since_mm;
    }
  }
}

}  // namespace

bool may_be_late(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(),
                     [](const Term& term) { return term.effect->late_s(term.values).has_value(); });
}

bool is_read_late(const Model& model, const Samples& samples) {
  return samples.moved_on_mm.rows() == 0 && late_s(model) != 0.0;
}

double late_s(const Model& model) {
  double out = 0.0;
  for (const Term& term : model.terms) out += term.effect->late_s(term.values).value_or(0.0);
  return out;
}

Samples when_read(const Model& model, const Samples& samples) {
  Samples out = samples;
  out.moved_on_mm.setZero(samples.size(), kLegs);
  Eigen::Matrix<double, Eigen::Dynamic, port::kCount> ports(Block::kRows, int{port::kCount});
  for (const Term& term : model.terms) {
    if (term.effect->late_s(term.values).value_or(0.0) == 0.0) continue;
    term.effect->require(samples);
    for (Eigen::Index first = 0; first < samples.size(); first += Block::kRows) {
      const SampleBlock block{samples, first, std::min<Eigen::Index>(Block::kRows, samples.size() - first)};
      ports.setZero();
      term.effect->push(block, term.values, ports.topRows(block.count));
      out.moved_on_mm.middleRows(first, block.count) += ports.topRows(block.count).middleCols<kLegs>(port::kSlider);
    }
  }
  const double late = late_s(model);
  if (late != 0.0) pass_on(late, out.state);
  out.sliders_mm += out.moved_on_mm;
  return out;
}

}  // namespace hexdbb
