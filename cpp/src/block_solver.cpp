#include "block_solver.hpp"

#include <algorithm>
#include <cmath>

namespace hexdbb {

namespace {

bool is_solved(const Block& block, Eigen::Index row) {
  return block.residual_mm(row) >= 0.0 && block.residual_mm(row) <= kResidualTolerance_mm;
}

/// Return whether the legs of each pair have the same joint at the platform in the first `count` rows.
bool joints_are_shared(const Block& block, Eigen::Index count) {
  for (int i = 0; i < kGuideways; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const int column = port::kPlatformJoint + 6 * i + axis;
      if (block.ports.col(column).head(count) != block.ports.col(column + 3).head(count)) return false;
    }
  }
  return true;
}

void store_angles(const RssrAngles& angles, Block::Angles& out, Eigen::Index row) {
  out.row(row) << angles.cosine.transpose(), angles.sine.transpose();
}

RssrAngles angles_at(const Block::Angles& angles, Eigen::Index row) {
  RssrAngles out;
  out.cosine = angles.row(row).head<3>().transpose();
  out.sine = angles.row(row).tail<3>().transpose();
  return out;
}

}  // namespace

void require_columns(const Model& model, const Samples& samples) {
  for (const Term& term : model.terms) term.effect->require(samples);
}

BlockSolver::BlockSolver(const Model& model, const Samples& samples, AngleMemory* memory)
    : model_(model), samples_(samples), affine_(model), memory_(memory), block_(std::make_unique<Block>()) {
  has_fixed_joints_ = true;
  for (int port = port::kPlatformJoint; port < port::kBall; ++port) has_fixed_joints_ &= affine_.is_constant(port);
}

BlockSolver::BlockSolver(const Model& model, const Samples& samples) : BlockSolver(model, samples, nullptr) {
  require_columns(model, samples);
}

/// Load the nominal set-ups: neighbouring rows, and mostly neighbouring blocks, have the same.
void BlockSolver::load_set_ups(const SampleBlock& rows) {
  Block& block = *block_;
  const auto number = [&](Eigen::Index row) { return samples_.set_up[rows.first + std::min(row, rows.count - 1)]; };
  for (Eigen::Index row = 0, end = 0; row < Block::kRows; row = end) {
    while (end < Block::kRows && number(end) == number(row)) ++end;
    const bool is_whole = row == 0 && end == Block::kRows;
    if (is_whole && number(row) == loaded_set_up_) return;
    const SetUp& set_up = samples_.set_ups[number(row)];
    for (int axis = 0; axis < 3; ++axis) {
      block.cup_mm.col(axis).segment(row, end - row).setConstant(set_up.cup_mm[axis]);
      block.ball_mm.col(axis).segment(row, end - row).setConstant(set_up.ball_offset_mm[axis]);
    }
    block.bar_length_mm.segment(row, end - row).setConstant(set_up.bar_length_mm);
    loaded_set_up_ = is_whole ? number(row) : -1;
  }
}

void BlockSolver::load(const SampleBlock& rows) {
  Block& block = *block_;
  // Whole lanes are solved: rows beyond the last repeat it.
  for (int k = 0; k < kLegs; ++k) {
    block.sliders_mm.col(k).head(rows.count) = rows.slider_mm(k);
    block.sliders_mm.col(k).tail(Block::kRows - rows.count).setConstant(block.sliders_mm(rows.count - 1, k));
  }
  load_set_ups(rows);
  affine_.push(block);
  for (std::size_t term = 0; term < model_.terms.size(); ++term) {
    if (affine_.has(term)) continue;
    model_.terms[term].effect->push(rows, model_.terms[term].values, block.ports.topRows(rows.count));
  }
  for (Eigen::Index row = rows.count; row < Block::kRows; ++row) block.ports.row(row) = block.ports.row(rows.count - 1);
}

/// Return where a block's angles are kept.
Block::Angles& BlockSolver::angles_of(const SampleBlock& rows) {
  return memory_ != nullptr ? memory_->blocks[rows.first / Block::kRows] : own_angles_;
}

/// Make a block's angles a start, where memory has none.
Start BlockSolver::start(Block::Angles& angles, bool fresh) {
  const bool is_kept = memory_ != nullptr && (angles(0, 0) != 0.0 || angles(0, 3) != 0.0);
  if (is_kept) return Start::kAngles;
  if (fresh) last_ = RssrAngles();
  for (Eigen::Index row = 0; row < Block::kRows; ++row) store_angles(last_, angles, row);
  return Start::kNeighbour;
}

