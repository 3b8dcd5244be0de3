// What stands between a drive's encoder and its slider in motion: the screw and the servo.
#include <cmath>
#include <utility>

#include "catalogue.hpp"
#include "linear_effect.hpp"

namespace hexdbb {

namespace {

/// Screw pitch error: push = sum over h = 1, 2 of cos_h cos(h a) + sin_h sin(h a), a = 2 pi s / lead.
class CyclicEffect : public Effect {
 public:
  CyclicEffect(EffectInfo info, double period_mm) : info_(std::move(info)), per_mm_(2.0 * M_PI / period_mm) {}

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      const auto of_slider = values.segment<kPerSlider>(kPerSlider * k);
      if (of_slider.isZero(0.0)) continue;
      ports.col(port::kSlider + k) += harmonics(block, k) * of_slider;
    }
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      jacobian.middleCols<kPerSlider>(kPerSlider * k) =
          harmonics(block, k).array().colwise() * sensitivity.col(port::kSlider + k).array();
    }
  }

 private:
  static constexpr int kPerSlider = 4;
  using Harmonics = Eigen::Matrix<double, Eigen::Dynamic, kPerSlider, 0, Block::kRows, kPerSlider>;

  /// cos a, sin a, cos 2a, sin 2a, the latter by double angles.
  Harmonics harmonics(const SampleBlock& block, int k) const {
    Harmonics out(block.count, int{kPerSlider});
    const auto slider_mm = block.slider_mm(k);
    for (Eigen::Index row = 0; row < block.count; ++row) {
      const double angle = per_mm_ * slider_mm[row];
      const double c = std::cos(angle), s = std::sin(angle);
      out.row(row) << c, s, c * c - s * s, 2.0 * c * s;
    }
    return out;
  }

  EffectInfo info_;
  double per_mm_;
};

}  // namespace

EffectPtr pitch_cyclic(const Machine& machine) {
  // Rolled screws and their couplings wobble by some um to some tens of um a turn.
  const auto amplitude = [](const char* name) { return ParameterInfo{name, "mm", 0.01, 0.5}; };
  return std::make_shared<CyclicEffect>(
      EffectInfo{"pitch_cyclic",
                 "The screw's pitch errs periodically with its turn, once and twice; unlike any error of geometry it "
                 "repeats with the screw's lead along the travel.",
                 "ISO 3408-3, wobble within one revolution (v2pi)",
                 "slider",
                 kSixElements,
                 {amplitude("cos_1"), amplitude("sin_1"), amplitude("cos_2"), amplitude("sin_2")},
                 {"slider"},
                 false,
                 group::kCatalogue},
      machine.screw_lead_mm);
}

EffectPtr lead_error(const Machine& machine) {
  std::vector<Shape> shapes;
  const double mid_mm = mid_travel_mm(machine);
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back(
        {[k, mid_mm](const SampleBlock& block) -> BlockColumn { return block.slider_mm(k).array() - mid_mm; },
         {{k, port::kSlider + k, 1.0}}});
  }
  // A rolled screw of tolerance class T10 may err by 210 um on 300 mm.
  EffectInfo info{"lead_error",
                  "The screw's lead is longer than nominal: a slider goes too far in proportion to its distance from "
                  "mid-travel; its constant part is slider_offset's, so it is counted from there.",
                  "ISO 3408-3, specified travel deviation",
                  "slider",
                  kSixElements,
                  {{"lead", "mm/mm", 5e-4, 1e-2}},
                  {"slider"},
                  false,
                  group::kCatalogue};
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

EffectPtr servo_lag() {
  std::vector<Shape> shapes;
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back({[k](const SampleBlock& block) -> BlockColumn {
                        return block.of(block.samples.state.velocity_mm_s, k).array();
                      },
                      {{k, port::kSlider + k, -1.0}}});
  }
  // Following errors that the encoder sees are in the reported coordinates already; what is left between encoder and
  // slider is compliance and filtering: ms.
  EffectInfo info{"servo_lag",
                  "A slider lags behind its drive's encoder in proportion to its speed; unlike backlash it vanishes at "
                  "slow feed, unlike sample_delay it is each slider's own.",
                  "first-order lag: displacement = -lag x velocity",
                  "slider",
                  kSixElements,
                  {{"lag", "s", 2e-3, 0.1}},
                  {"slider"},
                  false,
                  group::kCatalogue,
                  {"velocity_mm_s"}};
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb
