// Rows in which every leg has its own joint: from the pose of the shared joints, Newton on six coordinates, eight rows
// at a time.
#include <limits>

#include "block_lanes.hpp"
#include "multiversion.hpp"
#include "six_kernel.hpp"

namespace hexdbb {

namespace {

constexpr int kMaxSteps = 6;  // joints a fraction of a mm apart need two
// Squared diagonal element of R, of unit columns, below which locked sliders do not hold the platform: rounding.
constexpr double kSingular = 1e-18;

inline rssr::PlacedPlatform<Lanes> load_pose(const Block& block, Eigen::Index row) {
  rssr::PlacedPlatform<Lanes> out;
  out.position = load3(block.pose, row, 0);
  for (int j = 0; j < 3; ++j) {
    out.column[j] = {load(&block.pose(row, 3 + j)), load(&block.pose(row, 6 + j)), load(&block.pose(row, 9 + j))};
  }
  return out;
}

inline bool any_long(const Lanes (&values)[6], double limit) {
  bool above = false;
  for (const Lanes& each : values) above |= any_above(magnitude(each), limit);
  return above;
}

/// Compute the residual of a solution: infinite where there is none, or another assembly of the machine may be found.
inline Lanes residual_of(const rssr::SixLegs<Lanes>& legs, const Lanes& longest_turn, const Lanes& least_squared) {
  const Lanes nowhere = lanes_of(std::numeric_limits<double>::infinity());
  Lanes residual_mm = {};
  for (const Lanes& each : legs.too_long) residual_mm = magnitude(each) > residual_mm ? magnitude(each) : residual_mm;
  residual_mm = longest_turn < kLargestTurn * kLargestTurn ? residual_mm : nowhere;
  return least_squared > kSingular ? residual_mm : nowhere;
}

inline void solve_lanes_six(const NominalGeometry& nominal, Block& block, Eigen::Index row, bool want_sensitivity) {
  Vec<Lanes> base[6], joint[6];
  Lanes length[6];
  for (int k = 0; k < kLegs; ++k) {
    base[k] = load_base(nominal, block, row, k);
    length[k] = load_length(nominal, block, row, k);
    joint[k] = load_platform_joint(nominal, block, row, k);
  }
  rssr::PlacedPlatform<Lanes> platform = load_pose(block, row);
  rssr::SixLegs<Lanes> legs = rssr::six_legs(base, length, joint, platform);
  rssr::Wrenches<Lanes> wrenches = rssr::factor(legs.column);
  Lanes longest_turn = {};  // squared
  for (int step = 0; step < kMaxSteps && any_long(legs.too_long, kResidualTolerance_mm); ++step) {
    const rssr::Six<Lanes> by = wrenches.movement(legs.too_long);
    rssr::move_back(by, platform);
    const Lanes turn = rssr::dot(by.moment, by.moment) * (1.0 / (rssr::kLever_mm * rssr::kLever_mm));
    longest_turn = turn > longest_turn ? turn : longest_turn;
    legs = rssr::six_legs(base, length, joint, platform);
    wrenches = rssr::factor(legs.column);
  }
  store_pose(platform, block, row);
  const LanesBar bar = read_bar(platform, block, row);
  store(bar.reading_mm, &block.reading_mm(row));
  Lanes residual_mm = residual_of(legs, longest_turn, wrenches.least_squared);
  if (want_sensitivity) {
    Lanes share[6];
    wrenches.forces(rssr::wrench(bar.direction, platform.turned(bar.ball)), share);
    for (int k = 0; k < kLegs; ++k) share[k] *= legs.inverse[k];
    store_sensitivity(nominal, legs.leg, share, length, platform, bar.direction, block, row);
    residual_mm += 0.0 * (share[0] + bar.direction.x);
  }
  // Where the shared joints had no solution, neither has this row.
  const Lanes before = load(&block.residual_mm(row));
  store(before <= kResidualTolerance_mm ? residual_mm : before, &block.residual_mm(row));
}

}  // namespace

HEXDBB_MULTIVERSION_WIDE
void solve_block_six(const NominalGeometry& nominal, Block& block, Eigen::Index rows, bool want_sensitivity) noexcept {
  for (Eigen::Index row = 0; row < rows; row += kLanes) solve_lanes_six(nominal, block, row, want_sensitivity);
}

}  // namespace hexdbb
