// Rows in which every leg has its own joint: from the pose of the shared joints, Newton on six coordinates, a
// row of lanes at a time.
#include <limits>

#include "block_lanes.hpp"
#include "largest_turns.hpp"
#include "multiversion.hpp"
#include "six_kernel.hpp"

namespace hexdbb {

namespace {

constexpr int kMaxSteps = 6;  // joints a fraction of a mm apart need two
// Squared diagonal element of R, of unit columns, below which locked sliders do not hold the platform: rounding.
constexpr double kSingular = 1e-18;

template <class L>
inline rssr::PlacedPlatform<L> load_pose(const Block& block, Eigen::Index row) {
  rssr::PlacedPlatform<L> out;
  out.position = load3<L>(block.pose, row, 0);
  for (int j = 0; j < 3; ++j) {
    out.column[j] = {load<L>(&block.pose(row, 3 + j)), load<L>(&block.pose(row, 6 + j)),
                     load<L>(&block.pose(row, 9 + j))};
  }
  return out;
}

template <class L>
inline bool any_long(const L (&values)[6], double limit) {
  bool above = false;
  for (const L& each : values) above |= any_above(magnitude(each), limit);
  return above;
}

/// Compute the residual of a solution: infinite where there is none, or another assembly of the machine may be found.
template <class L>
inline L residual_of(const rssr::SixLegs<L>& legs, const L& longest_turn, const L& least_squared) {
  const L nowhere = lanes_of<L>(std::numeric_limits<double>::infinity());
  L residual_mm = {};
  for (const L& each : legs.too_long) residual_mm = magnitude(each) > residual_mm ? magnitude(each) : residual_mm;
  residual_mm = longest_turn < kNeighbourTurn * kNeighbourTurn ? residual_mm : nowhere;
  return least_squared > kSingular ? residual_mm : nowhere;
}

template <class L>
inline void solve_lanes_six(const NominalGeometry& nominal, Block& block, Eigen::Index row, bool want_sensitivity) {
  Vec<L> base[6], joint[6];
  L length[6];
  for (int k = 0; k < kLegs; ++k) {
    base[k] = load_base<L>(nominal, block, row, k);
    length[k] = load_length<L>(nominal, block, row, k);
    joint[k] = load_platform_joint<L>(nominal, block, row, k);
  }
  rssr::PlacedPlatform<L> platform = load_pose<L>(block, row);
  rssr::SixLegs<L> legs = rssr::six_legs(base, length, joint, platform);
  rssr::Wrenches<L> wrenches = rssr::factor(legs.column);
  L longest_turn = {};  // squared
  for (int step = 0; step < kMaxSteps && any_long(legs.too_long, kResidualTolerance_mm); ++step) {
    const rssr::Six<L> by = wrenches.movement(legs.too_long);
    rssr::move_back(by, platform);
    const L turn = rssr::dot(by.moment, by.moment) * (1.0 / (rssr::kLever_mm * rssr::kLever_mm));
    longest_turn = turn > longest_turn ? turn : longest_turn;
    legs = rssr::six_legs(base, length, joint, platform);
    wrenches = rssr::factor(legs.column);
  }
  store_pose(platform, block, row);
  const LanesBar<L> bar = read_bar(platform, block, row);
  store(bar.reading_mm, &block.reading_mm(row));
  L residual_mm = residual_of(legs, longest_turn, wrenches.least_squared);
  if (want_sensitivity) {
    L share[6];
    wrenches.forces(rssr::wrench(bar.direction, platform.turned(bar.ball)), share);
    for (int k = 0; k < kLegs; ++k) share[k] *= legs.inverse[k];
    store_sensitivity(nominal, legs.leg, share, length, platform, bar.direction, block, row);
    residual_mm += 0.0 * (share[0] + bar.direction.x);
  }
  // Where the shared joints had no solution, neither has this row.
  const L before = load<L>(&block.residual_mm(row));
  store(before <= kResidualTolerance_mm ? residual_mm : before, &block.residual_mm(row));
}

template <class L>
inline void solve_block_six_in(const NominalGeometry& nominal, Block& block, Eigen::Index rows, bool want_sensitivity) {
  for (Eigen::Index row = 0; row < rows; row += kLanesIn<L>) solve_lanes_six<L>(nominal, block, row, want_sensitivity);
}

}  // namespace

HEXDBB_BY_LANES(solve_block_six,
                (const NominalGeometry& nominal, Block& block, Eigen::Index rows, bool want_sensitivity),
                (nominal, block, rows, want_sensitivity))

}  // namespace hexdbb
