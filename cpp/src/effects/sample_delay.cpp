// The gauge is read later than the encoders. Meanwhile the sliders move on, by the Taylor series of their motion:
//   push = v t + a t^2 / 2 + j t^3 / 6 + s t^4 / 24, t the delay.
// A tangent alone would leave the circle by v^2 t^2 / (2 R), 17 um at 50 mm/s and 37 ms; the terms up to the fourth
// leave 40 nm at 400 ms.
#include <utility>

#include "block_column.hpp"
#include "catalogue.hpp"
#include "elements.hpp"

namespace hexdbb::effects {

namespace {

class SampleDelay : public Effect {
 public:
  using Effect::Effect;

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    const double delay = values[0];
    for (int k = 0; k < kLegs; ++k) {
      const Derivatives of(block, k);
      ports.col(port::kSlider + k).array() +=
          delay * (of.first + delay / 2.0 * (of.second + delay / 3.0 * (of.third + delay / 4.0 * of.fourth)));
    }
  }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    const double delay = values[0];
    jacobian.setZero();
    for (int k = 0; k < kLegs; ++k) {
      const Derivatives of(block, k);
      jacobian.col(0).array() += sensitivity.col(port::kSlider + k).array() *
                                 (of.first + delay * (of.second + delay / 2.0 * (of.third + delay / 3.0 * of.fourth)));
    }
  }

 private:
  /// Time derivatives of slider k's coordinate in the samples of a block.
  struct Derivatives {
    Derivatives(const SampleBlock& block, int k)
        : first(block.of(block.samples.state.velocity_mm_s, k).array()),
          second(block.of(block.samples.state.acceleration_mm_s2, k).array()),
          third(block.of(block.samples.state.jerk_mm_s3, k).array()),
          fourth(block.of(block.samples.state.snap_mm_s4, k).array()) {}

    BlockColumn first, second, third, fourth;
  };
};

}  // namespace

EffectPtr sample_delay(const Context&) {
  return std::make_shared<SampleDelay>(EffectInfo{
      .name = "sample_delay",
      .group = group::kCatalogue,
      .physics =
          "The gauge is read later than the encoders, and all sliders have moved on meanwhile; one value for all, "
          "of opposite sign to a servo_lag that all sliders share.",
      .formula = "slider = v t + a t^2 / 2 + jerk t^3 / 6 + snap t^4 / 24, t = delay",
      .source = "sampling of two devices that are not synchronous",
      .element_kind = "machine",
      .elements = kWhole,
      // A sample period or two of a fieldbus.
      .parameters = {{.name = "delay", .unit = "s", .prior_sigma = 5e-3, .limit = 0.5, .is_nonnegative = true}},
      .ports = {"slider"},
      .needs = {"velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3", "snap_mm_s4"},
      .is_set_up = true,
  });
}

}  // namespace hexdbb::effects
