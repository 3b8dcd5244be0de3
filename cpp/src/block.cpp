#include "block.hpp"

#include <limits>

#include "block_lanes.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

constexpr int kMaxSteps = 12;  // neighbours need 3; lanes that need more are left to the single-pose solver

inline rssr::Joints<Lanes> load_joints(const NominalGeometry& nominal, const Block& block, Eigen::Index row) {
  rssr::Joints<Lanes> out;
  for (int k = 0; k < kLegs; ++k) {
    out.base[k] = load_base(nominal, block, row, k);
    out.length[k] = load_length(nominal, block, row, k);
  }
  for (int i = 0; i < kGuideways; ++i) out.platform[i] = load_platform_joint(nominal, block, row, 2 * i);
  return out;
}

/// Newton on all lanes until the worst of them is solved; a solved lane's further steps do not move it. NaN compares
/// false, so lanes without a solution do not delay the others. A lane whose last determinant is not negative, or that
/// took too long a step, may have reached another assembly of the machine (see kinematics.cpp): its residual becomes
/// infinite.
inline rssr::Loops<Lanes> solve_loops(const rssr::Joints<Lanes>& joints, const rssr::TriangleFrame<Lanes>& frame,
                                      Lanes (&c)[3], Lanes (&s)[3], Lanes& residual_mm) {
  rssr::Circle<Lanes> circle[3];
  for (int i = 0; i < 3; ++i) {
    circle[i] = rssr::meeting_circle(joints.base[2 * i], joints.base[2 * i + 1], joints.length[2 * i],
                                     joints.length[2 * i + 1]);
  }
  const Lanes mm_per_f = 0.5 / root(frame.side_squared[0]);
  Lanes determinant = {}, longest = {};
  for (int steps = 0;; ++steps) {
    const rssr::Loops<Lanes> loops = rssr::close_loops(circle, c, s, frame.side_squared);
    residual_mm = mm_per_f * (magnitude(loops.f[0]) + magnitude(loops.f[1]) + magnitude(loops.f[2]));
    if (steps == kMaxSteps || (steps > 0 && !any_above(residual_mm, kResidualTolerance_mm))) {
      const Lanes nowhere = lanes_of(std::numeric_limits<double>::infinity());
      residual_mm = determinant < 0.0 ? residual_mm : nowhere;
      residual_mm = longest < kLargestTurn ? residual_mm : nowhere;
      return loops;
    }
    const rssr::LoopJacobian<Lanes> jacobian = rssr::loop_jacobian(circle, c, s, loops);
    determinant = jacobian.determinant;
    Lanes step[3], stretch[3], most = {};  // stretch: of cosine and sine by the turn, squared, beyond one
    rssr::cramer_step(loops, jacobian, step);
    for (int i = 0; i < 3; ++i) {
      longest = magnitude(step[i]) > longest ? magnitude(step[i]) : longest;
      stretch[i] = (step[i] * step[i] + 1.0) * (c[i] * c[i] + s[i] * s[i]) - 1.0;
      most = magnitude(stretch[i]) > most ? magnitude(stretch[i]) : most;
    }
    const bool is_near = !any_above(most, rssr::kNearOne);  // as from the angles of a fit's last pass
    for (int i = 0; i < 3; ++i) {
      const Lanes scale = is_near ? rssr::inverse_root_near_one(stretch[i]) : 1.0 / root(1.0 + stretch[i]);
      rssr::turn_by(step[i], scale, c[i], s[i]);
    }
  }
}

inline void solve_lanes(const NominalGeometry& nominal, Block& block, Block::Angles& angles, Eigen::Index row,
                        bool want_sensitivity) {
  const rssr::Joints<Lanes> joints = load_joints(nominal, block, row);
  const rssr::TriangleFrame<Lanes> frame = rssr::triangle_frame(joints.platform);
  Lanes c[3], s[3], residual_mm;
  for (int i = 0; i < 3; ++i) {
    c[i] = load(&angles(row, i));
    s[i] = load(&angles(row, 3 + i));
  }
  const rssr::Loops<Lanes> loops = solve_loops(joints, frame, c, s, residual_mm);
  for (int i = 0; i < 3; ++i) {
    store(c[i], &angles(row, i));
    store(s[i], &angles(row, 3 + i));
  }
  const rssr::PlacedPlatform<Lanes> platform = rssr::align(loops.q, frame, joints.platform[0]);
  store_pose(platform, block, row);

  const LanesBar bar = read_bar(platform, block, row);
  store(bar.reading_mm, &block.reading_mm(row));
  if (want_sensitivity) {
    const Vec<Lanes> n = bar.direction;
    const rssr::LegForces<Lanes> forces = rssr::leg_forces(joints, frame, platform, bar.ball, n);
    store_sensitivity(nominal, forces.leg, forces.share, joints.length, platform, n, block, row);
    // A singular pose or a bar of zero length has no sensitivity: its numbers are not finite, nor is its residual then.
    residual_mm += 0.0 * (forces.share[0] + n.x);
  }
  store(residual_mm, &block.residual_mm(row));
}

