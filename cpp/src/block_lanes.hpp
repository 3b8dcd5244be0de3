// Eight rows of a block as lanes: loading and storing the quantities of the kernels.
#pragma once

#include "block.hpp"
#include "sample_kernel.hpp"

namespace hexdbb {

using rssr::Vec;

constexpr double kLargestTurn = 0.05;  // tangent of a Newton step beyond which the start was not a neighbouring pose

/// Load columns `first`, `first` + 1, `first` + 2 of a table as a vector of lanes.
template <class Table>
inline Vec<Lanes> load3(const Table& table, Eigen::Index row, int first) {
  return {load(&table(row, first)), load(&table(row, first + 1)), load(&table(row, first + 2))};
}

template <class Table>
inline void store3(const Vec<Lanes>& v, Table& table, Eigen::Index row, int first) {
  store(v.x, &table(row, first));
  store(v.y, &table(row, first + 1));
  store(v.z, &table(row, first + 2));
}

inline Vec<Lanes> constant3(const Matrix36& columns, int k) {
  return {lanes_of(columns(0, k)), lanes_of(columns(1, k)), lanes_of(columns(2, k))};
}

/// Load a slider's joint in eight rows.
inline Vec<Lanes> load_base(const NominalGeometry& nominal, const Block& block, Eigen::Index row, int k) {
  const Lanes along = load(&block.sliders_mm(row, k)) + load(&block.ports(row, port::kSlider + k));
  return constant3(nominal.vertex, k) + along * constant3(nominal.direction, k) +
         load3(block.ports, row, port::kSliderJoint + 3 * k);
}

inline Lanes load_length(const NominalGeometry& nominal, const Block& block, Eigen::Index row, int k) {
  return nominal.machine.leg_length_mm[k] + load(&block.ports(row, port::kLeg + k));
}

inline Vec<Lanes> load_platform_joint(const NominalGeometry& nominal, const Block& block, Eigen::Index row, int k) {
  return constant3(nominal.platform_joint, k) + load3(block.ports, row, port::kPlatformJoint + 3 * k);
}

inline Lanes magnitude(const Lanes& v) { return v < 0.0 ? -v : v; }

/// Return whether a lane is above a limit; NaN is not.
inline bool any_above(const Lanes& v, double limit) {
  typedef long long Order __attribute__((vector_size(sizeof(Lanes))));
  Lanes above = v > limit ? lanes_of(1.0) : Lanes{};  // numbers: GCC 12 takes masks of lanes apart
  above += __builtin_shuffle(above, Order{4, 5, 6, 7, 0, 1, 2, 3});
  above += __builtin_shuffle(above, Order{2, 3, 0, 1, 6, 7, 4, 5});
  return above[0] + above[1] > 0.0;
}

/// Store the sensitivities; `share[k]` times `leg[k]` is the force in leg k, `n` the unit vector from cup to ball.
inline void store_sensitivity(const NominalGeometry& nominal, const Vec<Lanes> (&leg)[6], const Lanes (&share)[6],
                              const Lanes (&length)[6], const rssr::PlacedPlatform<Lanes>& platform,
                              const Vec<Lanes>& n, Block& block, Eigen::Index row) {
  auto& out = block.sensitivity;
  for (int k = 0; k < kLegs; ++k) {
    const Vec<Lanes> force = share[k] * leg[k];
    store(rssr::dot(force, constant3(nominal.direction, k)), &out(row, port::kSlider + k));
    store(share[k] * length[k], &out(row, port::kLeg + k));
    store3(force, out, row, port::kSliderJoint + 3 * k);
    const Vec<Lanes> back = platform.turned_back(force);
    store3(Vec<Lanes>{-back.x, -back.y, -back.z}, out, row, port::kPlatformJoint + 3 * k);
  }
  store3(platform.turned_back(n), out, row, port::kBall);
  store3(Vec<Lanes>{-n.x, -n.y, -n.z}, out, row, port::kCup);
  store(lanes_of(1.0), &out(row, port::kReading));
}

/// The ball bar in eight rows.
struct LanesBar {
  Vec<Lanes> ball;       // platform frame
  Vec<Lanes> direction;  // unit vector from cup to ball, base frame; NaN where the bar has zero length
  Lanes reading_mm;
};

inline LanesBar read_bar(const rssr::PlacedPlatform<Lanes>& platform, const Block& block, Eigen::Index row) {
  const Vec<Lanes> ball = load3(block.ball_mm, row, 0) + load3(block.ports, row, port::kBall);
  const Vec<Lanes> bar =
      platform.position + platform.turned(ball) - load3(block.cup_mm, row, 0) - load3(block.ports, row, port::kCup);
  const Lanes length = root(rssr::dot(bar, bar));
  return {ball, (1.0 / length) * bar,
          length - load(&block.bar_length_mm(row)) + load(&block.ports(row, port::kReading))};
}

inline void store_pose(const rssr::PlacedPlatform<Lanes>& platform, Block& block, Eigen::Index row) {
  store3(platform.position, block.pose, row, 0);
  for (int j = 0; j < 3; ++j) {
    store(platform.column[j].x, &block.pose(row, 3 + j));
    store(platform.column[j].y, &block.pose(row, 6 + j));
    store(platform.column[j].z, &block.pose(row, 9 + j));
  }
}

}  // namespace hexdbb
