// What stands between a drive's encoder and its slider in motion: the screw and the servo.
#include <utility>

#include "catalogue.hpp"
#include "linear_effect.hpp"
#include "multiversion.hpp"
#include "turns.hpp"

namespace hexdbb {

namespace {

constexpr int kPerSlider = 4;

/// Six sliders side by side: cos_1, sin_1, cos_2, sin_2 of each one after another.
HEXDBB_MULTIVERSION
void pitch_errors(const double* slider_mm, const double* values, double per_mm, double* out_mm) {
  for (int k = 0; k < kLegs; ++k) {
    const auto [c, s] = cos_sin_of_turns(per_mm * slider_mm[k]);
    const double* v = values + kPerSlider * k;
    out_mm[k] = v[0] * c + v[1] * s + v[2] * (c * c - s * s) + v[3] * 2.0 * c * s;
  }
}

/// Screw pitch error: push = sum over h = 1, 2 of cos_h cos(h a) + sin_h sin(h a), a = 2 pi s / lead.
class CyclicEffect : public Effect {
 public:
  CyclicEffect(EffectInfo info, double period_mm) : info_(std::move(info)), per_mm_(1.0 / period_mm) {}

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      double slider_mm[kLegs], pushed_mm[kLegs];
      for (int k = 0; k < kLegs; ++k) slider_mm[k] = block.slider_mm(k)[row];
      pitch_errors(slider_mm, values.data(), per_mm_, pushed_mm);
      for (int k = 0; k < kLegs; ++k) ports(row, port::kSlider + k) += pushed_mm[k];
    }
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    for (int k = 0; k < kLegs; ++k) {
      jacobian.middleCols<kPerSlider>(kPerSlider * k) =
          harmonics(block, k).array().colwise() * sensitivity.col(port::kSlider + k).array();
    }
  }

 private:
  using Harmonics = Eigen::Matrix<double, Eigen::Dynamic, kPerSlider, 0, Block::kRows, kPerSlider>;

  /// cos a, sin a, cos 2a, sin 2a, the latter by double angles.
  Harmonics harmonics(const SampleBlock& block, int k) const {
    Harmonics out(block.count, int{kPerSlider});
    const auto slider_mm = block.slider_mm(k);
    for (Eigen::Index row = 0; row < block.count; ++row) {
      const auto [c, s] = cos_sin_of_turns(per_mm_ * slider_mm[row]);
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
