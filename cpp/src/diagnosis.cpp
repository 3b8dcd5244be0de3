#include "hexdbb/diagnosis.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hexdbb {

namespace {

// Directions this far below the best known one are redundant in exact arithmetic.
constexpr double kRedundant = 1e-9;

double rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

/// What is estimated: free values in units of their expected sizes.
struct Unknowns {
  Eigen::VectorXd start;     // values of the whole model
  std::vector<int> columns;  // of the free ones
  Eigen::VectorXd scale;     // expected sizes of the free ones

  Eigen::Index size() const { return scale.size(); }

  Eigen::VectorXd values(const double* z) const {
    Eigen::VectorXd out = start;
    for (Eigen::Index j = 0; j < size(); ++j) out[columns[j]] = z[j] * scale[j];
    return out;
  }

  Eigen::VectorXd scaled_start() const { return start(columns).cwiseQuotient(scale); }

  RowMajorMatrix scaled(const RowMajorMatrix& jacobian) const {
    return jacobian(Eigen::all, columns) * scale.asDiagonal();
  }
};

/// Residuals and prior, compressed. With r the whitened readings' residuals and J their Jacobian, Ceres sees the n + p numbers
/// only through |r|^2, J'r and J'J. A triangular factor U of J'J, U^-T J'r and the part of |r| outside J's range have the same
/// three, so that a problem of 20,000 residuals becomes one of p + 1, and its dense algebra takes no time.
class CompressedCost : public ceres::CostFunction {
 public:
  CompressedCost(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
                 const Unknowns& unknowns, double noise_mm)
      : model_(model), samples_(samples), measured_mm_(measured_mm), unknowns_(unknowns), noise_mm_(noise_mm) {
    set_num_residuals(static_cast<int>(unknowns.size()) + 1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index size = unknowns_.size();
    const Eigen::Map<const Eigen::VectorXd> z(parameters[0], size);
    Model model = model_;
    model.set_values(unknowns_.values(parameters[0]));
    const Prediction predicted = predict(model, samples_, true);
    if (predicted.first_failure() >= 0) return false;  // Ceres then takes a shorter step
    const Eigen::VectorXd r = (measured_mm_ - predicted.reading_mm) / noise_mm_;
    const RowMajorMatrix j = unknowns_.scaled(predicted.jacobian) / -noise_mm_;
    Eigen::MatrixXd information = Eigen::MatrixXd::Identity(size, size);  // the prior's residuals are z themselves
    information.selfadjointView<Eigen::Lower>().rankUpdate(j.transpose());
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    const Eigen::VectorXd inside = factor.matrixL().solve(j.transpose() * r + z);
    const double outside_squared = r.squaredNorm() + z.squaredNorm() - inside.squaredNorm();
    Eigen::Map<Eigen::VectorXd>(residuals, size) = inside;
    residuals[size] = std::sqrt(std::max(outside_squared, 0.0));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajorMatrix> out(jacobians[0], size + 1, size);
      out.topRows(size) = factor.matrixU();
      out.row(size).setZero();
    }
    return true;
  }

