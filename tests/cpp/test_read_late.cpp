// Readings later than the encoders' values: the readings of one motion, beside what its encoders said a while before.
#include <gtest/gtest.h>

#include <string>

#include "circles.hpp"
#include "hexdbb/diagnosis.hpp"
#include "read_late.hpp"

namespace hexdbb {
namespace {

using testing::CircleSpec;

constexpr int kPerLap = 6000, kLate = 25, kEvery = 50;
constexpr double kLap_s = 12.0, kLate_s = kLate * kLap_s / kPerLap;  // 50 ms at 52 mm/s

double rms_of(const Eigen::VectorXd& each) { return each.norm() / std::sqrt(static_cast<double>(each.size())); }

/// Set the value of a parameter of the first element of an effect.
void set(Model& model, const std::string& effect, std::size_t place, double value) {
  for (Term& term : model.terms) {
    if (term.effect->info().name == effect) term.values[static_cast<Eigen::Index>(place)] = value;
  }
}

/// Return circles, each once in either direction.
Samples both_ways(const Machine& machine) {
  const Samples once = testing::circle_samples(machine, testing::seven_circles(), kPerLap);
  const Eigen::Index count = once.size();
  std::vector<Eigen::Index> order;
  for (Eigen::Index row = 0; row < count; ++row) order.push_back(row);
  for (Eigen::Index row = count - 1; row >= 0; --row) order.push_back(row);
  Samples out = once.rows(order);
  out.state.row.resize(0);
  out.state.time_s = (kLap_s / kPerLap) * Eigen::ArrayXd::LinSpaced(2 * count, 0.0, static_cast<double>(2 * count - 1));
  out.state.sweep = Eigen::VectorXi::NullaryExpr(2 * count, [](Eigen::Index row) { return int(row / kPerLap); });
  derive(NominalGeometry(machine), out, {"snap_mm_s4", "travel_direction", "since_reversal_mm"});
  return out;
}

class ReadLate : public ::testing::Test {
 protected:
  ReadLate() {
    for (const char* name : {"cup_position", "bar_length", "pitch_cyclic", "lead_error", "backlash", "sample_delay"}) {
      model.add(find_effect(machine, 1, name));
    }
    set(model, "cup_position", 0, 0.5);  // 0.5 mm once a lap: by it the readings tell the delay
    set(model, "pitch_cyclic", 0, 8e-3);
    set(model, "lead_error", 0, 2e-4);
    set(model, "backlash", 0, 20e-3);
    const Samples whole = both_ways(machine);
    const Eigen::VectorXd all_mm = predict(model, whole, false).reading_mm;
    std::vector<Eigen::Index> encoders, gauge;
    for (Eigen::Index row = kLate; row < whole.size(); row += kEvery) {
      if (row % kPerLap < kLate) continue;
      encoders.push_back(row - kLate);
      gauge.push_back(row);
    }
    samples = whole.rows(encoders);
    direction = whole.state.travel_direction(gauge, Eigen::all);
    since_mm = whole.state.since_reversal_mm(gauge, Eigen::all);
    reading_mm = all_mm(gauge);
  }

  Machine machine;
  Model model{machine};
  Samples samples;
  SliderTable direction, since_mm;
  Eigen::VectorXd reading_mm;
};

TEST_F(ReadLate, EveryEffectActsWhereTheSlidersAreWhenTheGaugeIsRead) {
  EXPECT_GT(rms_of(predict(model, samples, false).reading_mm - reading_mm), 5e-3);
  set(model, "sample_delay", 0, kLate_s);
  const Samples then = when_read(model, samples);
  EXPECT_EQ(then.state.travel_direction, direction);
  for (Eigen::Index row = 0; row < samples.size(); ++row) {
    for (int k = 0; k < kLegs; ++k) {
      if (since_mm(row, k) == kLongAgo) continue;
      EXPECT_NEAR(then.state.since_reversal_mm(row, k), since_mm(row, k), 5e-3);
    }
  }
  // Some readings within the play after a reversal, whose place is smoothed over 0.1 s, are off by more.
  EXPECT_LT(rms_of(predict(model, samples, false).reading_mm - reading_mm), 0.03e-3);
}

TEST_F(ReadLate, WhatIsNotLateStaysAsItIs) {
  EXPECT_TRUE(may_be_late(model));
  EXPECT_FALSE(is_read_late(model, samples));
  EXPECT_EQ(when_read(model, samples).sliders_mm, samples.sliders_mm);
  set(model, "sample_delay", 0, kLate_s);
  EXPECT_TRUE(is_read_late(model, samples));
  EXPECT_FALSE(is_read_late(model, when_read(model, samples)));  // once is enough
}

TEST_F(ReadLate, AFitFindsTheDelayAndWhatIsBesideIt) {
  const Eigen::VectorXd truth = model.values();
  model.set_values(Eigen::VectorXd::Zero(model.size()));
  for (const bool hypothesis : {false, true}) {
    FitOptions options;
    options.noise_mm = 0.1e-3;
    options.hypothesis = hypothesis;
    const FitResult found = fit(model, samples, reading_mm, options);
    ASSERT_TRUE(found.usable);
    Model fitted = model;
    fitted.set_values(found.values);
    EXPECT_NEAR(late_s(fitted), kLate_s, 0.2e-3);
    EXPECT_LT(found.rms_after_mm, 0.05e-3);
    // What was fitted is what is predicted.
    EXPECT_LT((predict(fitted, samples, false).reading_mm - (reading_mm - found.residual_mm)).cwiseAbs().maxCoeff(),
              0.02e-3);
  }
}

}  // namespace
}  // namespace hexdbb
