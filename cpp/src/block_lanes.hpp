// Rows of a block as lanes: loading and storing the quantities of the kernels.
#pragma once

#include "block.hpp"
#include "sample_kernel.hpp"

namespace hexdbb {

using rssr::Vec;

/// Load columns `first`, `first` + 1, `first` + 2 of a table as a vector of lanes.
template <class L, class Table>
inline Vec<L> load3(const Table& table, Eigen::Index row, int first) {
  return {load<L>(&table(row, first)), load<L>(&table(row, first + 1)), load<L>(&table(row, first + 2))};
}

template <class L, class Table>
inline void store3(const Vec<L>& v, Table& table, Eigen::Index row, int first) {
  store(v.x, &table(row, first));
  store(v.y, &table(row, first + 1));
  store(v.z, &table(row, first + 2));
}

template <class L>
inline Vec<L> constant3(const Matrix36& columns, int k) {
  return {lanes_of<L>(columns(0, k)), lanes_of<L>(columns(1, k)), lanes_of<L>(columns(2, k))};
}

/// Load a slider's joint in some rows.
template <class L>
inline Vec<L> load_base(const NominalGeometry& nominal, const Block& block, Eigen::Index row, int k) {
  const L along = load<L>(&block.sliders_mm(row, k)) + load<L>(&block.ports(row, port::kSlider + k));
  return constant3<L>(nominal.vertex, k) + along * constant3<L>(nominal.direction, k) +
         load3<L>(block.ports, row, port::kSliderJoint + 3 * k);
}

template <class L>
inline L load_length(const NominalGeometry& nominal, const Block& block, Eigen::Index row, int k) {
  return nominal.machine.leg_length_mm[k] + load<L>(&block.ports(row, port::kLeg + k));
}

template <class L>
inline Vec<L> load_platform_joint(const NominalGeometry& nominal, const Block& block, Eigen::Index row, int k) {
  return constant3<L>(nominal.platform_joint, k) + load3<L>(block.ports, row, port::kPlatformJoint + 3 * k);
}

template <class L>
inline L magnitude(const L& v) {
  return v < 0.0 ? -v : v;
}

/// Whole numbers, one for each lane: what __builtin_shuffle takes.
template <class L>
struct OrderOf {
  typedef long long Type __attribute__((vector_size(sizeof(L))));
};

/// Return whether a lane is above a limit; NaN is not.
template <class L>
inline bool any_above(const L& v, double limit) {
  using Order = typename OrderOf<L>::Type;
  L above = v > limit ? lanes_of<L>(1.0) : L{};  // numbers: GCC 12 takes masks of lanes apart
  if constexpr (kLanesIn<L> == 8) above += __builtin_shuffle(above, Order{4, 5, 6, 7, 0, 1, 2, 3});
  if constexpr (kLanesIn<L> == 8) above += __builtin_shuffle(above, Order{2, 3, 0, 1, 6, 7, 4, 5});
  if constexpr (kLanesIn<L> == 4) above += __builtin_shuffle(above, Order{2, 3, 0, 1});
  return above[0] + above[1] > 0.0;
}

/// Store the sensitivities; `share[k]` times `leg[k]` is the force in leg k, `n` the unit vector from cup to ball.
template <class L>
inline void store_sensitivity(const NominalGeometry& nominal, const Vec<L> (&leg)[6], const L (&share)[6],
                              const L (&length)[6], const rssr::PlacedPlatform<L>& platform, const Vec<L>& n,
                              Block& block, Eigen::Index row) {
  auto& out = block.sensitivity;
  for (int k = 0; k < kLegs; ++k) {
    const Vec<L> force = share[k] * leg[k];
    store(rssr::dot(force, constant3<L>(nominal.direction, k)), &out(row, port::kSlider + k));
    store(share[k] * length[k], &out(row, port::kLeg + k));
    store3(force, out, row, port::kSliderJoint + 3 * k);
    const Vec<L> back = platform.turned_back(force);
    store3(Vec<L>{-back.x, -back.y, -back.z}, out, row, port::kPlatformJoint + 3 * k);
  }
  store3(platform.turned_back(n), out, row, port::kBall);
  store3(Vec<L>{-n.x, -n.y, -n.z}, out, row, port::kCup);
  store(lanes_of<L>(1.0), &out(row, port::kReading));
}

/// The ball bar in some rows.
template <class L>
struct LanesBar {
  Vec<L> ball;       // platform frame
  Vec<L> direction;  // unit vector from cup to ball, base frame; NaN where the bar has zero length
  L reading_mm;
};

template <class L>
inline LanesBar<L> read_bar(const rssr::PlacedPlatform<L>& platform, const Block& block, Eigen::Index row) {
  const Vec<L> ball = load3<L>(block.ball_mm, row, 0) + load3<L>(block.ports, row, port::kBall);
  const Vec<L> bar = platform.position + platform.turned(ball) - load3<L>(block.cup_mm, row, 0) -
                     load3<L>(block.ports, row, port::kCup);
  const L length = root(rssr::dot(bar, bar));
  return {ball, (1.0 / length) * bar,
          length - load<L>(&block.bar_length_mm(row)) + load<L>(&block.ports(row, port::kReading))};
}

template <class L>
inline void store_pose(const rssr::PlacedPlatform<L>& platform, Block& block, Eigen::Index row) {
  store3(platform.position, block.pose, row, 0);
  for (int j = 0; j < 3; ++j) {
    store(platform.column[j].x, &block.pose(row, 3 + j));
    store(platform.column[j].y, &block.pose(row, 6 + j));
    store(platform.column[j].z, &block.pose(row, 9 + j));
  }
}

}  // namespace hexdbb
