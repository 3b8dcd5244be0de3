// A block of samples laid out for vector instructions: every quantity a column of kRows numbers side by side. It holds
// what the effects push, the solution's start and end, and what comes out; all of it stays in a core's caches.
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

  Table<kLegs> sliders_mm;
  Table<3> cup_mm;
  Table<3> ball_mm;
  Table<1> bar_length_mm;
  Table<port::kCount> ports;
  Table<6> angles;  // cosines and sines of theta, delta, phi: start, then solution

  Table<12> pose;  // x, y, z, then the rotation row by row
  Table<1> reading_mm;
  Table<1> residual_mm;  // of the loops; not a number where the legs do not meet
  Table<port::kCount> sensitivity;
};

/// Where each eight rows start from: the angles in the block, or the last row of the eight before them.
enum class Start { kAngles, kNeighbour };

/// Solve rows [0, rows) of a block, eight at a time; rows are rounded up to whole lanes, so the caller repeats its last
/// row. The platform's joints are taken for shared: those of the first leg of each pair count. Rows whose residual is
/// not below the tolerance have no solution from their start.
void solve_block(const NominalGeometry& nominal, Block& block, Eigen::Index rows, Start start,
                 bool want_sensitivity) noexcept;

/// The same where legs that end together in the nominal machine have joints of their own. Rows [0, rows) hold what
/// solve_block found for the first leg's joint of each pair; from there six coordinates of the platform are searched.
void solve_block_six(const NominalGeometry& nominal, Block& block, Eigen::Index rows, bool want_sensitivity) noexcept;

/// information += J'J (lower triangle), gradient += J'r for `rows` rows of a table of kRows rows and `columns` columns.
void accumulate(const double* jacobian, const double* residual, Eigen::Index rows, Eigen::Index columns,
                double* information, double* gradient) noexcept;

}  // namespace hexdbb
