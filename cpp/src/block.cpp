#include "block.hpp"

#include <limits>

#include "block_lanes.hpp"
#include "largest_turns.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

constexpr int kMaxSteps = 12;  // neighbours need 3; lanes that need more are left to the single-pose solver

template <class L>
inline rssr::Joints<L> load_joints(const NominalGeometry& nominal, const Block& block, Eigen::Index row) {
  rssr::Joints<L> out;
  for (int k = 0; k < kLegs; ++k) {
    out.base[k] = load_base<L>(nominal, block, row, k);
    out.length[k] = load_length<L>(nominal, block, row, k);
  }
  for (int i = 0; i < kGuideways; ++i) out.platform[i] = load_platform_joint<L>(nominal, block, row, 2 * i);
  return out;
}

/// Newton on all lanes until the worst of them is solved; a solved lane's further steps do not move it. NaN compares
/// false, so lanes without a solution do not delay the others. A lane with a determinant that is not negative, or that
/// took a step as long as `largest_turn`, may have reached another assembly of the machine (see kinematics.cpp): its
/// residual becomes infinite.
template <class L>
inline rssr::Loops<L> solve_loops(const rssr::Joints<L>& joints, const rssr::TriangleFrame<L>& frame,
                                  double largest_turn, L (&c)[3], L (&s)[3], L& residual_mm) {
  rssr::Circle<L> circle[3];
  for (int i = 0; i < 3; ++i) {
    circle[i] = rssr::meeting_circle(joints.base[2 * i], joints.base[2 * i + 1], joints.length[2 * i],
                                     joints.length[2 * i + 1]);
  }
  const L mm_per_f = 0.5 / root(frame.side_squared[0]);
  L highest = lanes_of<L>(-std::numeric_limits<double>::infinity()), longest = {};  // highest determinant
  for (int steps = 0;; ++steps) {
    const rssr::Loops<L> loops = rssr::close_loops(circle, c, s, frame.side_squared);
    residual_mm = mm_per_f * (magnitude(loops.f[0]) + magnitude(loops.f[1]) + magnitude(loops.f[2]));
    if (steps == kMaxSteps || (steps > 0 && !any_above(residual_mm, kResidualTolerance_mm))) {
      const L nowhere = lanes_of<L>(std::numeric_limits<double>::infinity());
      residual_mm = highest < 0.0 ? residual_mm : nowhere;
      residual_mm = longest < largest_turn ? residual_mm : nowhere;
      return loops;
    }
    const rssr::LoopJacobian<L> jacobian = rssr::loop_jacobian(circle, c, s, loops);
    highest = jacobian.determinant < highest ? highest : jacobian.determinant;
    L step[3], stretch[3], most = {};  // stretch: of cosine and sine by the turn, squared, beyond one
    rssr::cramer_step(loops, jacobian, step);
    for (int i = 0; i < 3; ++i) {
      longest = magnitude(step[i]) > longest ? magnitude(step[i]) : longest;
      stretch[i] = (step[i] * step[i] + 1.0) * (c[i] * c[i] + s[i] * s[i]) - 1.0;
      most = magnitude(stretch[i]) > most ? magnitude(stretch[i]) : most;
    }
    const bool is_near = !any_above(most, rssr::kNearOne);  // as from the angles of a fit's last pass
    for (int i = 0; i < 3; ++i) {
      const L scale = is_near ? rssr::inverse_root_near_one(stretch[i]) : 1.0 / root(1.0 + stretch[i]);
      rssr::turn_by(step[i], scale, c[i], s[i]);
    }
  }
}

