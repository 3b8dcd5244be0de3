// Screw pitch error: push = sum over h = 1, 2 of cos_h cos(h a) + sin_h sin(h a), a = 2 pi s / lead.
#include <utility>

#include "block_column.hpp"
#include "catalogue.hpp"
#include "elements.hpp"
#include "multiversion.hpp"
#include "turns.hpp"

namespace hexdbb::effects {

namespace {

constexpr int kPerSlider = 4;

/// Compute the push of six sliders side by side; values are cos_1, sin_1, cos_2, sin_2 of each, one after another.
HEXDBB_MULTIVERSION
void pitch_errors(const double* slider_mm, const double* values, double per_mm, double* out_mm) {
  for (int k = 0; k < kLegs; ++k) {
    const auto [c, s] = cos_sin_of_turns(per_mm * slider_mm[k]);
    const double* v = values + kPerSlider * k;
    out_mm[k] = v[0] * c + v[1] * s + v[2] * (c * c - s * s) + v[3] * 2.0 * c * s;
  }
}

class CyclicEffect : public Effect {
 public:
  CyclicEffect(EffectInfo info, double period_mm) : Effect(std::move(info)), per_mm_(1.0 / period_mm) {}

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

  double per_mm_;
};

/// Rolled screws and their couplings have a wobble of some um to some tens of um per turn.
ParameterInfo amplitude(const char* name) { return {.name = name, .unit = "mm", .prior_sigma = 0.01, .limit = 0.5}; }

}  // namespace

EffectPtr pitch_cyclic(const Context& context) {
  EffectInfo info = {
      .name = "pitch_cyclic",
      .group = group::kCatalogue,
      .physics =
          "The screw's pitch error is periodic, once and twice per turn of the screw; unlike any geometric error "
          "it repeats with the screw's lead along the travel.",
      .formula = "slider = sum over h = 1, 2 of cos_h cos(2 pi h s / lead) + sin_h sin(2 pi h s / lead)",
      .source = "ISO 3408-3, wobble within one revolution (v2pi)",
      .element_kind = "slider",
      .elements = kSixElements,
      .parameters = {amplitude("cos_1"), amplitude("sin_1"), amplitude("cos_2"), amplitude("sin_2")},
      .ports = {"slider"},
  };
  return std::make_shared<CyclicEffect>(std::move(info), context.machine.screw_lead_mm);
}

}  // namespace hexdbb::effects
