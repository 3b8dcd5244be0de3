#include "normal_equations.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

#include "read_late.hpp"

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

NormalEquations zero(Eigen::Index of_information, Eigen::Index columns) {
  NormalEquations out;
  out.information.setZero(of_information, of_information);
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
  memory_.blocks.assign(blocks_of(samples), Block::Angles::Zero());
  residual_mm_.setZero(samples.size());
}

const NormalEquations& Accumulator::at(const Model& model, Sums sums) {
  if (jacobian_.rows() > 0) sums = Sums::kAll;  // a gradient alone needs no Jacobian
  const Eigen::VectorXd values = model.values();
  if (values.size() != last_values_.size() || values != last_values_ || sums > last_sums_) {
    last_ = sum(model, sums);
    last_values_ = values;
    last_sums_ = sums;
  }
  return last_;
}

void Accumulator::start_from(const Accumulator& all, Eigen::Index stride) {
  for (Eigen::Index row = 0; row < Block::kRows * blocks_of(samples_); ++row) {
    const Eigen::Index from = std::min(row, samples_.size() - 1) * stride;
    memory_.blocks[row / Block::kRows].row(row % Block::kRows) =
        all.memory_.blocks[from / Block::kRows].row(from % Block::kRows);
  }
}

void Accumulator::keep_jacobian() {
  jacobian_.setZero(samples_.size(), static_cast<Eigen::Index>(columns_.size()));
  last_values_.resize(0);  // its Jacobian was not kept
}

/// Check once that the samples have what the model's effects need: that reads whole columns.
void Accumulator::check(const Model& model) {
  if (!is_checked_) require_columns(model, samples_);
  is_checked_ = true;
}

Eigen::VectorXd Accumulator::reading_mm(const Model& model) {
  check(model);
  Eigen::VectorXd out(samples_.size());
  BlockSolver(model, samples_, &memory_)
      .each_block(0, samples_.size(), false, [&](const SampleBlock& rows, const Block& block) {
        for (Eigen::Index row = 0; row < rows.count; ++row) {
          out[rows.first + row] = status_of(block, row) == Status::kOk ? block.reading_mm(row) : 0.0;
        }
      });
  return out;
}

NormalEquations Accumulator::sum(const Model& model, Sums sums) {
  check(model);
  const Eigen::Index blocks = blocks_of(samples_);
  const Eigen::Index parts = threads_for(blocks);
  const bool has_all = sums != Sums::kAll || takes_all(model);  // a gradient is summed for all values
  const Eigen::Index width = padded(has_all ? model.size() : static_cast<Eigen::Index>(columns_.size()));
  std::vector<NormalEquations> of_parts(parts, zero(sums == Sums::kAll ? width : 0, width));
  const auto run = [&](Eigen::Index part) {
    const Eigen::Index first = blocks * part / parts * Block::kRows;
    const Eigen::Index last = std::min(blocks * (part + 1) / parts * Block::kRows, samples_.size());
    chunk(model, first, last, sums, of_parts[part]);
  };
  std::vector<std::thread> threads;
  for (Eigen::Index part = 1; part < parts; ++part) threads.emplace_back(run, part);
  run(0);
  for (std::thread& each : threads) each.join();

  NormalEquations out = zero(sums == Sums::kAll ? width : 0, width);
  for (const NormalEquations& part : of_parts) {
    out.information += part.information;
    out.gradient += part.gradient;
    out.squared += part.squared;
    if (out.failure < 0 && part.failure >= 0) {
      out.failure = part.failure;
      out.failure_status = part.failure_status;
    }
  }
  std::vector<int> places = columns_;  // of what counts, among the sums
  if (!has_all) std::iota(places.begin(), places.end(), 0);
  if (sums == Sums::kAll) {
    const Eigen::MatrixXd whole = out.information.selfadjointView<Eigen::Lower>();
    out.information = whole(places, places);
  }
  out.gradient = sums == Sums::kResidual ? Eigen::VectorXd() : out.gradient(places).eval();
  return out;
}

/// Rows of the Jacobian and residuals, gathered from several blocks: a tile of J'J is then summed over four times as many
/// rows before its lanes are, which takes as long as 64 rows.
class Accumulator::Gathered {
 public:
  Gathered(Eigen::Index columns, NormalEquations& out)
      : out_(out), jacobian_(Eigen::MatrixXd::Zero(kRows, columns)), residual_(kRows) {}

  auto jacobian() { return jacobian_.middleRows(filled_, Block::kRows); }
  auto residual() { return residual_.segment(filled_, Block::kRows); }

  /// Count the block's rows; those beyond a block's last hold zeros.
  void add_block() {
    filled_ += Block::kRows;
    if (filled_ == kRows) flush();
  }

  void flush() {
    const JacobianRows rows{jacobian_.data(), filled_, kRows, jacobian_.cols()};
    add_information(rows, out_.information.data());
    add_gradient(rows, residual_.data(), out_.gradient.data());
    filled_ = 0;
  }

 private:
  static constexpr Eigen::Index kRows = 4 * Block::kRows;  // with 48 columns 100 kB, which a core's second cache holds

  NormalEquations& out_;
  Eigen::MatrixXd jacobian_;
  Eigen::VectorXd residual_;
  Eigen::Index filled_ = 0;
};