template <class L>
inline void solve_lanes(const NominalGeometry& nominal, Block& block, Block::Angles& angles, Eigen::Index row,
                        double largest_turn, bool want_sensitivity) {
  const rssr::Joints<L> joints = load_joints<L>(nominal, block, row);
  const rssr::TriangleFrame<L> frame = rssr::triangle_frame(joints.platform);
  L c[3], s[3], residual_mm;
  for (int i = 0; i < 3; ++i) {
    c[i] = load<L>(&angles(row, i));
    s[i] = load<L>(&angles(row, 3 + i));
  }
  const rssr::Loops<L> loops = solve_loops(joints, frame, largest_turn, c, s, residual_mm);
  for (int i = 0; i < 3; ++i) {
    store(c[i], &angles(row, i));
    store(s[i], &angles(row, 3 + i));
  }
  const rssr::PlacedPlatform<L> platform = rssr::align(loops.q, frame, joints.platform[0]);
  store_pose(platform, block, row);

  const LanesBar<L> bar = read_bar(platform, block, row);
  store(bar.reading_mm, &block.reading_mm(row));
  if (want_sensitivity) {
    const Vec<L> n = bar.direction;
    const rssr::LegForces<L> forces = rssr::leg_forces(joints, frame, platform, bar.ball, n);
    store_sensitivity(nominal, forces.leg, forces.share, joints.length, platform, n, block, row);
    // A singular pose or a bar of zero length has no sensitivity: its numbers are not finite, nor is its residual then.
    residual_mm += 0.0 * (forces.share[0] + n.x);
  }
  store(residual_mm, &block.residual_mm(row));
}

/// Let rows of lanes start where the two rows of lanes before them lead in a straight line; after a jump, from the last row.
template <class L>
inline void start_from_before(Block::Angles& angles, Eigen::Index row) {
  L next[6], furthest = {};
  for (int i = 0; i < 6 && row >= 2 * kLanesIn<L>; ++i) {
    const L last = load<L>(&angles(row - kLanesIn<L>, i)), moved = last - load<L>(&angles(row - 2 * kLanesIn<L>, i));
    next[i] = last + moved;
    furthest = magnitude(moved) > furthest ? magnitude(moved) : furthest;
  }
  const bool is_smooth = row >= 2 * kLanesIn<L> && !any_above(furthest, kNeighbourTurn);
  for (int i = 0; i < 6; ++i) store(is_smooth ? next[i] : lanes_of<L>(angles(row - 1, i)), &angles(row, i));
}

/// Check whether a row of lanes has its solutions.
template <class L>
inline bool are_solved(const Block& block, Eigen::Index row) {
  return (block.residual_mm.segment<kLanesIn<L>>(row).array() <= kResidualTolerance_mm).all();
}

/// Interleave numbers of two rows of lanes as the masks say, and add.
template <class L, class Mask>
inline L folded(const L& a, const L& b, const Mask& first, const Mask& second) {
  return __builtin_shuffle(a, b, first) + __builtin_shuffle(a, b, second);
}

/// Compute the sums of eight rows of lanes.
template <class L>
inline void sums_of(const L (&row)[8], double (&out)[8]) {
  using Order = typename OrderOf<L>::Type;
  if constexpr (kLanesIn<L> == 2) {
    for (int i = 0; i < 4; ++i) store(folded(row[2 * i], row[2 * i + 1], Order{0, 2}, Order{1, 3}), out + 2 * i);
  } else if constexpr (kLanesIn<L> == 4) {
    L pair[4];
    for (int i = 0; i < 4; ++i) pair[i] = folded(row[2 * i], row[2 * i + 1], Order{0, 4, 2, 6}, Order{1, 5, 3, 7});
    for (int i = 0; i < 2; ++i) {
      store(folded(pair[2 * i], pair[2 * i + 1], Order{0, 1, 4, 5}, Order{2, 3, 6, 7}), out + 4 * i);
    }
  } else {
    L pair[4], four[2];
    for (int i = 0; i < 4; ++i) {
      pair[i] = folded(row[2 * i], row[2 * i + 1], Order{0, 8, 2, 10, 4, 12, 6, 14}, Order{1, 9, 3, 11, 5, 13, 7, 15});
    }
    for (int i = 0; i < 2; ++i) {
      four[i] =
          folded(pair[2 * i], pair[2 * i + 1], Order{0, 1, 8, 9, 4, 5, 12, 13}, Order{2, 3, 10, 11, 6, 7, 14, 15});
    }
    store(folded(four[0], four[1], Order{0, 1, 2, 3, 8, 9, 10, 11}, Order{4, 5, 6, 7, 12, 13, 14, 15}), out);
  }
}

