// Effects that push ports by waves of their own slider's coordinate, folded into two harmonics a port.
//
// Model: push_p = sum over h = 1, 2 of c_h cos(h a) + s_h sin(h a), a = 2 pi s / lead of the screw, s the coordinate of
// the slider or leg to which port p belongs: the pitch error of the screws. Whether an effect has this form is
// determined by evaluating it, as for slider_polynomials.hpp.
#pragma once

#include <vector>

#include "hexdbb/leg_ports.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

constexpr int kWaveHarmonics = 2;

/// The waves of one quantity of the legs: coefficients of cosines and sines.
struct SliderWave {
  int quantity;  // of LegPorts
  LegRow cosine[kWaveHarmonics];
  LegRow sine[kWaveHarmonics];
};

class SliderWaves {
 public:
  explicit SliderWaves(const Machine& machine) : machine_(machine) {}

  /// Add an effect. Return false, and add nothing, where it does not have this form.
  bool fold(const Term& term);

  const std::vector<SliderWave>& waves() const noexcept { return waves_; }
  double turns_per_mm() const noexcept { return 1.0 / machine_.screw_lead_mm; }

 private:
  Machine machine_;
  std::vector<SliderWave> waves_;
};

}  // namespace hexdbb
