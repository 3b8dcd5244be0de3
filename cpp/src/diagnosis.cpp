#include "hexdbb/diagnosis.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>

namespace hexdbb {

namespace {

// Directions this far below the best known one are redundant in exact arithmetic.
constexpr double kRedundant = 1e-9;
// A value counts as determined on its own where at most this part of its unit vector (squared) lies in unknown directions.
constexpr double kLoosePart = 1e-4;

double rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

/// Values of the whole model from the fit's coordinates: value = start + scale * V w on the free ones.
struct Chart {
  Eigen::VectorXd start;
  Eigen::MatrixXd basis;  // values x coordinates, already scaled

  Eigen::VectorXd at(const double* w) const {
    return start + basis * Eigen::Map<const Eigen::VectorXd>(w, basis.cols());
  }
};

/// All whitened residuals and their Jacobian as one block: (measured - predicted) / noise.
class ReadingsCost : public ceres::CostFunction {
 public:
  ReadingsCost(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, const Chart& chart,
               double noise_mm)
      : model_(model), samples_(samples), measured_mm_(measured_mm), chart_(chart), noise_mm_(noise_mm) {
    set_num_residuals(static_cast<int>(samples.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(chart.basis.cols()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    Model model = model_;
    model.set_values(chart_.at(parameters[0]));
    const bool want_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    const Prediction predicted = predict(model, samples_, want_jacobian);
    if (predicted.first_failure() >= 0) return false;  // Ceres then takes a shorter step
    Eigen::Map<Eigen::VectorXd>(residuals, samples_.size()) = (measured_mm_ - predicted.reading_mm) / noise_mm_;
    if (want_jacobian) {
      Eigen::Map<RowMajorMatrix>(jacobians[0], samples_.size(), chart_.basis.cols()).noalias() =
          predicted.jacobian * (chart_.basis / -noise_mm_);
    }
    return true;
  }

 private:
  const Model& model_;
  const Samples& samples_;
  const Eigen::VectorXd& measured_mm_;
  const Chart& chart_;
  double noise_mm_;
};

Prediction predict_or_throw(const Model& model, const Samples& samples, bool want_jacobian) {
  Prediction predicted = predict(model, samples, want_jacobian);
  const Eigen::Index row = predicted.first_failure();
  if (row >= 0) {
    throw std::invalid_argument("sample " + std::to_string(row) + ": " +
                                status_name(static_cast<Status>(predicted.status[row])));
  }
  return predicted;
}

std::vector<int> free_columns(const Model& model, const FitOptions& options) {
  if (!options.free.empty() && static_cast<int>(options.free.size()) != model.size()) {
    throw std::invalid_argument("free has " + std::to_string(options.free.size()) + " entries, expected " +
                                std::to_string(model.size()));
  }
  std::vector<int> columns;
  for (int j = 0; j < model.size(); ++j) {
    if (options.free.empty() || options.free[j]) columns.push_back(j);
  }
  return columns;
}

RowMajorMatrix scaled_columns(const RowMajorMatrix& jacobian, const std::vector<int>& columns,
                              const Eigen::VectorXd& scale) {
  RowMajorMatrix out(jacobian.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    out.col(static_cast<Eigen::Index>(j)) = jacobian.col(columns[j]) * scale[columns[j]];
  }
  return out;
}

Eigen::MatrixXd scaled_basis(const Eigen::MatrixXd& directions, const std::vector<int>& columns,
                             const Eigen::VectorXd& scale) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(scale.size(), directions.cols());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    out.row(columns[j]) = scale[columns[j]] * directions.row(static_cast<Eigen::Index>(j));
  }
  return out;
}

void minimize(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, const Chart& chart,
              const FitOptions& options, FitResult& out) {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(chart.basis.cols());
  ceres::Problem problem;
  problem.AddResidualBlock(new ReadingsCost(model, samples, measured_mm, chart, options.noise_mm), nullptr, w.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-12;
  solver.initial_trust_region_radius = 1e8;  // the problem is nearly linear: start with Gauss-Newton steps
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  out.usable = summary.IsSolutionUsable();
  out.iterations = static_cast<int>(summary.iterations.size()) - 1;
  out.termination = summary.message;
  out.values = chart.at(w.data());
}

}  // namespace

Eigen::VectorXd expected_sizes(const Model& model) {
  Eigen::VectorXd out(model.size());
  Eigen::Index at = 0;
  for (const Term& term : model.terms) {
    const EffectInfo& info = term.effect->info();
    for (int j = 0; j < info.size(); ++j) out[at++] = info.parameters[j % info.parameters.size()].prior_sigma;
  }
  return out;
}

FitResult fit(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
              const FitOptions& options) {
  samples.validate();
  if (samples.size() == 0) throw std::invalid_argument("there are no readings to fit");
  if (measured_mm.size() != samples.size()) throw std::invalid_argument("as many readings as samples are needed");
  if (!(options.noise_mm > 0.0)) throw std::invalid_argument("noise_mm must be greater than 0");

  FitResult out;
  out.free_columns = free_columns(model, options);
  out.rms_before_mm = rms(measured_mm - predict_or_throw(model, samples, false).reading_mm);

  const Eigen::VectorXd scale = expected_sizes(model);
  Model nominal = model;
  nominal.set_values(Eigen::VectorXd::Zero(model.size()));
  const RowMajorMatrix jacobian =
      scaled_columns(predict_or_throw(nominal, samples, true).jacobian, out.free_columns, scale);
  out.identifiability = identifiability(jacobian, kRedundant, options.noise_mm / options.prior_fraction);

  const Chart chart{model.values(), scaled_basis(out.identifiability.identifiable(), out.free_columns, scale)};
  if (chart.basis.cols() > 0) {
    minimize(model, samples, measured_mm, chart, options, out);
  } else {
    out.values = model.values();
    out.termination = "rank 0: the readings say nothing about the free unknowns";
  }

  Model fitted = model;
  fitted.set_values(out.values);
  const Prediction after = predict_or_throw(fitted, samples, true);
  out.residual_mm = measured_mm - after.reading_mm;
  out.rms_after_mm = rms(out.residual_mm);
  const double degrees = static_cast<double>(std::max<Eigen::Index>(samples.size() - chart.basis.cols(), 1));
  const double residual_noise = out.residual_mm.norm() / std::sqrt(degrees);
  out.noise_mm = options.noise_is_stated ? std::max(options.noise_mm, residual_noise) : residual_noise;

  // Covariance of the coordinates at the solution, carried to the values.
  const Eigen::MatrixXd seen = after.jacobian * chart.basis;
  const Eigen::MatrixXd information = seen.transpose() * seen;
  const Eigen::MatrixXd spread =
      information.ldlt().solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  out.covariance = out.noise_mm * out.noise_mm * chart.basis * spread * chart.basis.transpose();

  out.identifiable.assign(model.size(), false);
  const Eigen::MatrixXd loose = out.identifiability.unidentifiable();
  for (std::size_t j = 0; j < out.free_columns.size(); ++j) {
    out.identifiable[out.free_columns[j]] = loose.row(static_cast<Eigen::Index>(j)).squaredNorm() < kLoosePart;
  }
  return out;
}

}  // namespace hexdbb
