#include "hexdbb/prediction.hpp"

#include <algorithm>

namespace hexdbb {

namespace {

// Rows handled at a time: 55 ports x 64 rows of doubles stay in a core's first cache.
constexpr Eigen::Index kBlockRows = 64;

using PortStore = Eigen::Matrix<double, Eigen::Dynamic, port::kCount>;

/// Solves sample after sample, each starting from the one before; prepares the platform's triangle again only when it changes.
class SampleSolver {
 public:
  explicit SampleSolver(const Model& model) : nominal_(model.nominal) {}

  /// Pose and mechanism of one sample; false where there is none.
  Status solve(const Vector6& sliders_mm, const Ports& push) {
    mechanism_ = assemble(nominal_, sliders_mm, push);
    shared_ = joints_are_shared(mechanism_);
    const Matrix3 joints = shared_joints(mechanism_);
    if (joints != triangle_.joints || !prepared_) {
      triangle_ = PlatformTriangle(joints);
      prepared_ = true;
    }
    ForwardResult result = forward(mechanism_, triangle_, angles_);
    if (result.status != Status::kOk) {  // a jump between circles can be too far for a warm start
      RssrAngles home;
      result = forward(mechanism_, triangle_, home);
      if (result.status == Status::kOk) angles_ = home;
    }
    if (result.status == Status::kOk && !shared_) result = forward_six(mechanism_, result.pose);
    pose_ = result.pose;
    return result.status;
  }

  bool sensitivity(const SetUp& set_up, const Ports& push, Ports& out) const {
    return shared_ ? reading_sensitivity(nominal_, mechanism_, triangle_, pose_, set_up, push, out)
                   : reading_sensitivity_six(nominal_, mechanism_, pose_, set_up, push, out);
  }

  const Pose& pose() const { return pose_; }

 private:
  const NominalGeometry& nominal_;
  PlatformTriangle triangle_;
  RssrAngles angles_;
  Mechanism mechanism_;
  Pose pose_;
  bool prepared_ = false;
  bool shared_ = true;
};

/// Calls visit(block, ports) for block after block, with every effect's push in `ports`.
template <class Visit>
void for_each_block(const Model& model, const Samples& samples, Visit visit) {
  PortStore store(std::min(kBlockRows, samples.size()), int{port::kCount});
  for (Eigen::Index first = 0; first < samples.size(); first += kBlockRows) {
    const SampleBlock block{samples, first, std::min(kBlockRows, samples.size() - first)};
    auto ports = store.topRows(block.count);
    ports.setZero();
    for (const Term& term : model.terms) term.effect->push(block, term.values, ports);
    visit(block, ports);
  }
}

Ports port_row(const ConstPortBlock& ports, Eigen::Index row) {
  Ports out;
  out.value = ports.row(row).transpose();
  return out;
}

}  // namespace

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
  Prediction out;
  out.reading_mm.setZero(samples.size());
  out.status.setZero(samples.size());
  if (want_jacobian) out.jacobian.setZero(samples.size(), model.size());
  SampleSolver solver(model);
  PortStore sensitivity(std::min(kBlockRows, samples.size()), int{port::kCount});
  Eigen::MatrixXd block_jacobian(std::min(kBlockRows, samples.size()), model.size());
  for_each_block(model, samples, [&](const SampleBlock& block, const ConstPortBlock& ports) {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      const Eigen::Index sample = block.first + row;
      const Ports push = port_row(ports, row);
      const SetUp& set_up = samples.set_ups[samples.set_up[sample]];
      Status status = solver.solve(samples.sliders_mm.row(sample).transpose(), push);
      Ports answer;
      if (status == Status::kOk) {
        out.reading_mm[sample] = reading_mm(solver.pose(), set_up, push);
        if (want_jacobian && !solver.sensitivity(set_up, push, answer)) status = Status::kSingular;
      }
      if (want_jacobian) sensitivity.row(row) = answer.value.transpose();
      out.status[sample] = static_cast<int>(status);
    }
    if (!want_jacobian) return;
    Eigen::Index column = 0;
    for (const Term& term : model.terms) {
      auto columns = block_jacobian.block(0, column, block.count, term.values.size());
      term.effect->chain(block, term.values, sensitivity.topRows(block.count), columns);
      column += term.values.size();
    }
    out.jacobian.middleRows(block.first, block.count) = block_jacobian.topRows(block.count);
  });
  return out;
}

RowMajorMatrix port_sensitivity(const Model& model, const Samples& samples) {
  RowMajorMatrix out = RowMajorMatrix::Zero(samples.size(), port::kCount);
  SampleSolver solver(model);
  for_each_block(model, samples, [&](const SampleBlock& block, const ConstPortBlock& ports) {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      const Eigen::Index sample = block.first + row;
      const Ports push = port_row(ports, row);
      Ports answer;
      if (solver.solve(samples.sliders_mm.row(sample).transpose(), push) == Status::kOk) {
        solver.sensitivity(samples.set_ups[samples.set_up[sample]], push, answer);
      }
      out.row(sample) = answer.value.transpose();
    }
  });
  return out;
}

PoseTable forward_table(const Model& model, const Samples& samples) {
  PoseTable out;
  out.pose.setZero(samples.size(), 12);
  out.status.setZero(samples.size());
  SampleSolver solver(model);
  for_each_block(model, samples, [&](const SampleBlock& block, const ConstPortBlock& ports) {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      const Eigen::Index sample = block.first + row;
      const Status status = solver.solve(samples.sliders_mm.row(sample).transpose(), port_row(ports, row));
      out.status[sample] = static_cast<int>(status);
      if (status != Status::kOk) continue;
      out.pose.row(sample).head<3>() = solver.pose().position.transpose();
      for (int i = 0; i < 3; ++i) out.pose.row(sample).segment<3>(3 + 3 * i) = solver.pose().rotation.row(i);
    }
  });
  return out;
}

}  // namespace hexdbb
