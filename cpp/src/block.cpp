#include "block.hpp"

#include <limits>

#include "multiversion.hpp"
#include "sample_kernel.hpp"

namespace hexdbb {

namespace {

using rssr::Vec;

constexpr int kMaxSteps = 12;          // lanes that need more are left to the single-pose solver
constexpr double kLargestTurn = 0.05;  // a longer one means that the start was no neighbour

/// Columns `first`, `first` + 1, `first` + 2 of a table as a vector of lanes.
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

inline rssr::Joints<Lanes> load_joints(const NominalGeometry& nominal, const Block& block, Eigen::Index row) {
  rssr::Joints<Lanes> out;
  for (int k = 0; k < kLegs; ++k) {
    const Lanes along = load(&block.sliders_mm(row, k)) + load(&block.ports(row, port::kSlider + k));
    out.base[k] = constant3(nominal.vertex, k) + along * constant3(nominal.direction, k) +
                  load3(block.ports, row, port::kSliderJoint + 3 * k);
    out.length[k] = nominal.machine.leg_length_mm + load(&block.ports(row, port::kLeg + k));
  }
  for (int i = 0; i < kGuideways; ++i) {
    out.platform[i] = constant3(nominal.platform_joint, 2 * i) + load3(block.ports, row, port::kPlatformJoint + 6 * i);
  }
  return out;
}

inline Lanes magnitude(const Lanes& v) { return v < 0.0 ? -v : v; }
inline bool any_above(const Lanes& v, double limit) {
  bool above = false;
  for (int lane = 0; lane < kLanes; ++lane) above |= v[lane] > limit;
  return above;
}

/// Newton on all lanes until the worst of them is solved; a solved lane's further steps do not move it. Not a number
/// compares false, so lanes without a solution do not hold the others up. A lane whose last determinant is not
/// negative, or that took too long a step, may have come to another way to assemble the machine (see kinematics.cpp):
/// its residual becomes infinite.
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
    Lanes step[3];
    rssr::cramer_step(loops, jacobian, step);
    for (int i = 0; i < 3; ++i) {
      const Lanes t = step[i];
      longest = magnitude(t) > longest ? magnitude(t) : longest;
      rssr::turn_by(t, 1.0 / root((t * t + 1.0) * (c[i] * c[i] + s[i] * s[i])), c[i], s[i]);
    }
  }
}

inline void store_sensitivity(const NominalGeometry& nominal, const rssr::LegForces<Lanes>& forces,
                              const rssr::Joints<Lanes>& joints, const rssr::PlacedPlatform<Lanes>& platform,
                              const Vec<Lanes>& n, Block& block, Eigen::Index row) {
  auto& out = block.sensitivity;
  for (int k = 0; k < kLegs; ++k) {
    const Vec<Lanes> force = forces.share[k] * forces.leg[k];
    store(rssr::dot(force, constant3(nominal.direction, k)), &out(row, port::kSlider + k));
    store(forces.share[k] * joints.length[k], &out(row, port::kLeg + k));
    store3(force, out, row, port::kSliderJoint + 3 * k);
    const Vec<Lanes> back = platform.turned_back(force);
    store3(Vec<Lanes>{-back.x, -back.y, -back.z}, out, row, port::kPlatformJoint + 3 * k);
  }
  store3(platform.turned_back(n), out, row, port::kBall);
  store3(Vec<Lanes>{-n.x, -n.y, -n.z}, out, row, port::kCup);
  store(lanes_of(1.0), &out(row, port::kReading));
}

inline void store_pose(const rssr::PlacedPlatform<Lanes>& platform, Block& block, Eigen::Index row) {
  store3(platform.position, block.pose, row, 0);
  for (int j = 0; j < 3; ++j) {
    store(platform.column[j].x, &block.pose(row, 3 + j));
    store(platform.column[j].y, &block.pose(row, 6 + j));
    store(platform.column[j].z, &block.pose(row, 9 + j));
  }
}

