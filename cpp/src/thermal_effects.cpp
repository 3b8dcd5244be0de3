// Growth with heat: with the measured temperature where there is one, else with time.
//
// Assumption: what grows has the temperature that is recorded, or warms towards a steady state, at a rate that decays
// with a time constant: rate tau (1 - exp(-t / tau)), t from the record's first sample. Growth counts from there (from
// the first measured temperature): what was there before is geometry. Each sample takes one of the two laws.
#include <cmath>
#include <utility>

#include "block_column.hpp"
#include "catalogue.hpp"

namespace hexdbb {

namespace {

constexpr double kUsualTime_s = 1800.0;  // half an hour, at log_time = 0

/// Values of an element: growth per kelvin, rate at the start, logarithm of the time constant over the usual one.
enum { kPerKelvin, kPerTime, kLogTime, kValues };

class ThermalGrowth : public Effect {
 public:
  /// `mid_mm`: growth is that of a screw, in proportion to the distance from mid-travel, each slider's own; else that
  /// of all legs alike.
  ThermalGrowth(EffectInfo info, bool of_screws, double mid_mm)
      : info_(std::move(info)), of_screws_(of_screws), mid_mm_(mid_mm) {}

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock& block, hexdbb::Values values, PortBlock ports) const override {
    for (int k = 0; k < kLegs; ++k) {
      const double* own = values.data() + first_value(k);
      if (own[kPerKelvin] == 0.0 && own[kPerTime] == 0.0) continue;
      const BlockColumn growth = own[kPerKelvin] * warming_k(block) + own[kPerTime] * warmed(block, own[kLogTime]);
      ports.col(port_of(k)).array() += growth * lever(block, k);
    }
  }

  void chain(const SampleBlock& block, hexdbb::Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (int k = 0; k < kLegs; ++k) {
      const double* own = values.data() + first_value(k);
      const BlockColumn answer = sensitivity.col(port_of(k)).array() * lever(block, k);
      const BlockColumn time = warmed(block, own[kLogTime]);
      jacobian.col(first_value(k) + kPerKelvin).array() += answer * warming_k(block);
      jacobian.col(first_value(k) + kPerTime).array() += answer * time;
      // d/dlog tau of tau (1 - exp(-t/tau)) = tau (1 - exp(-t/tau)) - t exp(-t/tau)
      const double tau = kUsualTime_s * std::exp(own[kLogTime]);
      const BlockColumn t = blind_time_s(block);
      jacobian.col(first_value(k) + kLogTime).array() += answer * own[kPerTime] * (time - t * (-t / tau).exp());
    }
  }

 private:
  int first_value(int k) const { return of_screws_ ? kValues * k : 0; }
  int port_of(int k) const { return (of_screws_ ? port::kSlider : port::kLeg) + k; }

  BlockColumn lever(const SampleBlock& block, int k) const {
    if (of_screws_) return block.slider_mm(k).array() - mid_mm_;
    return BlockColumn::Ones(block.count);
  }

  static BlockColumn warming_k(const SampleBlock& block) {
    const auto warming = block.of(block.samples.state.warming_k).array();
    return warming.isFinite().select(warming, 0.0);
  }

  /// Time of the samples without a temperature.
  static BlockColumn blind_time_s(const SampleBlock& block) {
    const auto warming = block.of(block.samples.state.warming_k).array();
    return warming.isFinite().select(0.0, block.of(block.samples.state.time_s).array());
  }

  static BlockColumn warmed(const SampleBlock& block, double log_time) {
    const double tau = kUsualTime_s * std::exp(log_time);
    return tau * (1.0 - (-blind_time_s(block) / tau).exp());
  }

  EffectInfo info_;
  bool of_screws_;
  double mid_mm_;
};

const std::vector<std::string> kNeeds = {"time_s", "warming_k"};

}  // namespace

EffectPtr leg_thermal() {
  // Steel of 400 mm grows by 4.6 um/K, aluminium by 9; a machine that warms up does some 5 K in its first hour.
  EffectInfo info{
      "leg_thermal",
      "All legs grow alike with the measured temperature, else with time, faster at first; unlike leg_length "
      "it changes during the test, unlike bar_drift it moves the platform.",
      "thermal expansion, ISO 230-3",
      "machine",
      kWhole,
      {{"per_kelvin", "mm/K", 0.01, 0.5},
       {"per_time", "mm/s", 0.1 / kSecondsPerHour, 2.0 / kSecondsPerHour},
       {"log_time", "1", 1.0, 4.0, true}},
      {"leg"},
      false,
      group::kCatalogue,
      kNeeds};
  return std::make_shared<ThermalGrowth>(std::move(info), false, 0.0);
}

EffectPtr screw_thermal(const Machine& machine) {
  // Steel: 11.5e-6 /K. A driven screw warms faster than the air beside it: twice that, or 5 K an hour; at the limits a
  // hundred times what a thermometer in the air shows.
  EffectInfo info{"screw_thermal",
                  "A screw's lead grows with the measured temperature, else with time, faster at first, counted from "
                  "mid-travel; unlike lead_error it changes during the test, unlike leg_thermal it grows with the "
                  "distance from mid-travel.",
                  "thermal expansion, ISO 230-3",
                  "slider",
                  kSixElements,
                  {{"per_kelvin", "1/K", 2e-5, 2e-3},
                   {"per_time", "1/s", 2e-4 / kSecondsPerHour, 4e-3 / kSecondsPerHour},
                   {"log_time", "1", 1.0, 4.0, true}},
                  {"slider"},
                  false,
                  group::kCatalogue,
                  kNeeds};
  return std::make_shared<ThermalGrowth>(std::move(info), true, mid_travel_mm(machine));
}

}  // namespace hexdbb