/// J'r alone, for all values of a model: that of affine effects from sums at the ports, without any row of the Jacobian.
class Accumulator::GradientSums {
 public:
  GradientSums(const Model& model, const BlockSolver& solver, NormalEquations& out)
      : model_(model), solver_(solver), out_(out) {
    Eigen::Index column = 0;
    for (std::size_t term = 0; term < model.terms.size(); ++term) {
      const Eigen::Index end = column + model.terms[term].values.size();
      for (; column < end && !solver.affine().has(term); ++column) {
        const Eigen::Index four = column / 4 * 4;
        if (fours_.empty() || fours_.back() != four) fours_.push_back(four);
      }
      column = end;
    }
    if (!fours_.empty()) others_.setZero(Block::kRows, padded(model.size()));
  }

  /// `weighted`: residuals times the square of their weight, zeros beyond the block's rows.
  void add_block(const SampleBlock& rows, const Block& block, const Eigen::VectorXd& weighted) {
    solver_.affine().add(block, rows.count, weighted.data(), ports_);
    if (fours_.empty()) return;
    solver_.chain_others(rows, others_.leftCols(model_.size()));
    others_.bottomRows(Block::kRows - rows.count).setZero();
    for (const Eigen::Index four : fours_) {
      add_gradient({&others_(0, four), Block::kRows, Block::kRows, 4}, weighted.data(), &out_.gradient[four]);
    }
  }

  void flush() {
    Eigen::Index column = 0;
    for (std::size_t term = 0; term < model_.terms.size(); ++term) {
      const Eigen::Index size = model_.terms[term].values.size();
      const AffinePart& affine = solver_.affine();
      if (affine.has(term)) out_.gradient.segment(column, size) += affine.gradient(term, size, ports_);
      column += size;
    }
  }

 private:
  const Model& model_;
  const BlockSolver& solver_;
  NormalEquations& out_;
  PortGradient ports_;
  Eigen::MatrixXd others_;  // columns of the Jacobian of the effects that are not affine; zeros for the affine ones
  std::vector<Eigen::Index> fours_;  // first of each four columns in which any is not affine
};

/// Keep the Jacobian of a block, columns those of all values, where that is asked for.
void Accumulator::keep(const SampleBlock& rows, const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  if (jacobian_.rows() == 0) return;
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    jacobian_.col(static_cast<Eigen::Index>(j)).segment(rows.first, rows.count) =
        columns.col(columns_[j]).head(rows.count);
  }
}

void Accumulator::chunk(const Model& model, Eigen::Index first, Eigen::Index last, Sums sums, NormalEquations& out) {
  const bool derives = sums >= Sums::kGradient;
  Eigen::VectorXd residual(Block::kRows), weight = Eigen::VectorXd::Ones(Block::kRows);
  BlockSolver solver(model, samples_, &memory_);
  Gathered gathered(sums == Sums::kAll ? out.information.cols() : 0, out);
  GradientSums gradient(model, solver, out);
  Eigen::MatrixXd all;  // columns of the Jacobian, where some are not summed
  if (sums == Sums::kAll && !takes_all(model)) all.resize(Block::kRows, model.size());
  solver.each_block(first, last, derives, [&](const SampleBlock& rows, const Block& block) {
    if (out.failure < 0 && solver.first_failure() >= 0) {
      out.failure = rows.first + solver.first_failure();
      out.failure_status = status_of(block, solver.first_failure());
    }
    if (out.failure >= 0) return;
    residual.head(rows.count) = measured_mm_.segment(rows.first, rows.count) - block.reading_mm.head(rows.count);
    residual.tail(Block::kRows - rows.count).setZero();
    residual_mm_.segment(rows.first, rows.count) = residual.head(rows.count);
    if (robust_mm_ > 0.0) {
      out.squared += weigh(residual, robust_mm_, weight);
    } else {
      out.squared += residual.squaredNorm();
    }
    if (sums == Sums::kGradient) gradient.add_block(rows, block, weight.cwiseProduct(residual));
    if (sums != Sums::kAll) return;
    auto counted = gathered.jacobian();  // columns that are only there for whole tiles stay zero
    if (takes_all(model)) {
      solver.chain(rows, counted);
      keep(rows, counted);
    } else {
      solver.chain(rows, all);
      keep(rows, all);
      for (std::size_t j = 0; j < columns_.size(); ++j) {
        counted.col(static_cast<Eigen::Index>(j)).head(rows.count) = all.col(columns_[j]).head(rows.count);
      }
    }
    if (robust_mm_ > 0.0) counted = weight.asDiagonal() * counted;
    counted.bottomRows(Block::kRows - rows.count).setZero();
    gathered.residual() = residual;
    gathered.add_block();
  });
  if (sums == Sums::kAll) gathered.flush();
  if (sums == Sums::kGradient) gradient.flush();
}

/// Return whether all values of a model are summed and those that count chosen from the sums: where they fill as many
/// tiles, that spares a copy of the Jacobian.
bool Accumulator::takes_all(const Model& model) const { return padded(model.size()) == padded(columns_.size()); }

NormalEquations normal_equations(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm) {
  samples.validate();
  if (measured_mm.size() != samples.size()) {
    throw std::invalid_argument("measured_mm has " + std::to_string(measured_mm.size()) + " readings, expected " +
                                std::to_string(samples.size()) + ", one per sample");
  }
  if (is_read_late(model, samples)) return normal_equations(model, when_read(model, samples), measured_mm);
  std::vector<int> columns(model.size());
  std::iota(columns.begin(), columns.end(), 0);
  return Accumulator(samples, measured_mm, columns).at(model);
}

}  // namespace hexdbb