 private:
  const Model& model_;
  const Samples& samples_;
  const Eigen::VectorXd& measured_mm_;
  const Unknowns& unknowns_;
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

Unknowns make_unknowns(const Model& model, const FitOptions& options) {
  if (!options.free.empty() && static_cast<int>(options.free.size()) != model.size()) {
    throw std::invalid_argument("free has " + std::to_string(options.free.size()) + " entries, expected " +
                                std::to_string(model.size()));
  }
  Unknowns out;
  out.start = model.values();
  for (int j = 0; j < model.size(); ++j) {
    if (options.free.empty() || options.free[j]) out.columns.push_back(j);
  }
  out.scale = expected_sizes(model)(out.columns);
  return out;
}

/// Rank and condition of the machine's own unknowns at the nominal machine, where redundancies are exact to first order.
Identifiability machine_identifiability(const Model& model, const Samples& samples, const Unknowns& unknowns,
                                        const FitOptions& options) {
  std::vector<bool> is_set_up;
  for (const Term& term : model.terms) {
    is_set_up.insert(is_set_up.end(), term.values.size(), term.effect->info().is_set_up);
  }
  std::vector<Eigen::Index> machine, set_up;
  for (Eigen::Index j = 0; j < unknowns.size(); ++j) (is_set_up[unknowns.columns[j]] ? set_up : machine).push_back(j);
  Model nominal = model;
  nominal.set_values(Eigen::VectorXd::Zero(model.size()));
  const RowMajorMatrix jacobian = unknowns.scaled(predict_or_throw(nominal, samples, true).jacobian);
  return identifiability(project_out(jacobian(Eigen::all, machine), jacobian(Eigen::all, set_up)), kRedundant,
                         options.noise_mm / options.telling_part);
}

void minimize(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
              const Unknowns& unknowns, const FitOptions& options, FitResult& out) {
  Eigen::VectorXd z = unknowns.scaled_start();
  ceres::Problem problem;
  problem.AddResidualBlock(new CompressedCost(model, samples, measured_mm, unknowns, options.noise_mm), nullptr, z.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-10;
  solver.gradient_tolerance = 1e-10;
  solver.parameter_tolerance = 1e-10;
  solver.initial_trust_region_radius = 1e8;  // the problem is nearly linear: start with Gauss-Newton steps
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  out.usable = summary.IsSolutionUsable();
  out.iterations = static_cast<int>(summary.iterations.size()) - 1;
  out.termination = summary.message;
  out.values = unknowns.values(z.data());
}

/// Covariance of the scaled unknowns to first order: inverse of the readings' information plus the prior's.
Eigen::MatrixXd first_order_spread(const RowMajorMatrix& scaled_jacobian, double noise_mm) {
  const Eigen::Index size = scaled_jacobian.cols();
  Eigen::MatrixXd information = Eigen::MatrixXd::Identity(size, size);
  information.selfadjointView<Eigen::Lower>().rankUpdate(scaled_jacobian.transpose(), 1.0 / (noise_mm * noise_mm));
  return Eigen::LLT<Eigen::MatrixXd>(information).solve(Eigen::MatrixXd::Identity(size, size));
}

/// What the curvature of the readings along weakly known directions adds to the covariance of the well known ones.
///
/// Along a direction no reading tells to first order (the cup's height under horizontal circles: its square shortens the bar) the
/// truth may be a whole expected size away, and what that does to the readings to second order is taken for something else.
/// With unit steps s_k of one standard deviation along the weak directions, reading(x + sum t_k s_k) = ... + sum h_kl t_k t_l,
/// t standard normal; the estimate is off by P sum h_kl t_k t_l, P = C J' / noise^2, whose second moment is
/// m m' + 2 sum p_kl p_kl', p_kl = P h_kl, m = sum p_kk. Evenly spaced rows suffice: h is smooth along a circle.
class Curvature {
 public:
  Curvature(const Model& model, const Samples& samples, const Unknowns& unknowns, const RowMajorMatrix& scaled_jacobian,
            const Eigen::MatrixXd& spread, double noise_mm)
      : model_(model), unknowns_(unknowns) {
    const Eigen::Index stride = std::max<Eigen::Index>(1, samples.size() / kRows);
    const Eigen::Index rows = (samples.size() + stride - 1) / stride;
    const auto every = Eigen::seqN(0, rows, stride);
    rows_ = Samples{samples.sliders_mm(every, Eigen::all), samples.set_up(every), samples.mount(every), samples.set_ups};
    const RowMajorMatrix seen = scaled_jacobian(every, Eigen::all);
    gain_ = (static_cast<double>(stride) / (noise_mm * noise_mm)) * spread * seen.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(spread);
    for (Eigen::Index k = 0; k < spread.cols(); ++k) {
      const double sigma = std::sqrt(principal.eigenvalues()[k]);
      if (sigma > kWeak) steps_.push_back(sigma * principal.eigenvectors().col(k));
    }
  }

  Eigen::MatrixXd spread() const {
    const Eigen::Index size = unknowns_.size();
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(size);
    const Eigen::VectorXd here = reading(nothing);
    std::vector<Eigen::VectorXd> there;
    for (const Eigen::VectorXd& step : steps_) there.push_back(reading(step));
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd mean = nothing;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Eigen::VectorXd own = gain_ * (0.5 * (there[k] + reading(-steps_[k])) - here);
      mean += own;
      out += 2.0 * own * own.transpose();
      for (std::size_t l = 0; l < k; ++l) {
        const Eigen::VectorXd both = gain_ * (0.5 * (reading(steps_[k] + steps_[l]) - there[k] - there[l] + here));
        out += 4.0 * both * both.transpose();  // kl and lk
      }
    }
    return out + mean * mean.transpose();
  }

 private:
  static constexpr Eigen::Index kRows = 500;
  static constexpr double kWeak = 0.02;  // directions known better than this have no curvature worth the name

  Eigen::VectorXd reading(const Eigen::VectorXd& step) const {
    Model model = model_;
    const Eigen::VectorXd z = model.values()(unknowns_.columns).cwiseQuotient(unknowns_.scale) + step;
    model.set_values(unknowns_.values(z.data()));
    return predict(model, rows_, false).reading_mm;
  }

  const Model& model_;
  const Unknowns& unknowns_;
  Samples rows_;
  Eigen::MatrixXd gain_;
  std::vector<Eigen::VectorXd> steps_;
};

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
  for (Eigen::Index row = 0; row < measured_mm.size(); ++row) {
    if (!std::isfinite(measured_mm[row])) {
      throw std::invalid_argument("measured_mm[" + std::to_string(row) + "] is not finite");
    }
  }
  if (!(options.noise_mm > 0.0)) throw std::invalid_argument("noise_mm must be greater than 0");

  FitResult out;
  const Unknowns unknowns = make_unknowns(model, options);
  if (unknowns.size() == 0) throw std::invalid_argument("there is nothing free to fit");
  out.free_columns = unknowns.columns;
  out.rms_before_mm = rms(measured_mm - predict_or_throw(model, samples, false).reading_mm);
  out.machine = machine_identifiability(model, samples, unknowns, options);
  minimize(model, samples, measured_mm, unknowns, options, out);

  Model fitted = model;
  fitted.set_values(out.values);
  const Prediction after = predict_or_throw(fitted, samples, true);
  out.residual_mm = measured_mm - after.reading_mm;
  out.rms_after_mm = rms(out.residual_mm);
  out.noise_mm = std::max(options.noise_mm, out.rms_after_mm);
  const RowMajorMatrix jacobian = unknowns.scaled(after.jacobian);
  Eigen::MatrixXd spread = first_order_spread(jacobian, out.noise_mm);
  spread += Curvature(fitted, samples, unknowns, jacobian, spread, out.noise_mm).spread();
  out.covariance = Eigen::MatrixXd::Zero(model.size(), model.size());
  out.covariance(unknowns.columns, unknowns.columns) =
      unknowns.scale.asDiagonal() * spread * unknowns.scale.asDiagonal();
  return out;
}

}  // namespace hexdbb
