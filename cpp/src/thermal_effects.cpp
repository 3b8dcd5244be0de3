// Growth with heat: with the measured temperature where there is one, else with time.
//
// Assumption: what grows has the temperature that is recorded, or warms steadily. Growth counts from the record's first
// sample (first measured temperature): what was there before is geometry. Each sample takes one of the two laws.
#include <cmath>
#include <utility>

#include "catalogue.hpp"
#include "linear_effect.hpp"

namespace hexdbb {

namespace {

BlockColumn warming_k(const SampleBlock& block) {
  const auto warming = block.of(block.samples.state.warming_k).array();
  return warming.isFinite().select(warming, 0.0);
}

/// Time of the samples without a temperature.
BlockColumn blind_time_s(const SampleBlock& block) {
  const auto warming = block.of(block.samples.state.warming_k).array();
  return warming.isFinite().select(0.0, block.of(block.samples.state.time_s).array());
}

const std::vector<std::string> kNeeds = {"time_s", "warming_k"};

}  // namespace

EffectPtr leg_thermal() {
  Shape with_temperature{warming_k, {}}, with_time{blind_time_s, {}};
  for (int k = 0; k < kLegs; ++k) {
    with_temperature.links.push_back({0, port::kLeg + k, 1.0});
    with_time.links.push_back({1, port::kLeg + k, 1.0});
  }
  // Steel of 400 mm grows by 4.6 um/K, aluminium by 9; a machine that warms up does some 5 K in its first hour.
  EffectInfo info{
      "leg_thermal",
      "All legs grow alike with the measured temperature, else with time; unlike leg_length it changes during "
      "the test, unlike bar_drift it moves the platform.",
      "thermal expansion, ISO 230-3",
      "machine",
      kWhole,
      {{"per_kelvin", "mm/K", 0.01, 0.1}, {"per_time", "mm/s", 0.05 / kSecondsPerHour, 1.0 / kSecondsPerHour}},
      {"leg"},
      false,
      group::kCatalogue,
      kNeeds};
  return std::make_shared<LinearEffect>(std::move(info),
                                        std::vector<Shape>{std::move(with_temperature), std::move(with_time)});
}

EffectPtr screw_thermal(const Machine& machine) {
  std::vector<Shape> shapes;
  const double mid_mm = mid_travel_mm(machine);
  for (int k = 0; k < kLegs; ++k) {
    shapes.push_back({[k, mid_mm](const SampleBlock& block) -> BlockColumn {
                        return (block.slider_mm(k).array() - mid_mm) * warming_k(block);
                      },
                      {{2 * k, port::kSlider + k, 1.0}}});
    shapes.push_back({[k, mid_mm](const SampleBlock& block) -> BlockColumn {
                        return (block.slider_mm(k).array() - mid_mm) * blind_time_s(block);
                      },
                      {{2 * k + 1, port::kSlider + k, 1.0}}});
  }
  // Steel: 11.5e-6 /K. A driven screw warms faster than the air beside it: twice that, or 5 K an hour.
  EffectInfo info{
      "screw_thermal",
      "A screw's lead grows with the measured temperature, else with time, counted from mid-travel; unlike "
      "lead_error it changes during the test, unlike leg_thermal it grows with the distance from "
      "mid-travel.",
      "thermal expansion, ISO 230-3",
      "slider",
      kSixElements,
      {{"per_kelvin", "1/K", 2e-5, 2e-4}, {"per_time", "1/s", 1e-4 / kSecondsPerHour, 2e-3 / kSecondsPerHour}},
      {"slider"},
      false,
      group::kCatalogue,
      kNeeds};
  return std::make_shared<LinearEffect>(std::move(info), std::move(shapes));
}

}  // namespace hexdbb
