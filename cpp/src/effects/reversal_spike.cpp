// Stiction: after a reversal the slider sticks while the drive winds up whatever is elastic between the two; at the
// windup `height` it breaks away, and the windup decays as exp(-(t - t_b) / tau). With sigma the direction of travel, d
// the travel and t the time since the reversal,
//   push = -sigma d                            while d < height,
//   push = -sigma height exp(-(t - t_b)/tau)   from then on,
// where t_b = t sqrt(height / d): near a reversal a slider starts with constant acceleration, d = a t^2 / 2.
// tau = 50 ms exp(log_time): positive whatever the value, and 50 ms at log_time = 0.
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
      const double height = values[2 * k];
      if (height == 0.0) continue;
      const Decay decay(block, values, k);
      const auto windup = decay.sticks.select(decay.travelled_mm, std::abs(height) * decay.left);
      ports.col(port::kSlider + k).array() -= std::copysign(1.0, height) * decay.direction * windup;
    }
  }

  // Sliding, with e = exp(-(t - t_b)/tau):
  //   d/d height = -sigma e (1 + t_b / 2 tau),   d/d log_time = push (t - t_b)/tau.
  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      const Decay decay(block, values, k);
      const BlockColumn slope =
          -decay.direction * decay.sticks.select(0.0, decay.left) * sensitivity.col(port::kSlider + k).array();
      jacobian.col(2 * k).array() = slope * (1.0 + 0.5 * decay.stuck);
      jacobian.col(2 * k + 1).array() = values[2 * k] * slope * decay.slid;
    }
  }

 private:
  static constexpr double kExpectedTime_s = 0.05;
  static constexpr double kSmallestTravel_mm = 1e-9;  // avoids a division by zero at the turning point itself

  /// The samples of a block relative to slider k's last reversal; times in time constants.
  struct Decay {
    Decay(const SampleBlock& block, Values values, int k)
        : direction(block.of(block.samples.state.travel_direction, k).array()),
          travelled_mm(block.of(block.samples.state.since_reversal_mm, k).array()),
          sticks(travelled_mm < std::abs(values[2 * k])) {
      const BlockColumn since =
          block.of(block.samples.state.since_reversal_s, k).array() / (kExpectedTime_s * std::exp(values[2 * k + 1]));
      stuck = since * (std::abs(values[2 * k]) / travelled_mm.max(kSmallestTravel_mm)).sqrt();
      slid = since - stuck;
      left = (-slid).exp();
    }

    BlockColumn direction, travelled_mm;
    Eigen::Array<bool, Eigen::Dynamic, 1, 0, Block::kRows, 1> sticks;
    BlockColumn stuck, slid, left;
  };
};

}  // namespace

EffectPtr reversal_spike(const Context&) {
  return std::make_shared<ReversalSpike>(EffectInfo{
      .name = "reversal_spike",
      .group = group::kCatalogue,
      .physics =
          "Stiction: after a reversal a slider sticks until its drive has moved on by the height, then catches up "
          "exponentially, with a time constant of 50 ms times e to the log_time; unlike backlash the error has "
          "decayed after a few time constants.",
      .formula =
          "slider = -travel_direction x (since_reversal up to the height, then height exp(-(t - t_breakaway) / tau))",
      .source = "friction at velocity reversal (quadrant glitch), ISO 230-4 Annex",
      .element_kind = "slider",
      .elements = kSixElements,
      // Uncompensated quadrant glitches of machine tools are 5 to 20 um high and last some tens of ms.
      .parameters = {{.name = "height", .unit = "mm", .prior_sigma = 0.01, .limit = 0.5, .is_nonnegative = true},
                     {.name = "log_time", .unit = "1", .prior_sigma = 0.7, .limit = 3.0, .is_shape = true}},
      .ports = {"slider"},
      .needs = {"travel_direction", "since_reversal_s", "since_reversal_mm"},
  });
}

}  // namespace hexdbb::effects
