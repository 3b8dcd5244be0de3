// Effects that push every port by a polynomial of its own slider's coordinate, folded into one polynomial a port.
//
// Model: push_p = sum over x of x (c0 + c1 u + c2 u^2), u the coordinate of slider k(p) from mid-travel per half
// travel, k(p) the slider or leg to which port p belongs, x one of: 1, the slider's velocity, its direction of travel,
// its leg's force, the warming. All geometric errors of the thesis, and all effects of the catalogue that a controller
// can correct except the pitch error of the screws (slider_waves.hpp), have this form. Whether an effect has it is
// determined by evaluating it: some positions and states determine the coefficients, others verify them.
#pragma once

#include <array>
#include <vector>

#include "hexdbb/leg_ports.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// The factors to which pushes may be proportional, at one instant.
struct InstantState {
  Vector6 velocity_mm_s = Vector6::Zero();
  Vector6 travel_direction = Vector6::Zero();  // -1 to 1
  Vector6 leg_force = Vector6::Zero();
  double warming_k = 0.0;  // 0 where not measured
};

class SliderPolynomials {
 public:
  static constexpr int kPorts = port::kBall;  // slider, leg, slider_joint, platform_joint
  static constexpr int kPowers = 3;

  explicit SliderPolynomials(const Machine& machine);

  /// Add an effect. Return false, and add nothing, where it does not have this form.
  bool fold(const Term& term);

  /// Set the state for the following evaluations, and pushes beside it that are constant then: those of `quantities`.
  void settle(const InstantState& state, const LegPorts& beside = LegPorts(),
              const std::vector<int>& quantities = {}) noexcept;

  /// Coefficients of each power of u in the state set.
  const std::array<LegPorts, kPowers>& settled() const noexcept { return settled_; }

  const LegRow& middle_mm() const noexcept { return middle_mm_; }
  const LegRow& per_half() const noexcept { return per_half_; }  // 1 / mm

 private:
  static constexpr int kFactors = 5;  // 1, velocity, direction of travel, leg force, warming
  using Coefficients = std::array<LegPorts, kPowers>;

  /// One row of coefficients that a factor other than 1 multiplies.
  struct Varying {
    int factor, power, quantity;
  };

  Coefficients coefficients_of(const Term& term, int factor) const;
  void find_varying();
  void settle_varying(const InstantState& state) noexcept;

  Machine machine_;
  LegRow middle_mm_, per_half_;
  std::array<Coefficients, kFactors> of_factor_;
  std::vector<Varying> varying_;
  Coefficients settled_;
};

}  // namespace hexdbb
