// What the measurement adds: the gauge, its clock, the ball. None of these is the machine's: never compensated.
#include <utility>

#include "catalogue.hpp"
#include "linear_effect.hpp"
#include "place_per_set_up.hpp"

namespace hexdbb {

EffectPtr bar_drift() {
  Shape with_time{[](const SampleBlock& block) -> BlockColumn { return block.of(block.samples.state.time_s).array(); },
                  {{0, port::kReading, 1.0}}};
  // A carbon-fibre bar held in a warm hand: 10 um in the hour after.
  EffectInfo info{"bar_drift",
                  "The gauge's reading drifts steadily with time since the record began; unlike bar_length it changes "
                  "during the test, unlike leg_thermal it is the same at every angle.",
                  "ISO 230-4, thermal conditions of the instrument",
                  "machine",
                  kWhole,
                  {{"rate", "mm/s", 0.05 / kSecondsPerHour, 2.0 / kSecondsPerHour}},
                  {"reading"},
                  true,
                  group::kCatalogue,
                  {"time_s"}};
  return std::make_shared<LinearEffect>(std::move(info), std::vector<Shape>{std::move(with_time)});
}

EffectPtr bar_gain() {
  // The gain of the true reading is that of the nominal one (what the programme asks of the bar) plus that of the
  // errors, a thousandth of a tenth of a millimetre, which geometry absorbs. The measured reading must not stand in for
  // it: it would let the gain explain whatever the model misses.
  Shape in_proportion{
      [](const SampleBlock& block) -> BlockColumn { return block.of(block.samples.state.nominal_reading_mm).array(); },
      {{0, port::kReading, 1.0}}};
  EffectInfo info{
      "bar_gain",
      "The gauge reads too much in proportion to its deflection, here that of the nominal machine; it can be "
      "told from geometry only where a circle is run off its nominal radius.",
      "gauge scale error",
      "machine",
      kWhole,
      {{"gain", "1", 5e-3, 0.2}},
      {"reading"},
      true,
      group::kCatalogue,
      {"nominal_reading_mm"}};
  return std::make_shared<LinearEffect>(std::move(info), std::vector<Shape>{std::move(in_proportion)});
}

namespace {

/// While the gauge is read later, the sliders move on, by the Taylor series of their motion: a tangent alone would
/// leave the circle by v^2 delay^2 / (2 R), 17 um at 50 mm/s and 37 ms; the terms up to the fourth leave 40 nm at 400
/// ms.
class SampleDelay : public Effect {
 public:
  const EffectInfo& info() const override { return info_; }

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
  /// By time, of slider k's place in the samples of a block.
  struct Derivatives {
    Derivatives(const SampleBlock& block, int k)
        : first(block.of(block.samples.state.velocity_mm_s, k).array()),
          second(block.of(block.samples.state.acceleration_mm_s2, k).array()),
          third(block.of(block.samples.state.jerk_mm_s3, k).array()),
          fourth(block.of(block.samples.state.snap_mm_s4, k).array()) {}

    BlockColumn first, second, third, fourth;
  };

  EffectInfo info_{"sample_delay",
                   "The gauge is read later than the encoders: all sliders have moved on meanwhile; one value for all, "
                   "of opposite sign to a servo_lag that all sliders share.",
                   "sampling of two devices that are not synchronous",
                   "machine",
                   kWhole,
                   {{"delay", "s", 5e-3, 0.5}},  // a sample period or two of a fieldbus
                   {"slider"},
                   true,
                   group::kCatalogue,
                   {"velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3", "snap_mm_s4"}};
};

}  // namespace

EffectPtr sample_delay() { return std::make_shared<SampleDelay>(); }

EffectPtr ball_eccentricity(int mounts) {
  // A ball put back into its magnetic holder: hundredths of a millimetre.
  const auto along = [](const char* name) { return ParameterInfo{name, "mm", 0.05, 2.0}; };
  EffectInfo info{
      "ball_eccentricity",
      "The bar's ball sits elsewhere on the platform in every set-up, one offset for each fixing of the tool "
      "cup; ball_offset holds what all have in common.",
      "set-up",
      "mount",
      {},
      {along("x"), along("y"), along("z")},
      {"ball"},
      true,
      group::kCatalogue};
  return std::make_shared<PlacePerSetUp>(std::move(info), mounts, port::kBall);
}

}  // namespace hexdbb
