// The gauge is read later than the encoders. Meanwhile the sliders move on, by the Taylor series of their motion:
//   push = v t + a t^2 / 2 + j t^3 / 6 + s t^4 / 24, t the delay.
// A tangent alone would leave the circle by v^2 t^2 / (2 R), 17 um at 50 mm/s and 37 ms; the terms up to the fourth
// leave 40 nm at 400 ms.
//
// Where a filter of first order, of time constant T, makes a part of the delay, the encoders say s' with
// s = exp((t - T) d/dt) (1 + T d/dt) s', whose series has other factors: with f = T / t and g = f^2 (`filtered`)
//   push = v t + (1 - g) a t^2 / 2 + (1 - 3 g + 2 g f) j t^3 / 6 + (1 - 6 g + 8 g f - 3 g^2) s t^4 / 24.
// In g, not in f, it has a slope where nothing is filtered. A third of 60 ms filtered is 9 um at 60 mm/s.
#include <algorithm>
#include <cmath>
#include <optional>
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
    const Series series(values[1]);
    for (int k = 0; k < kLegs; ++k) {
      const Derivatives of(block, k);
      ports.col(port::kSlider + k).array() +=
          delay * (of.first + delay / 2.0 *
                                  (series.second * of.second +
                                   delay / 3.0 * (series.third * of.third + delay / 4.0 * series.fourth * of.fourth)));
      if (block.samples.moved_on_mm.rows() > 0) {
        ports.col(port::kSlider + k) -= block.of(block.samples.moved_on_mm, k);
      }
    }
  }

  std::optional<double> late_s(Values values) const override { return values[0]; }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    const double delay = values[0];
    const Series series(values[1]);
    const Series slope = Series::slope(values[1]);
    jacobian.setZero();
    for (int k = 0; k < kLegs; ++k) {
      const Derivatives of(block, k);
      const auto sensitive = sensitivity.col(port::kSlider + k).array();
      jacobian.col(0).array() +=
          sensitive *
          (of.first + delay * (series.second * of.second +
                               delay / 2.0 * (series.third * of.third + delay / 3.0 * series.fourth * of.fourth)));
      jacobian.col(1).array() +=
          sensitive * (delay * delay / 2.0 *
                       (slope.second * of.second +
                        delay / 3.0 * (slope.third * of.third + delay / 4.0 * slope.fourth * of.fourth)));
    }
  }

 private:
  /// Factors of the terms from the second on, for the square g of the part of the delay that is filtered.
  struct Series {
    explicit Series(double g)
        : second(1.0 - g),
          third(1.0 - 3.0 * g + 2.0 * g * root(g)),
          fourth(1.0 - 6.0 * g + 8.0 * g * root(g) - 3.0 * g * g) {}

    /// Their derivatives by g.
    static Series slope(double g) {
      Series found(0.0);
      found.second = -1.0;
      found.third = -3.0 + 3.0 * root(g);
      found.fourth = -6.0 + 12.0 * root(g) - 6.0 * g;
      return found;
    }

    double second, third, fourth;

   private:
    /// None where it is negative, as of a controller that predicts: there the second cumulant alone is meant.
    static double root(double g) { return std::sqrt(std::max(g, 0.0)); }
  };

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
          "of opposite sign to a servo_lag that all sliders share. Other effects act where the sliders are by then. A "
          "filter of the encoders' signals may make a part: "
          "filtered is its square, by which the acceleration counts less.",
      .formula = "slider = v t + (1 - g) a t^2 / 2 + (1 - 3 g + 2 g^1.5) jerk t^3 / 6 + (1 - 6 g + 8 g^1.5 - 3 g^2) "
                 "snap t^4 / 24, t = delay, g = filtered",
      .source = "sampling of two devices that are not synchronous",
      .element_kind = "machine",
      .elements = kWhole,
      // A sample period or two of a fieldbus; mostly less than half of it is filtered, all at most.
      .parameters = {{.name = "delay", .unit = "s", .prior_sigma = 5e-3, .limit = 0.5, .is_nonnegative = true},
                     {.name = "filtered", .unit = "1", .prior_sigma = 0.25, .limit = 1.0, .is_shape = true}},
      .ports = {"slider"},
      .needs = {"velocity_mm_s", "acceleration_mm_s2", "jerk_mm_s3", "snap_mm_s4"},
      .is_set_up = true,
  });
}

}  // namespace hexdbb::effects
