// The six legs side by side, as vector instructions take them: a row holds one number of every leg.
//
// Rows are as wide as the widest vector register. Their last two numbers repeat the last two legs, so that whatever is
// computed, compared or reduced over a row is that of the six legs.
#pragma once

#include "hexdbb/mechanism.hpp"

namespace hexdbb {

constexpr int kLegLanes = 8;

struct alignas(64) LegRow {
  double of[kLegLanes] = {};

  LegRow() = default;
  explicit LegRow(const Vector6& legs) noexcept {
    for (int k = 0; k < kLegLanes; ++k) of[k] = legs[k < kLegs ? k : k - 2];
  }

  auto legs() const noexcept { return Eigen::Map<const Vector6>(of); }
};

/// Pushes at all ports of the legs: those before port::kBall.
struct alignas(64) LegPorts {
  static constexpr int kSlider = 0;
  static constexpr int kLeg = 1;
  static constexpr int kSliderJoint = 2;
  static constexpr int kPlatformJoint = kSliderJoint + 3;
  static constexpr int kQuantities = kPlatformJoint + 3;

  double value[kQuantities * kLegLanes] = {};

  /// Return the index in `value` of a port's column.
  static constexpr int place(int column) noexcept {
    constexpr auto of = [](int quantity, int leg) { return kLegLanes * quantity + leg; };
    if (column < port::kLeg) return of(kSlider, column - port::kSlider);
    if (column < port::kSliderJoint) return of(kLeg, column - port::kLeg);
    const bool is_slider_joint = column < port::kPlatformJoint;
    const int at = column - (is_slider_joint ? port::kSliderJoint : port::kPlatformJoint);
    return of((is_slider_joint ? kSliderJoint : kPlatformJoint) + at % 3, at / 3);
  }

  double* row(int quantity) noexcept { return value + kLegLanes * quantity; }
  const double* row(int quantity) const noexcept { return value + kLegLanes * quantity; }

  /// Let the last two numbers of every row repeat the last two legs again, after single ports were changed.
  void repeat() noexcept {
    for (int quantity = 0; quantity < kQuantities; ++quantity) {
      double* const legs = row(quantity);
      legs[kLegs] = legs[kLegs - 2];
      legs[kLegs + 1] = legs[kLegs - 1];
    }
  }

  Ports ports() const noexcept {
    Ports out;
    for (int column = 0; column < port::kBall; ++column) out.value[column] = value[place(column)];
    return out;
  }
};

/// Constant parts of the nominal machine's inverse kinematics.
struct NominalLegs {
  explicit NominalLegs(const NominalGeometry& nominal);

  LegRow platform_joint[3];  // x, y, z, as the next two
  LegRow vertex[3];
  LegRow direction[3];
  LegRow length;
  LegRow side;  // -1: the slider stands before its leg's foot on the guideway; +1: beyond it
};

}  // namespace hexdbb