inline void solve_lanes(const NominalGeometry& nominal, Block& block, Eigen::Index row, bool want_sensitivity) {
  const rssr::Joints<Lanes> joints = load_joints(nominal, block, row);
  const rssr::TriangleFrame<Lanes> frame = rssr::triangle_frame(joints.platform);
  Lanes c[3], s[3], residual_mm;
  for (int i = 0; i < 3; ++i) {
    c[i] = load(&block.angles(row, i));
    s[i] = load(&block.angles(row, 3 + i));
  }
  const rssr::Loops<Lanes> loops = solve_loops(joints, frame, c, s, residual_mm);
  for (int i = 0; i < 3; ++i) {
    store(c[i], &block.angles(row, i));
    store(s[i], &block.angles(row, 3 + i));
  }
  const rssr::PlacedPlatform<Lanes> platform = rssr::align(loops.q, frame, joints.platform[0]);
  store_pose(platform, block, row);

  const Vec<Lanes> ball = load3(block.ball_mm, row, 0) + load3(block.ports, row, port::kBall);
  const Vec<Lanes> bar =
      platform.position + platform.turned(ball) - load3(block.cup_mm, row, 0) - load3(block.ports, row, port::kCup);
  const Lanes length = root(rssr::dot(bar, bar));
  store(length - load(&block.bar_length_mm(row)) + load(&block.ports(row, port::kReading)), &block.reading_mm(row));
  if (want_sensitivity) {
    const Vec<Lanes> n = (1.0 / length) * bar;
    const rssr::LegForces<Lanes> forces = rssr::leg_forces(joints, frame, platform, ball, n);
    store_sensitivity(nominal, forces, joints, platform, n, block, row);
    // A singular pose or a bar of no length has no sensitivity: its numbers are not finite, and neither is its residual
    // then.
    residual_mm += 0.0 * (forces.share[0] + n.x);
  }
  store(residual_mm, &block.residual_mm(row));
}

/// Columns i, i+1 against j .. j+3: eight running sums stay in registers.
inline void add_tile(const double* a, Eigen::Index rows, Eigen::Index i, Eigen::Index j, Eigen::Index columns,
                     double* information) {
  Lanes sum[2][4] = {};
  for (Eigen::Index row = 0; row < rows; row += kLanes) {
    const Lanes first = load(a + i * Block::kRows + row), second = load(a + (i + 1) * Block::kRows + row);
    for (int t = 0; t < 4; ++t) {
      const Lanes other = load(a + (j + t) * Block::kRows + row);
      sum[0][t] += first * other;
      sum[1][t] += second * other;
    }
  }
  for (int u = 0; u < 2; ++u) {
    for (int t = 0; t < 4; ++t) {
      double total = 0.0;
      for (int lane = 0; lane < kLanes; ++lane) total += sum[u][t][lane];
      information[(j + t) * columns + i + u] += total;
    }
  }
}

}  // namespace

HEXDBB_MULTIVERSION_WIDE
void solve_block(const NominalGeometry& nominal, Block& block, Eigen::Index rows, Start start,
                 bool want_sensitivity) noexcept {
  for (Eigen::Index row = 0; row < rows; row += kLanes) {
    if (start == Start::kNeighbour && row > 0 && block.residual_mm(row - 1) <= kResidualTolerance_mm) {
      for (int i = 0; i < 6; ++i) store(lanes_of(block.angles(row - 1, i)), &block.angles(row, i));
    }
    solve_lanes(nominal, block, row, want_sensitivity);
  }
}

// `columns` is a multiple of 4, so that tiles cover the lower triangle; what they add above the diagonal is not read.
HEXDBB_MULTIVERSION_WIDE
void accumulate(const double* jacobian, const double* residual, Eigen::Index rows, Eigen::Index columns,
                double* information, double* gradient) noexcept {
  for (Eigen::Index j = 0; j < columns; j += 4) {
    for (Eigen::Index i = j; i < columns; i += 2) add_tile(jacobian, rows, i, j, columns, information);
  }
  for (Eigen::Index i = 0; i < columns; ++i) {
    Lanes sum = {};
    for (Eigen::Index row = 0; row < rows; row += kLanes) {
      sum += load(jacobian + i * Block::kRows + row) * load(residual + row);
    }
    for (int lane = 0; lane < kLanes; ++lane) gradient[i] += sum[lane];
  }
}

}  // namespace hexdbb
