// What a slider does when it turns back: play in its drive, and stiction.
//
// Assumption: a slider crosses its play before it turns back again, and the play was taken up before the sweep began.
#include <cmath>
#include <utility>

#include "block_column.hpp"
#include "catalogue.hpp"

namespace hexdbb {

namespace {

/// Lost motion: the slider stands play/2 behind its drive. Turning back, the drive crosses the play while the slider
/// rests (play operator of hysteresis models, e.g. Krasnosel'skii & Pokrovskii 1989):
///   push = side (play/2 - min(d, play)), d travel since the reversal;  d push / d play = -+ side/2.
/// A negative play is the same with sides exchanged.
class Backlash : public Effect {
 public:
  explicit Backlash(EffectInfo info) : info_(std::move(info)) {}

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      const double play = values[k];
      if (play == 0.0) continue;
      const auto side = block.of(block.samples.state.side, k).array();
      const auto travelled = block.of(block.samples.state.since_reversal_mm, k).array();
      const double sign = play < 0.0 ? -1.0 : 1.0;
      ports.col(port::kSlider + k).array() += side * (0.5 * play - sign * travelled.min(std::abs(play)));
    }
  }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      const auto side = block.of(block.samples.state.side, k).array();
      const auto travelled = block.of(block.samples.state.since_reversal_mm, k).array();
      const auto crossing = travelled < std::abs(values[k]);
      jacobian.col(k).array() = sensitivity.col(port::kSlider + k).array() * crossing.select(0.5 * side, -0.5 * side);
    }
  }

 private:
  EffectInfo info_;
};

/// Stiction: from a reversal on the slider sticks while the drive winds up whatever is elastic between the two; at the
/// windup `height` it breaks away, and the windup decays as exp(-(t - t_b) / tau). With d the travel and t the time
/// since the reversal,
///   push = -side d                            while d < height,
///   push = -side height exp(-(t - t_b)/tau)   from then on,
/// where t_b = t sqrt(height / d): near a reversal a slider starts with constant acceleration, d = a t^2 / 2.
/// tau = 50 ms exp(log_time), which is positive whatever the value and the expected one at zero.
class ReversalSpike : public Effect {
 public:
  explicit ReversalSpike(EffectInfo info) : info_(std::move(info)) {}

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      const double height = values[2 * k];
      if (height == 0.0) continue;
      const Decay decay(block, values, k);
      const auto windup = decay.sticks.select(decay.travelled_mm, std::abs(height) * decay.left);
      ports.col(port::kSlider + k).array() -= std::copysign(1.0, height) * decay.side * windup;
    }
  }

  // Sliding, with e = exp(-(t - t_b)/tau): d/d height = -side e (1 + t_b / 2 tau); d/d log_time = push (t - t_b)/tau.
  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      const Decay decay(block, values, k);
      const BlockColumn slope =
          -decay.side * decay.sticks.select(0.0, decay.left) * sensitivity.col(port::kSlider + k).array();
      jacobian.col(2 * k).array() = slope * (1.0 + 0.5 * decay.stuck);
      jacobian.col(2 * k + 1).array() = values[2 * k] * slope * decay.slid;
    }
  }

 private:
  static constexpr double kExpectedTime_s = 0.05;
  static constexpr double kNoWay_mm = 1e-9;  // at the turning point itself

  /// How the samples of a block stand to slider k's last reversal; times in time constants.
  struct Decay {
    Decay(const SampleBlock& block, Values values, int k)
        : side(block.of(block.samples.state.side, k).array()),
          travelled_mm(block.of(block.samples.state.since_reversal_mm, k).array()),
          sticks(travelled_mm < std::abs(values[2 * k])) {
      const BlockColumn since =
          block.of(block.samples.state.since_reversal_s, k).array() / (kExpectedTime_s * std::exp(values[2 * k + 1]));
      stuck = since * (std::abs(values[2 * k]) / travelled_mm.max(kNoWay_mm)).sqrt();
      slid = since - stuck;
      left = (-slid).exp();
    }

    BlockColumn side, travelled_mm;
    Eigen::Array<bool, Eigen::Dynamic, 1, 0, Block::kRows, 1> sticks;
    BlockColumn stuck, slid, left;
  };

  EffectInfo info_;
};

}  // namespace

EffectPtr backlash() {
  // A worn nut or coupling has some hundredths of a millimetre; a tenth is a fault one hears.
  return std::make_shared<Backlash>(EffectInfo{
      "backlash",
      "Lost motion: a slider stands half its play behind the drive on the side it comes from, and crosses the "
      "play over the first travel after a reversal; unlike reversal_spike it stays until the next reversal, "
      "unlike servo_lag it does not grow with speed.",
      "play operator; ISO 230-4 reversal error",
      "slider",
      kSixElements,
      {{"play", "mm", 0.02, 1.0}},
      {"slider"},
      false,
      group::kCatalogue,
      {"side", "since_reversal_mm"}});
}

EffectPtr reversal_spike() {
  // Spikes of 5 to 20 um, of some tens of ms, are what uncompensated quadrant glitches look like on machine tools.
  return std::make_shared<ReversalSpike>(EffectInfo{
      "reversal_spike",
      "Stiction: after a reversal a slider sticks until its drive has moved on by the height, then catches up "
      "exponentially, with a time constant of 50 ms times e to the log_time; unlike backlash it is gone after a few "
      "time constants.",
      "friction at velocity reversal (quadrant glitch), ISO 230-4 Annex",
      "slider",
      kSixElements,
      {{"height", "mm", 0.01, 0.5}, {"log_time", "1", 0.7, 3.0, true}},
      {"slider"},
      false,
      group::kCatalogue,
      {"side", "since_reversal_s", "since_reversal_mm"}});
}

}  // namespace hexdbb
