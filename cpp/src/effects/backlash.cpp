// Lost motion: the slider stands play/2 behind its drive. After a reversal the drive crosses the play while the slider
// rests (play operator of hysteresis models, e.g. Krasnosel'skii & Pokrovskii 1989):
//   push = sigma (play/2 - min(d, play)),   d push / d play = -+ sigma/2,
// sigma the direction of travel, d the travel since the reversal. A negative play, which has no physical meaning but
// may occur on the way of a fit, is the same with sigma reversed.
//
// Assumption: a slider crosses its play before it reverses again, and the play was taken up before the sweep began.
#include <cmath>

#include "block_column.hpp"
#include "catalogue.hpp"
#include "elements.hpp"
#include "multiversion.hpp"

namespace hexdbb::effects {

namespace {

/// Compute the derivative by the play of a block's readings.
HEXDBB_MULTIVERSION
void derivative(Eigen::Index rows, double size, const double* direction, const double* travelled, const double* slider,
                double* out) noexcept {
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double half = 0.5 * direction[row] * slider[row];
    out[row] = travelled[row] < size ? half : -half;
  }
}

/// Add the push of a play to a block's column of a slider.
HEXDBB_MULTIVERSION
void add_push(Eigen::Index rows, double play, const double* direction, const double* travelled, double* out) noexcept {
  const double half = 0.5 * play, size = std::abs(play), sign = play < 0.0 ? -1.0 : 1.0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double crossed = travelled[row] < size ? travelled[row] : size;
    out[row] += direction[row] * (half - sign * crossed);
  }
}

class Backlash : public Effect {
 public:
  using Effect::Effect;

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      if (values[k] == 0.0) continue;
      add_push(block.count, values[k], block.of(block.samples.state.travel_direction, k).data(),
               block.of(block.samples.state.since_reversal_mm, k).data(), ports.col(port::kSlider + k).data());
    }
  }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      derivative(block.count, std::abs(values[k]), block.of(block.samples.state.travel_direction, k).data(),
                 block.of(block.samples.state.since_reversal_mm, k).data(), sensitivity.col(port::kSlider + k).data(),
                 jacobian.col(k).data());
    }
  }
};

}  // namespace

EffectPtr backlash(const Context&) {
  return std::make_shared<Backlash>(EffectInfo{
      .name = "backlash",
      .group = group::kCatalogue,
      .physics = "Lost motion: a slider stands half its play behind its drive, and the drive crosses the play over the "
                 "first travel after a reversal; unlike reversal_spike the error persists until the next reversal, "
                 "unlike servo_lag it does not grow with speed.",
      .formula = "slider = travel_direction (play/2 - min(since_reversal, play))",
      .source = "play operator; ISO 230-4 reversal error",
      .element_kind = "slider",
      .elements = kSixElements,
      // A worn nut or coupling has some hundredths of a millimetre; a tenth is an audible fault.
      .parameters = {{.name = "play", .unit = "mm", .prior_sigma = 0.02, .limit = 1.0, .is_nonnegative = true}},
      .ports = {"slider"},
      .needs = {"travel_direction", "since_reversal_mm"},
  });
}

}  // namespace hexdbb::effects
