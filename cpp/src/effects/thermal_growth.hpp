// Thermal growth: with the measured temperature where there is one, otherwise with time.
//
// Assumption: the growing part has the recorded temperature, or warms towards a steady state at a rate that decays with
// a time constant: rate tau (1 - exp(-t / tau)), t from the record's first sample. Growth counts from there (from the
// first measured temperature); what was there before is geometry. Each sample follows one of the two laws.
#pragma once

#include <cmath>
#include <utility>

#include "block_column.hpp"
#include "elements.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

class ThermalGrowth : public Effect {
 public:
  /// Values of an element: growth per kelvin, rate at the start, logarithm of the time constant over 30 minutes.
  enum { kPerKelvin, kPerTime, kLogTime, kValues };

  /// What grows: every screw on its own, in proportion to the distance from mid-travel `mid_mm`, one each, or all legs alike.
  enum class Part { kScrews, kLegs };

  ThermalGrowth(EffectInfo info, Part part, const PerLeg& mid_mm = {})
      : Effect(std::move(info)), of_screws_(part == Part::kScrews), mid_mm_(mid_mm) {}

  void push(const SampleBlock& block, hexdbb::Values values, PortBlock ports) const override {
    for (int k = 0; k < hexdbb::kLegs; ++k) {
      const double* own = values.data() + first_value(k);
      if (own[kPerKelvin] == 0.0 && own[kPerTime] == 0.0) continue;
      const BlockColumn growth = own[kPerKelvin] * warming_k(block) + own[kPerTime] * warmed(block, own[kLogTime]);
      ports.col(port_of(k)).array() += growth * lever(block, k);
    }
  }

  void chain(const SampleBlock& block, hexdbb::Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (int k = 0; k < hexdbb::kLegs; ++k) {
      const double* own = values.data() + first_value(k);
      const BlockColumn answer = sensitivity.col(port_of(k)).array() * lever(block, k);
      const BlockColumn time = warmed(block, own[kLogTime]);
      jacobian.col(first_value(k) + kPerKelvin).array() += answer * warming_k(block);
      jacobian.col(first_value(k) + kPerTime).array() += answer * time;
      // d/dlog tau of tau (1 - exp(-t/tau)) = tau (1 - exp(-t/tau)) - t exp(-t/tau)
      const double tau = kUsualTime_s * std::exp(own[kLogTime]);
      const BlockColumn t = unmeasured_time_s(block);
      jacobian.col(first_value(k) + kLogTime).array() += answer * own[kPerTime] * (time - t * (-t / tau).exp());
    }
  }

 private:
  static constexpr double kUsualTime_s = 1800.0;  // time constant at log_time = 0: machines warm up within hours

  int first_value(int k) const { return of_screws_ ? kValues * k : 0; }
  int port_of(int k) const { return (of_screws_ ? port::kSlider : port::kLeg) + k; }

  BlockColumn lever(const SampleBlock& block, int k) const {
    if (of_screws_) return block.slider_mm(k).array() - mid_mm_[k];
    return BlockColumn::Ones(block.count);
  }

  static BlockColumn warming_k(const SampleBlock& block) {
    const auto warming = block.of(block.samples.state.warming_k).array();
    return warming.isFinite().select(warming, 0.0);
  }

  /// Time of the samples without a measured temperature, 0 for the others.
  static BlockColumn unmeasured_time_s(const SampleBlock& block) {
    const auto warming = block.of(block.samples.state.warming_k).array();
    return warming.isFinite().select(0.0, block.of(block.samples.state.time_s).array());
  }

  static BlockColumn warmed(const SampleBlock& block, double log_time) {
    const double tau = kUsualTime_s * std::exp(log_time);
    return tau * (1.0 - (-unmeasured_time_s(block) / tau).exp());
  }

  bool of_screws_;
  PerLeg mid_mm_;
};

}  // namespace hexdbb::effects
