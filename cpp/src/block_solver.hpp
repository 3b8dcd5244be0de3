// Runs a model over samples block by block: effects push, the block is solved, what has no solution from its start is
// tried again one by one. Angles of an earlier run are kept as the next one's start: between two iterations of a fit
// they hardly move.
#pragma once

#include <vector>

#include "block.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// Angles of every sample, one block after another, as they were last solved.
struct AngleMemory {
  std::vector<Block::Table<6>> blocks;
};

class BlockSolver {
 public:
  /// Both must outlive the solver; `memory`, where given, is read and written for the blocks visited.
  BlockSolver(const Model& model, const Samples& samples, AngleMemory* memory = nullptr);

  /// visit(SampleBlock, Block) for rows [first, last) in order; `first` is a multiple of Block::kRows.
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

 private:
  void solve(const SampleBlock& rows, bool want_sensitivity, bool fresh);
  void load(const SampleBlock& rows);
  Start start(const SampleBlock& rows, bool fresh);
  void solve_row(const SampleBlock& rows, Eigen::Index row, bool want_sensitivity);

  const Model& model_;
  const Samples& samples_;
  AngleMemory* memory_;
  std::unique_ptr<Block> block_;
  RssrAngles last_;  // of the sample before the block
};

/// Status of a row after solve: a residual below the tolerance is a solution, else it holds the status' number,
/// negative.
Status status_of(const Block& block, Eigen::Index row);

/// Chain rule for every term of a model: columns of `jacobian`, one a value.
void chain(const Model& model, const SampleBlock& rows, const Block& block, Eigen::MatrixXd& jacobian);

}  // namespace hexdbb
