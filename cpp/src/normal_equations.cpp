#include "normal_equations.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

namespace hexdbb {

namespace {

constexpr Eigen::Index kBlocksPerThread = 32;  // 2048 samples; for fewer, starting a thread costs more than it saves

std::atomic<int> most_threads{0};  // 0: as many as cores

Eigen::Index threads_for(Eigen::Index blocks) {
  const int most = most_threads.load(std::memory_order_relaxed);
  const Eigen::Index cores = most > 0 ? most : std::max<Eigen::Index>(1, std::thread::hardware_concurrency());
  return std::clamp<Eigen::Index>(blocks / kBlocksPerThread, 1, cores);
}

Eigen::Index blocks_of(const Samples& samples) { return (samples.size() + Block::kRows - 1) / Block::kRows; }

NormalEquations zero(Eigen::Index columns) {
  NormalEquations out;
  out.information.setZero(columns, columns);
  out.gradient.setZero(columns);
  return out;
}

/// Weight residuals by Huber's loss: those beyond `limit` are scaled down to count linearly. Return the sum of losses,
/// which for them is 2 limit |r| - limit^2.
double weigh(Eigen::VectorXd& residual, double limit, Eigen::VectorXd& weight) {
  double loss = 0.0;
  for (Eigen::Index row = 0; row < residual.size(); ++row) {
    const double size = std::abs(residual[row]);
    const bool far = size > limit;
    weight[row] = far ? std::sqrt(limit / size) : 1.0;
    loss += far ? 2.0 * limit * size - limit * limit : size * size;
    residual[row] *= weight[row];
  }
  return loss;
}

/// Round up to a number of columns divisible by four, as accumulated tiles require.
Eigen::Index padded(Eigen::Index columns) { return (columns + 3) / 4 * 4; }

}  // namespace

void limit_threads(int most) {
  if (most < 0) throw std::invalid_argument("threads: " + std::to_string(most) + " (expected 0 or more)");
  most_threads.store(most, std::memory_order_relaxed);
}

Accumulator::Accumulator(const Samples& samples, const Eigen::VectorXd& measured_mm, const std::vector<int>& columns,
                         double robust_mm)
    : samples_(samples), measured_mm_(measured_mm), columns_(columns), robust_mm_(robust_mm) {
  memory_.blocks.assign(blocks_of(samples), Block::Table<6>::Zero());
  residual_mm_.setZero(samples.size());
}

const NormalEquations& Accumulator::at(const Model& model) {
  const Eigen::VectorXd values = model.values();
  if (values.size() != last_values_.size() || values != last_values_) {
    last_ = sum(model);
    last_values_ = values;
  }
  return last_;
}

void Accumulator::keep_jacobian() { jacobian_.setZero(samples_.size(), static_cast<Eigen::Index>(columns_.size())); }

Eigen::VectorXd Accumulator::reading_mm(const Model& model) {
  Eigen::VectorXd out(samples_.size());
  BlockSolver(model, samples_, &memory_)
      .each_block(0, samples_.size(), false, [&](const SampleBlock& rows, const Block& block) {
        for (Eigen::Index row = 0; row < rows.count; ++row) {
          out[rows.first + row] = status_of(block, row) == Status::kOk ? block.reading_mm(row) : 0.0;
        }
      });
  return out;
}

NormalEquations Accumulator::sum(const Model& model) {
  const Eigen::Index blocks = blocks_of(samples_);
  const Eigen::Index parts = threads_for(blocks);
  std::vector<NormalEquations> sums(parts, zero(width(model)));
  const auto run = [&](Eigen::Index part) {
    const Eigen::Index first = blocks * part / parts * Block::kRows;
    const Eigen::Index last = std::min(blocks * (part + 1) / parts * Block::kRows, samples_.size());
    chunk(model, first, last, sums[part]);
  };
  std::vector<std::thread> threads;
  for (Eigen::Index part = 1; part < parts; ++part) threads.emplace_back(run, part);
  run(0);
  for (std::thread& each : threads) each.join();

  NormalEquations out = zero(width(model));
  for (const NormalEquations& part : sums) {
    out.information += part.information;
    out.gradient += part.gradient;
    out.squared += part.squared;
    if (out.failure < 0 && part.failure >= 0) {
      out.failure = part.failure;
      out.failure_status = part.failure_status;
    }
  }
  std::vector<int> places = columns_;  // of what counts, among the sums
  if (!takes_all(model)) std::iota(places.begin(), places.end(), 0);
  const Eigen::MatrixXd whole = out.information.selfadjointView<Eigen::Lower>();
  out.information = whole(places, places).eval();
  out.gradient = out.gradient(places).eval();
  return out;
}

void Accumulator::chunk(const Model& model, Eigen::Index first, Eigen::Index last, NormalEquations& out) {
  const Eigen::Index columns = width(model);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(Block::kRows, padded(model.size())), some;
  if (!takes_all(model)) some = Eigen::MatrixXd::Zero(Block::kRows, columns);
  Eigen::MatrixXd& counted = takes_all(model) ? all : some;
  Eigen::VectorXd residual(Block::kRows), weight(Block::kRows);
  BlockSolver solver(model, samples_, &memory_);
  solver.each_block(first, last, true, [&](const SampleBlock& rows, const Block& block) {
    for (Eigen::Index row = 0; row < rows.count && out.failure < 0; ++row) {
      out.failure_status = status_of(block, row);
      if (out.failure_status != Status::kOk) out.failure = rows.first + row;
    }
    if (out.failure >= 0) return;
    solver.chain(rows, all);
    residual.head(rows.count) = measured_mm_.segment(rows.first, rows.count) - block.reading_mm.head(rows.count);
    residual.tail(Block::kRows - rows.count).setZero();
    residual_mm_.segment(rows.first, rows.count) = residual.head(rows.count);
    if (robust_mm_ > 0.0) {
      out.squared += weigh(residual, robust_mm_, weight);
    } else {
      out.squared += residual.squaredNorm();
    }
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      if (jacobian_.rows() > 0) {
        jacobian_.col(static_cast<Eigen::Index>(j)).segment(rows.first, rows.count) =
            all.col(columns_[j]).head(rows.count);
      }
      if (!takes_all(model)) {
        some.col(static_cast<Eigen::Index>(j)).head(rows.count) = all.col(columns_[j]).head(rows.count);
      }
    }
    if (robust_mm_ > 0.0) counted = weight.asDiagonal() * counted;
    counted.bottomRows(Block::kRows - rows.count).setZero();
    accumulate(counted.data(), residual.data(), Block::kRows, columns, out.information.data(), out.gradient.data());
  });
}

/// Return whether all values of a model are summed and those that count chosen from the sums: where they fill as many
/// tiles, that spares a copy of the Jacobian.
bool Accumulator::takes_all(const Model& model) const { return padded(model.size()) == padded(columns_.size()); }

Eigen::Index Accumulator::width(const Model& model) const {
  return padded(takes_all(model) ? model.size() : columns_.size());
}

NormalEquations normal_equations(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm) {
  samples.validate();
  if (measured_mm.size() != samples.size()) {
    throw std::invalid_argument("measured_mm has " + std::to_string(measured_mm.size()) + " readings, expected " +
                                std::to_string(samples.size()) + ", one per sample");
  }
  std::vector<int> columns(model.size());
  std::iota(columns.begin(), columns.end(), 0);
  return Accumulator(samples, measured_mm, columns).at(model);
}

}  // namespace hexdbb