/// Accumulate columns i, i+1 against j .. j+3: eight running sums stay in registers.
template <class L>
inline void add_tile(const JacobianRows& a, Eigen::Index i, Eigen::Index j, double* information) {
  L sum[8] = {};  // of (i, j), (i + 1, j), (i, j + 1), ...
  const double *one = a.data + i * a.stride, *four = a.data + j * a.stride;
  for (Eigen::Index row = 0; row < a.rows; row += kLanesIn<L>) {
    const L first = load<L>(one + row), second = load<L>(one + a.stride + row);
    for (int t = 0; t < 4; ++t) {
      const L other = load<L>(four + t * a.stride + row);
      sum[2 * t] += first * other;
      sum[2 * t + 1] += second * other;
    }
  }
  double total[8];
  sums_of(sum, total);
  for (int t = 0; t < 4; ++t) {
    information[(j + t) * a.columns + i] += total[2 * t];
    information[(j + t) * a.columns + i + 1] += total[2 * t + 1];
  }
}

template <class L>
inline void solve_block_in(const NominalGeometry& nominal, Block& block, Block::Angles& angles, Eigen::Index rows,
                           Start start, bool want_sensitivity) {
  const double largest_turn = start == Start::kHome ? kHomeTurn : kNeighbourTurn;
  for (Eigen::Index row = 0; row < rows; row += kLanesIn<L>) {
    if (start == Start::kHome && are_solved<L>(block, row)) continue;
    if (start == Start::kNeighbour && row > 0 && block.residual_mm(row - 1) <= kResidualTolerance_mm) {
      start_from_before<L>(angles, row);
    }
    solve_lanes<L>(nominal, block, angles, row, largest_turn, want_sensitivity);
  }
}

// The columns are a multiple of 4, so that tiles cover the lower triangle; entries above the diagonal are not read.
template <class L>
inline void add_information_in(const JacobianRows& jacobian, double* information) {
  for (Eigen::Index j = 0; j < jacobian.columns; j += 4) {
    for (Eigen::Index i = j; i < jacobian.columns; i += 2) add_tile<L>(jacobian, i, j, information);
  }
}

// Four columns at a time: their sums do not wait for each other.
template <class L>
inline void add_gradient_in(const JacobianRows& jacobian, const double* residual, double* gradient) {
  for (Eigen::Index i = 0; i < jacobian.columns; i += 4) {
    const double* const four = jacobian.data + i * jacobian.stride;
    L sum[4] = {};
    for (Eigen::Index row = 0; row < jacobian.rows; row += kLanesIn<L>) {
      const L left = load<L>(residual + row);
      for (int t = 0; t < 4; ++t) sum[t] += load<L>(four + t * jacobian.stride + row) * left;
    }
    for (int t = 0; t < 4; ++t) gradient[i + t] += sum_of(sum[t]);
  }
}

}  // namespace

HEXDBB_BY_LANES(solve_block,
                (const NominalGeometry& nominal, Block& block, Block::Angles& angles, Eigen::Index rows, Start start,
                 bool want_sensitivity),
                (nominal, block, angles, rows, start, want_sensitivity))

HEXDBB_BY_LANES(add_information, (const JacobianRows& jacobian, double* information), (jacobian, information))

HEXDBB_BY_LANES(add_gradient, (const JacobianRows& jacobian, const double* residual, double* gradient),
                (jacobian, residual, gradient))

}  // namespace hexdbb
