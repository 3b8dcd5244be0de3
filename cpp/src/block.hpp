// A block of samples laid out for vector instructions: every quantity is a column of kRows consecutive numbers. It
// holds the pushes of the effects, the start and end of the solution, and its results; all of it stays in a core's
// caches.
#pragma once

#include <memory>

#include "hexdbb/effect.hpp"
#include "lanes.hpp"

namespace hexdbb {

struct Block {
  static constexpr Eigen::Index kRows = 64;
  static_assert(kRows % kLanes == 0);

  template <int Columns>
  using Table = Eigen::Matrix<double, kRows, Columns>;
  using Angles = Table<6>;  // cosines and sines of theta, delta, phi

  Table<kLegs> sliders_mm;
  Table<3> cup_mm;
  Table<3> ball_mm;
  Table<1> bar_length_mm;
  Table<port::kCount> ports;

  Table<12> pose;  // x, y, z, then the rotation row by row
  Table<1> reading_mm;
  Table<1> residual_mm;  // of the loops; NaN where the legs do not meet
  Table<port::kCount> sensitivity;
};

/// The start of each eight rows: the angles given; the rows before them, of the first eight the angles given; or the
/// angles given, where some of them have no solution yet, with steps as long as those from the symmetric pose may be.
enum class Start { kAngles, kNeighbour, kHome };

/// Solve rows [0, rows) of a block, eight at a time; rows are rounded up to whole lanes, so the caller repeats its last
/// row. `angles` are the start, then the solution. The platform's joints are assumed shared: those of the first leg of
/// each pair count. Rows whose residual is not below the tolerance have no solution from their start.
void solve_block(const NominalGeometry& nominal, Block& block, Block::Angles& angles, Eigen::Index rows, Start start,
                 bool want_sensitivity) noexcept;

/// Solve the same where the legs of a pair have separate joints. Rows [0, rows) hold the solution of solve_block for
/// the first leg's joint of each pair; Newton on six pose coordinates starts there.
void solve_block_six(const NominalGeometry& nominal, Block& block, Eigen::Index rows, bool want_sensitivity) noexcept;

/// The first `rows` rows of a Jacobian, column by column, `stride` numbers from one column to the next; both are
/// multiples of kLanes, and `columns` is a multiple of 4.
struct JacobianRows {
  const double* data;
  Eigen::Index rows, stride, columns;
};

/// Add J'J (lower triangle) to `information`.
void add_information(const JacobianRows& jacobian, double* information) noexcept;

/// Add J'r to `gradient`.
void add_gradient(const JacobianRows& jacobian, const double* residual, double* gradient) noexcept;

}  // namespace hexdbb
