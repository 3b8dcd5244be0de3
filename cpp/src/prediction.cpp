#include "hexdbb/prediction.hpp"

#include "block_solver.hpp"
#include "read_late.hpp"

namespace hexdbb {

void Model::add(EffectPtr effect) {
  const int size = effect->info().size();
  terms.push_back({std::move(effect), Eigen::VectorXd::Zero(size)});
}

int Model::size() const {
  int size = 0;
  for (const Term& term : terms) size += static_cast<int>(term.values.size());
  return size;
}

Eigen::VectorXd Model::values() const {
  Eigen::VectorXd out(size());
  Eigen::Index at = 0;
  for (const Term& term : terms) {
    out.segment(at, term.values.size()) = term.values;
    at += term.values.size();
  }
  return out;
}

void Model::set_values(Values values) {
  Eigen::Index at = 0;
  for (Term& term : terms) {
    term.values = values.segment(at, term.values.size());
    at += term.values.size();
  }
}

Eigen::Index Prediction::first_failure() const {
  for (Eigen::Index row = 0; row < status.size(); ++row) {
    if (status[row] != 0) return row;
  }
  return -1;
}

Prediction predict(const Model& model, const Samples& samples, bool want_jacobian) {
  if (is_read_late(model, samples)) return predict(model, when_read(model, samples), want_jacobian);
  Prediction out;
  out.reading_mm.setZero(samples.size());
  out.status.setZero(samples.size());
  if (want_jacobian) out.jacobian.setZero(samples.size(), model.size());
  Eigen::MatrixXd columns(Block::kRows, model.size());
  BlockSolver solver(model, samples);
  solver.each_block(0, samples.size(), want_jacobian, [&](const SampleBlock& rows, const Block& block) {
    out.reading_mm.segment(rows.first, rows.count) = block.reading_mm.head(rows.count);
    for (Eigen::Index row = 0; row < rows.count; ++row) {
      out.status[rows.first + row] = static_cast<int>(status_of(block, row));
    }
    if (!want_jacobian) return;
    solver.chain(rows, columns);
    out.jacobian.middleRows(rows.first, rows.count) = columns.topRows(rows.count);
  });
  for (Eigen::Index row = 0; row < samples.size(); ++row) {
    if (out.status[row] != 0) out.reading_mm[row] = 0.0;
  }
  return out;
}

RowMajorMatrix port_sensitivity(const Model& model, const Samples& samples) {
  if (is_read_late(model, samples)) return port_sensitivity(model, when_read(model, samples));
  RowMajorMatrix out(samples.size(), int{port::kCount});
  BlockSolver(model, samples).each_block(0, samples.size(), true, [&](const SampleBlock& rows, const Block& block) {
    out.middleRows(rows.first, rows.count) = block.sensitivity.topRows(rows.count);
  });
  return out;
}

Pose PoseTable::at(Eigen::Index row) const {
  Pose out;
  out.position = pose.row(row).head<3>().transpose();
  for (int i = 0; i < 3; ++i) out.rotation.row(i) = pose.row(row).segment<3>(3 + 3 * i);
  return out;
}

PoseTable forward_table(const Model& model, const Samples& samples) {
  if (is_read_late(model, samples)) return forward_table(model, when_read(model, samples));
  PoseTable out;
  out.pose.setZero(samples.size(), 12);
  out.status.setZero(samples.size());
  BlockSolver(model, samples).each_block(0, samples.size(), false, [&](const SampleBlock& rows, const Block& block) {
    for (Eigen::Index row = 0; row < rows.count; ++row) {
      const Status status = status_of(block, row);
      out.status[rows.first + row] = static_cast<int>(status);
      if (status == Status::kOk) out.pose.row(rows.first + row) = block.pose.row(row);
    }
  });
  return out;
}

}  // namespace hexdbb