/// Let eight rows start where the two eights before them lead in a straight line; after a jump, from the last row.
inline void start_from_before(Block::Angles& angles, Eigen::Index row) {
  Lanes next[6], furthest = {};
  for (int i = 0; i < 6 && row >= 2 * kLanes; ++i) {
    const Lanes last = load(&angles(row - kLanes, i)), moved = last - load(&angles(row - 2 * kLanes, i));
    next[i] = last + moved;
    furthest = magnitude(moved) > furthest ? magnitude(moved) : furthest;
  }
  const bool is_smooth = row >= 2 * kLanes && !any_above(furthest, kLargestTurn);
  for (int i = 0; i < 6; ++i) store(is_smooth ? next[i] : lanes_of(angles(row - 1, i)), &angles(row, i));
}

/// Interleave numbers of two rows of lanes as the masks say, and add.
template <class Mask>
inline Lanes folded(const Lanes& a, const Lanes& b, const Mask& first, const Mask& second) {
  return __builtin_shuffle(a, b, first) + __builtin_shuffle(a, b, second);
}

/// Return the sums of eight rows of lanes.
inline Lanes sums_of(const Lanes (&row)[8]) {
  typedef long long Order __attribute__((vector_size(sizeof(Lanes))));
  Lanes pair[4], four[2];
  for (int i = 0; i < 4; ++i) {
    pair[i] = folded(row[2 * i], row[2 * i + 1], Order{0, 8, 2, 10, 4, 12, 6, 14}, Order{1, 9, 3, 11, 5, 13, 7, 15});
  }
  for (int i = 0; i < 2; ++i) {
    four[i] = folded(pair[2 * i], pair[2 * i + 1], Order{0, 1, 8, 9, 4, 5, 12, 13}, Order{2, 3, 10, 11, 6, 7, 14, 15});
  }
  return folded(four[0], four[1], Order{0, 1, 2, 3, 8, 9, 10, 11}, Order{4, 5, 6, 7, 12, 13, 14, 15});
}

/// Accumulate columns i, i+1 against j .. j+3: eight running sums stay in registers.
inline void add_tile(const JacobianRows& a, Eigen::Index i, Eigen::Index j, double* information) {
  Lanes sum[8] = {};  // of (i, j), (i + 1, j), (i, j + 1), ...
  const double *one = a.data + i * a.stride, *four = a.data + j * a.stride;
  for (Eigen::Index row = 0; row < a.rows; row += kLanes) {
    const Lanes first = load(one + row), second = load(one + a.stride + row);
    for (int t = 0; t < 4; ++t) {
      const Lanes other = load(four + t * a.stride + row);
      sum[2 * t] += first * other;
      sum[2 * t + 1] += second * other;
    }
  }
  const Lanes total = sums_of(sum);
  for (int t = 0; t < 4; ++t) {
    information[(j + t) * a.columns + i] += total[2 * t];
    information[(j + t) * a.columns + i + 1] += total[2 * t + 1];
  }
}

}  // namespace

HEXDBB_MULTIVERSION_WIDE
void solve_block(const NominalGeometry& nominal, Block& block, Block::Angles& angles, Eigen::Index rows, Start start,
                 bool want_sensitivity) noexcept {
  for (Eigen::Index row = 0; row < rows; row += kLanes) {
    if (start == Start::kNeighbour && row > 0 && block.residual_mm(row - 1) <= kResidualTolerance_mm) {
      start_from_before(angles, row);
    }
    solve_lanes(nominal, block, angles, row, want_sensitivity);
  }
}

// The columns are a multiple of 4, so that tiles cover the lower triangle; entries above the diagonal are not read.
HEXDBB_MULTIVERSION_WIDE
void add_information(const JacobianRows& jacobian, double* information) noexcept {
  for (Eigen::Index j = 0; j < jacobian.columns; j += 4) {
    for (Eigen::Index i = j; i < jacobian.columns; i += 2) add_tile(jacobian, i, j, information);
  }
}

HEXDBB_MULTIVERSION_WIDE
void add_gradient(const JacobianRows& jacobian, const double* residual, double* gradient) noexcept {
  for (Eigen::Index i = 0; i < jacobian.columns; ++i) {
    const double* column = jacobian.data + i * jacobian.stride;
    Lanes sum = {};
    for (Eigen::Index row = 0; row < jacobian.rows; row += kLanes) sum += load(column + row) * load(residual + row);
    for (int lane = 0; lane < kLanes; ++lane) gradient[i] += sum[lane];
  }
}

}  // namespace hexdbb
