// Runs a model over samples block by block: effects push, the block is solved, rows without a solution from their start
// are solved again one by one. Angles of an earlier run are kept as the start of the next: between two iterations of a
// fit they hardly change.
#pragma once

#include <vector>

#include "affine_part.hpp"
#include "block.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// Angles of every sample, one block after another, as last solved.
struct AngleMemory {
  std::vector<Block::Angles> blocks;
};

/// Throw std::invalid_argument where samples lack what an effect of a model needs.
void require_columns(const Model& model, const Samples& samples);

class BlockSolver {
 public:
  /// Both must outlive the solver, and the samples have what the effects require; `memory`, where given, is read and
  /// written for the blocks visited.
  BlockSolver(const Model& model, const Samples& samples, AngleMemory* memory);

  /// The same without a memory. Throws std::invalid_argument where samples lack what an effect needs.
  BlockSolver(const Model& model, const Samples& samples);

  /// Call visit(SampleBlock, Block) for rows [first, last) in order; `first` is a multiple of Block::kRows.
  template <class Visit>
  void each_block(Eigen::Index first, Eigen::Index last, bool want_sensitivity, Visit visit) {
    bool fresh = true;
    for (Eigen::Index at = first; at < last; at += Block::kRows) {
      const SampleBlock rows{samples_, at, std::min(Block::kRows, last - at)};
      solve(rows, want_sensitivity, fresh);
      fresh = false;
      visit(rows, static_cast<const Block&>(*block_));
    }
  }

  /// Apply the chain rule to the block visited for every term of the model: columns of `jacobian`, one per value, of
  /// which the first rows are written.
  void chain(const SampleBlock& rows, JacobianBlock jacobian) const;

  /// The same for the terms that are not affine; those columns of `jacobian` alone are written.
  void chain_others(const SampleBlock& rows, JacobianBlock jacobian) const;

  const AffinePart& affine() const { return affine_; }

  /// Return the first row without a solution of the block visited, or -1.
  Eigen::Index first_failure() const { return first_failure_; }

 private:
  void solve(const SampleBlock& rows, bool want_sensitivity, bool fresh);
  void load(const SampleBlock& rows);
  void load_set_ups(const SampleBlock& rows);
  Block::Angles& angles_of(const SampleBlock& rows);
  Start start(Block::Angles& angles, bool fresh);
  bool start_from_home(Block::Angles& angles, Eigen::Index count) const;
  void solve_row(const SampleBlock& rows, Eigen::Index row, Block::Angles& kept, bool want_sensitivity);

  const Model& model_;
  const Samples& samples_;
  AffinePart affine_;
  bool has_fixed_joints_;   // the platform's joints are the same in all rows
  int loaded_set_up_ = -1;  // that of all rows of the block; -1: unknown, or several
  AngleMemory* memory_;
  std::unique_ptr<Block> block_;
  Block::Angles own_angles_;         // of the block, where there is no memory
  RssrAngles last_;                  // of the sample before the block
  Eigen::Index first_failure_ = -1;  // of the block
};

/// Return the status of a row after solve: a residual below the tolerance is a solution, otherwise it holds the number
/// of the status, negative.
Status status_of(const Block& block, Eigen::Index row);

}  // namespace hexdbb