void BlockSolver::solve(const SampleBlock& rows, bool want_sensitivity, bool fresh) {
  Block& block = *block_;
  Block::Angles& angles = angles_of(rows);
  load(rows);
  const Start from = start(angles, fresh);
  const bool shared = joints_are_shared(block, has_fixed_joints_ ? 1 : rows.count);
  solve_block(model_.nominal, block, angles, rows.count, from, want_sensitivity && shared);
  if (start_from_home(angles, rows.count)) {
    solve_block(model_.nominal, block, angles, rows.count, Start::kHome, want_sensitivity && shared);
  }
  if (!shared) solve_block_six(model_.nominal, block, rows.count, want_sensitivity);
  first_failure_ = -1;
  for (Eigen::Index row = 0; row < rows.count; ++row) {
    if (is_solved(block, row)) continue;
    store_angles(RssrAngles(), angles, row);  // the lanes' own angles did not converge
    solve_row(rows, row, angles, want_sensitivity);
    if (first_failure_ < 0 && !is_solved(block, row)) first_failure_ = row;
  }
  last_ = angles_at(angles, rows.count - 1);
}

/// Let the first `count` rows that have no solution from their start, as after a jump to another circle, start from the
/// symmetric pose. Return whether there are any.
bool BlockSolver::start_from_home(Block::Angles& angles, Eigen::Index count) const {
  const auto residual_mm = block_->residual_mm.head(count).array();
  if ((residual_mm <= kResidualTolerance_mm).all()) return false;
  for (Eigen::Index row = 0; row < Block::kRows; ++row) {
    if (row >= count || !is_solved(*block_, row)) store_angles(RssrAngles(), angles, row);
  }
  return true;
}

/// Solve one row by the single-pose functions, from the angles kept: the RSSR loops, then six coordinates where
/// joints are not shared.
void BlockSolver::solve_row(const SampleBlock& rows, Eigen::Index row, Block::Angles& kept, bool want_sensitivity) {
  Block& block = *block_;
  Ports push;
  push.value = block.ports.row(row).transpose();
  const Mechanism mechanism = assemble(model_.nominal, block.sliders_mm.row(row).transpose(), push);
  const bool shared = hexdbb::joints_are_shared(mechanism);
  const PlatformTriangle triangle(shared_joints(mechanism));
  RssrAngles angles = angles_at(kept, row);
  ForwardResult result = forward(mechanism, triangle, angles);
  if (result.status == Status::kOk && !shared) result = forward_six(mechanism, result.pose);
  const SetUp& set_up = samples_.set_ups[samples_.set_up[rows.first + row]];
  Ports answer;
  if (result.status == Status::kOk && want_sensitivity) {
    const bool regular =
        shared ? reading_sensitivity(model_.nominal, mechanism, triangle, result.pose, set_up, push, answer)
               : reading_sensitivity_six(model_.nominal, mechanism, result.pose, set_up, push, answer);
    if (!regular) result.status = Status::kSingular;
  }
  store_angles(angles, kept, row);
  block.pose.row(row).head<3>() = result.pose.position.transpose();
  for (int i = 0; i < 3; ++i) block.pose.row(row).segment<3>(3 + 3 * i) = result.pose.rotation.row(i);
  block.reading_mm(row) = reading_mm(result.pose, set_up, push);
  block.sensitivity.row(row) = answer.value.transpose();
  block.residual_mm(row) = result.status == Status::kOk ? 0.0 : -static_cast<double>(result.status);
}

Status status_of(const Block& block, Eigen::Index row) {
  return is_solved(block, row) ? Status::kOk : static_cast<Status>(static_cast<int>(-block.residual_mm(row)));
}

void BlockSolver::chain(const SampleBlock& rows, JacobianBlock jacobian) const {
  Eigen::Index column = 0;
  for (std::size_t term = 0; term < model_.terms.size(); ++term) {
    const Eigen::Index size = model_.terms[term].values.size();
    if (affine_.has(term)) affine_.chain(term, *block_, rows.count, jacobian.block(0, column, rows.count, size));
    column += size;
  }
  chain_others(rows, jacobian);
}

void BlockSolver::chain_others(const SampleBlock& rows, JacobianBlock jacobian) const {
  Eigen::Index column = 0;
  for (std::size_t term = 0; term < model_.terms.size(); ++term) {
    const Eigen::VectorXd& values = model_.terms[term].values;
    if (!affine_.has(term)) {
      model_.terms[term].effect->chain(rows, values, block_->sensitivity.topRows(rows.count),
                                       jacobian.block(0, column, rows.count, values.size()));
    }
    column += values.size();
  }
}

}  // namespace hexdbb
