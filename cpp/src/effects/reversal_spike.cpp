// Stiction: after a reversal the slider sticks while the drive winds up whatever is elastic between the two; at the
// breakaway travel w it breaks away, behind by the height, and the windup decays as exp(-(t - t_b) / tau). With sigma
// the direction of travel, d the travel and t the time since the reversal,
//   push = -sigma height d / w                 while d < w,
//   push = -sigma height exp(-(t - t_b)/tau)   from then on,
// where t_b = t sqrt(w / d): near a reversal a slider starts with constant acceleration, d = a t^2 / 2. Where that is
// less than the encoder's steps, d is taken from the acceleration.
// tau = 50 ms exp(log_time): positive whatever the value, and 50 ms at log_time = 0. w = height exp(log_travel): a slider
// that stands still falls behind by the travel of its drive, w = height at log_travel = 0. w is smaller where friction
// changes its sign at once, as in a stiff drive whose position loop recovers slowly.
//
// Assumption: the slider breaks away before it reverses again.
#include <cmath>

#include "block_column.hpp"
#include "catalogue.hpp"
#include "elements.hpp"

namespace hexdbb::effects {

namespace {

class ReversalSpike : public Effect {
 public:
  using Effect::Effect;

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      const double height = values[kValues * k];
      if (height == 0.0) continue;
      const Decay decay(block, values, k);
      const auto windup = std::abs(height) * decay.sticks.select(decay.part, decay.left);
      ports.col(port::kSlider + k).array() -= std::copysign(1.0, height) * decay.direction * windup;
    }
  }

  // Sliding, with e = exp(-(t - t_b)/tau):
  //   d/d height = -sigma e (1 + t_b / 2 tau),   d/d log_time = push (t - t_b)/tau,   d/d log_travel = push t_b / 2 tau;
  // sticking, only d/d log_travel = -push is not zero.
  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      const Decay decay(block, values, k);
      const double height = values[kValues * k];
      const BlockColumn signed_sensitivity = -decay.direction * sensitivity.col(port::kSlider + k).array();
      const BlockColumn slope = signed_sensitivity * decay.sticks.select(0.0, decay.left);
      jacobian.col(kValues * k).array() = slope * (1.0 + 0.5 * decay.stuck);
      jacobian.col(kValues * k + 1).array() = height * slope * decay.slid;
      jacobian.col(kValues * k + 2).array() =
          height * decay.sticks.select(-signed_sensitivity * decay.part, 0.5 * slope * decay.stuck);
    }
  }

 private:
  static constexpr int kValues = 3;  // of an element: height, log_time, log_travel
  static constexpr double kExpectedTime_s = 0.05;
  static constexpr double kSmallestTravel_mm = 1e-9;  // avoids a division by zero at the turning point itself

  /// The samples of a block relative to slider k's last reversal; times in time constants.
  struct Decay {
    Decay(const SampleBlock& block, Values values, int k)
        : direction(block.of(block.samples.state.travel_direction, k).array()),
          part(travelled_mm(block, k) / std::max(breakaway_mm(values, k), kSmallestTravel_mm)),
          sticks(part < 1.0) {
      const BlockColumn since = block.of(block.samples.state.since_reversal_s, k).array() /
                                (kExpectedTime_s * std::exp(values[kValues * k + 1]));
      stuck = since / part.sqrt();
      slid = since - stuck;
      left = (-slid).exp();
    }

    static double breakaway_mm(Values values, int k) {
      return std::abs(values[kValues * k]) * std::exp(values[kValues * k + 2]);
    }

    static BlockColumn travelled_mm(const SampleBlock& block, int k) {
      const auto since_s = block.of(block.samples.state.since_reversal_s, k).array();
      const auto acceleration = block.of(block.samples.state.acceleration_mm_s2, k).array();
      return block.of(block.samples.state.since_reversal_mm, k)
          .array()
          .max(0.5 * acceleration.abs() * since_s.square())
          .max(kSmallestTravel_mm);
    }

    BlockColumn direction, part;  // part: travel over the breakaway travel
    Eigen::Array<bool, Eigen::Dynamic, 1, 0, Block::kRows, 1> sticks;
    BlockColumn stuck, slid, left;  // times in time constants; left: part of the windup
  };
};

}  // namespace

EffectPtr reversal_spike(const Context&) {
  return std::make_shared<ReversalSpike>(EffectInfo{
      .name = "reversal_spike",
      .group = group::kCatalogue,
      .physics =
          "Stiction: after a reversal a slider falls behind by the height while its drive moves on by the breakaway "
          "travel, the height times e to the log_travel, then catches up exponentially, with a time constant of 50 ms "
          "times e to the log_time; unlike backlash the error has decayed after a few time constants.",
      .formula =
          "slider = -travel_direction x height x (since_reversal / travel_breakaway up to travel_breakaway, then "
          "exp(-(t - t_breakaway) / tau))",
      .source = "friction at velocity reversal (quadrant glitch), ISO 230-4 Annex",
      .element_kind = "slider",
      .elements = kSixElements,
      // Uncompensated quadrant glitches of machine tools are 5 to 20 um high and last some tens of ms.
      .parameters = {{.name = "height", .unit = "mm", .prior_sigma = 0.01, .limit = 0.5, .is_nonnegative = true},
                     {.name = "log_time", .unit = "1", .prior_sigma = 0.7, .limit = 3.0, .is_shape = true},
                     // A spike that stands at once has a breakaway travel of a ten-thousandth of its height, the
                     // logarithm of which is within five standard deviations and the limit.
                     {.name = "log_travel", .unit = "1", .prior_sigma = 2.0, .limit = 10.0, .is_shape = true}},
      .ports = {"slider"},
      .needs = {"travel_direction", "since_reversal_s", "since_reversal_mm", "acceleration_mm_s2"},
  });
}

}  // namespace hexdbb::effects
