#include "hexdbb/diagnosis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "block_solver.hpp"
#include "curvature.hpp"
#include "geodesics.hpp"
#include "hexdbb/tabulated_effect.hpp"
#include "minimum.hpp"
#include "near_minimum.hpp"
#include "read_late.hpp"

namespace hexdbb {

namespace {

// Ratio to the largest singular value below which a direction is structurally redundant: J'J resolves ratios to about
// 1e-8, and the identifiable directions of the plans examined (condition up to 2832) are above 3e-4.
constexpr double kRedundant = 1e-6;

// Readings of the part on which a diagnosis is fitted coarse to fine: 73 per sweep of a plan of seven circles, two
// directions, two feeds, so that those inside the play of a slider after its reversals count too. Half of them save as much
// as the further steps cost that some records then take over all readings.
constexpr Eigen::Index kFewRows = 2048;
// Readings per reading of the part from which the part is worth while: below, the steps that it saves cost little more.
constexpr Eigen::Index kLeastStride = 4;

// Readings per reading of the part at most: its minimum is sqrt(values x stride) standard deviations away from that of all
// readings, and from afar the last steps do not come to rest. 24 standard deviations at 37 values.
constexpr Eigen::Index kMostStride = 16;

double rms(const Eigen::VectorXd& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

/// Return the normal equations at a model. Throws std::invalid_argument where a sample has no solution, naming it;
/// `stride` is that of the accumulator's samples.
const NormalEquations& at_or_throw(Accumulator& accumulator, const Model& model, Sums sums = Sums::kAll,
                                   Eigen::Index stride = 1) {
  const NormalEquations& out = accumulator.at(model, sums);
  if (out.failure >= 0) {
    throw std::invalid_argument("sample " + std::to_string(stride * out.failure) + ": " +
                                status_name(out.failure_status));
  }
  return out;
}

/// Compute rank and condition of the machine's own unknowns at the nominal machine, where redundancies are exact to
/// first order: the Schur complement of the set-up's part of J'J, of which evenly spaced samples yield it as well as all.
/// `stride` is that of the accumulator's samples.
Identifiability machine_identifiability(const Model& model, Accumulator& accumulator, Eigen::Index stride,
                                        const Unknowns& unknowns, const FitOptions& options) {
  std::vector<bool> is_set_up;
  for (const Term& term : model.terms) {
    is_set_up.insert(is_set_up.end(), term.values.size(), term.effect->info().is_set_up);
  }
  std::vector<Eigen::Index> machine, set_up;
  for (Eigen::Index j = 0; j < unknowns.size(); ++j) (is_set_up[unknowns.columns[j]] ? set_up : machine).push_back(j);
  Model nominal = model;
  nominal.set_values(Eigen::VectorXd::Zero(model.size()));
  const Eigen::VectorXd scale = std::sqrt(static_cast<double>(stride)) * unknowns.scale;
  const Eigen::MatrixXd information =
      scale.asDiagonal() * at_or_throw(accumulator, nominal, Sums::kAll, stride).information * scale.asDiagonal();
  return identifiability_of(information, machine, set_up, kRedundant, options.noise_mm / options.identified_fraction);
}

/// Scaled values that a fit has reached, and their cost.
struct Reached {
  Eigen::VectorXd z;
  double cost = std::numeric_limits<double>::infinity();
};

/// Fit by Ceres to all readings, until no step improves the fit by more than a part of 1e-9 of its cost, from the start,
/// and from what was reached before where that is lower than the end: from afar Ceres may find the deeper minimum.
void minimize_all(const Model& model, Accumulator& accumulator, const Unknowns& unknowns, const FitOptions& options,
                  Eigen::VectorXd z, Reached before, FitResult& out) {
  const auto from = [&](Eigen::VectorXd& at) {
    return minimize(model, accumulator, unknowns, options.noise_mm, options.max_iterations, 1e-9, at);
  };
  Minimum found = from(z);
  if (before.cost < found.cost) {
    found = from(before.z);
    z = std::move(before.z);
  }
  out.usable = found.is_usable;
  out.iterations = found.iterations;
  out.termination = found.message;
  out.values = unknowns.values(z.data());
}

/// Fit coarse to fine: Ceres finds the minimum of a part of the readings, evenly chosen, at a part of the cost; it is
/// some of its standard deviations away from that of all readings, to which the last steps lead. `out` stays unusable
/// where these do not come to rest, or all readings like the end less than the start, whose cost is `at_start`. Return the
/// best scaled values found, none where they are no better than the start.
Reached fit_coarse_to_fine(const Model& model, Accumulator& accumulator, FewReadings& few, const Unknowns& unknowns,
                           const FitOptions& options, double at_start, FitResult& out) {
  // Of the cost, per value and reading of all for one of the part: the minimum of all readings is expected to be worse for
  // the part by a half of that, and a thousandth of that more does not lengthen the way. Where the cost has kinks, Ceres takes
  // tens of passes for what is below.
  constexpr double kCoarseFall = 0.0005;
  // Of chi-square: where a step is predicted to lower it by less, none is taken. The minimum is then 1e-3 standard
  // deviations away over all values together.
  constexpr double kLastFall = 1e-6;
  constexpr double kFall = 1e-10;  // of chi-square, relative: of 20,000 readings within 0.002 standard deviations
  // Of chi-square, where it has kinks: 0.1 standard deviations over all values together. It has one for each reading near
  // the end of a play, and finding the lowest of them to a third of that takes ten passes more; values moved by 0.025
  // standard deviations at most.
  constexpr double kKinkedFall = 1e-2;
  const Eigen::VectorXd start = unknowns.scaled_start(), bound = bounds_about(unknowns, start);
  Eigen::VectorXd near = start;
  if (!is_thin(few, unknowns.size())) {
    const double per_cost = 2.0 / static_cast<double>(accumulator.residual_mm().size());  // where noise is left
    const double tolerance = kCoarseFall * static_cast<double>(unknowns.size() * few.stride()) * per_cost;
    if (!find_near(few, unknowns, options.max_iterations, tolerance, bound, near)) return {};
  }
  const auto of_all = [&](const Eigen::VectorXd& at, Sums sums) {
    return posterior_at(model, accumulator, unknowns, options.noise_mm, at, sums);
  };
  const double chi_squared =
      std::max(2.0 * of_all(near, Sums::kGradient).cost, static_cast<double>(accumulator.residual_mm().size()));
  const LastSteps end = finish(of_all, few, near, bound, {kLastFall, kFall * chi_squared, kKinkedFall});
  out.iterations = end.steps;
  out.usable = end.is_at_rest && end.cost <= at_start;
  out.termination = "Converged: no further step improves the fit.";
  if (out.usable) out.values = unknowns.values(end.z.data());
  return end.cost <= at_start ? Reached{end.z, end.cost} : Reached{};
}

/// Fit a hypothesis: first to a part of the readings, then to all of them. Return the scaled values at the end.
///
/// A model that lacks an effect distorts its geometry by many prior standard deviations to imitate it; from there the
/// minimum of the complete model is far. The fit is therefore also started from the values most probable a priori. From
/// the minimum of nearly the same readings, a few steps lead to that of these.
Eigen::VectorXd fit_hypothesis(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
                               Accumulator& accumulator, const Unknowns& unknowns, const FitOptions& options,
                               FitResult& out) {
  constexpr int kMostCoarse = 60, kMost = 20;  // iteration limits
  constexpr double kCoarseFall = 1.0;          // of chi-square: the remaining readings move the minimum by more
  constexpr double kFall = 0.02;               // of chi-square: verdicts depend on differences of several units
  constexpr double kKinkedFall = 2.0;  // of chi-square, where steps go back and forth across kinks: a nat of evidence
  const double noise_mm = options.noise_mm;
  const Eigen::VectorXd start = unknowns.scaled_start(), bound = bounds_about(unknowns, start);
  FewReadings few(model, samples, measured_mm, unknowns, noise_mm);
  few.accumulator().keep_jacobian();  // every step's acceleration asks for it: from the first pass on
  const auto of_all = [&](const Eigen::VectorXd& at, Sums sums) {
    return posterior_at(model, accumulator, unknowns, noise_mm, at, sums);
  };
  out.termination = "Converged: no further step improves the fit.";
  const auto of_all_sums = [&](const Eigen::VectorXd& z) { return of_all(z, Sums::kAll); };
  // Few readings hardly hold on to their minimum without some of them, and their descent costs little.
  const bool thin = is_thin(few, unknowns.size());
  if (options.from_minimum && (thin || samples.size() >= kLeastStride * kFewRows)) {
    LastSteps end = take_last_steps(of_all, few, start, bound, {kFall, kFall, kFall});
    out.usable = end.is_at_rest;
    out.iterations = end.steps;
    if (out.usable) {
      out.values = unknowns.values(end.z.data());
      return end.z;
    }
    // Where kinks of the cost stop steps that are not damped, the minimum is near all the same: of hundreds of learned
    // values the way from afar took four times as long, for a minimum no lower. Of few values it costs little, and was
    // lower where circles left out hardly hold geometry.
    if (thin) {
      Eigen::VectorXd near = std::isfinite(end.cost) ? std::move(end.z) : start;
      const Descent down = descend(of_all_sums, few, std::move(near), bound, {kKinkedFall, kMost});
      out.usable = down.is_reachable && (down.is_at_rest || down.steps == kMost);
      out.iterations = down.steps;
      if (out.usable) {
        if (!down.is_at_rest) out.termination = "Iteration limit reached.";
        out.values = unknowns.values(down.z.data());
        return down.z;
      }
    }
  }
  const auto down_from = [&](const Eigen::VectorXd& z) {
    return descend([&](const Eigen::VectorXd& at) { return few.at(at); }, few, z, bound, {kCoarseFall, kMostCoarse});
  };
  Descent coarse = down_from(start);
  const auto or_from = [&](const Eigen::VectorXd& z) {
    Descent other = down_from(z);
    if (other.is_reachable && other.cost < coarse.cost) coarse = std::move(other);
  };
  const Eigen::VectorXd expected = unknowns.scaled_expected();
  if (expected != start) or_from(expected);
  for (const auto& values : options.starts.colwise()) {
    Unknowns further = unknowns;
    further.start = values;
    or_from(further.scaled_start());
    or_from(further.scaled_expected());
  }
  // The valley is as narrow and as curved for all readings as for some of them.
  const Descent fine = descend(of_all_sums, few, coarse.z, bound, {kFall, kMost}, coarse.damping);
  // Of several minima the coarse descent may choose one that all readings like less than the start: Ceres begins anew.
  Model first = model;
  first.set_values(unknowns.values(start.data()));
  const double squared = (measured_mm - accumulator.reading_mm(first)).squaredNorm();
  const double at_start = 0.5 * (squared / (noise_mm * noise_mm) + start.squaredNorm());
  out.usable = fine.is_reachable && !(at_start < fine.cost);
  out.iterations = fine.steps;
  if (!fine.is_at_rest) out.termination = "Iteration limit reached.";
  out.values = unknowns.values(fine.z.data());
  return out.usable ? fine.z : start;
}

/// Fill in what a diagnosis has beyond a fit, and fit coarse to fine where that is worth while. Return what was
/// reached where that came to no end.
Reached diagnose(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
                 Accumulator& accumulator, const Unknowns& unknowns, const FitOptions& options, FitResult& out) {
  const double squared = at_or_throw(accumulator, model, Sums::kResidual).squared;
  out.rms_before_mm = rms(accumulator.residual_mm());
  if (samples.size() < kLeastStride * kFewRows || options.robust_mm > 0.0) {
    out.machine = machine_identifiability(model, accumulator, 1, unknowns, options);
    return {};
  }
  FewReadings few(model, samples, measured_mm, unknowns, options.noise_mm,
                  std::max(kFewRows, samples.size() / kMostStride));
  few.accumulator().start_from(accumulator, few.stride());
  out.machine = machine_identifiability(few.model(), few.accumulator(), few.stride(), unknowns, options);
  const double prior = unknowns.scaled_start().squaredNorm();
  const double at_start = 0.5 * (squared / (options.noise_mm * options.noise_mm) + prior);
  return fit_coarse_to_fine(model, accumulator, few, unknowns, options, at_start, out);
}

/// Compute the covariance of the scaled unknowns to first order: inverse of the readings' information plus the prior's.
Eigen::MatrixXd first_order_spread(const Eigen::MatrixXd& information, const Unknowns& unknowns, double noise_mm) {
  const auto per_noise = unknowns.scale / noise_mm;
  Eigen::MatrixXd total = per_noise.asDiagonal() * information * per_noise.asDiagonal();
  total.diagonal().array() += 1.0;
  return Eigen::LLT<Eigen::MatrixXd>(total).solve(Eigen::MatrixXd::Identity(unknowns.size(), unknowns.size()));
}

/// Throw std::invalid_argument where what is to be fitted is not of one shape, or not finite.
void require_shapes(const Samples& samples, const Eigen::VectorXd& measured_mm, const FitOptions& options) {
  samples.validate();
  if (samples.size() == 0) throw std::invalid_argument("there are no readings to fit");
  if (measured_mm.size() != samples.size()) {
    throw std::invalid_argument("measured_mm has " + std::to_string(measured_mm.size()) + " readings, expected " +
                                std::to_string(samples.size()) + ", one per sample");
  }
  if (options.sweep.size() != 0 && options.sweep.size() != samples.size()) {
    throw std::invalid_argument("sweep has " + std::to_string(options.sweep.size()) + " entries, expected " +
                                std::to_string(samples.size()) + ", one per sample");
  }
  for (Eigen::Index row = 0; row < measured_mm.size(); ++row) {
    if (!std::isfinite(measured_mm[row])) {
      throw std::invalid_argument("measured_mm[" + std::to_string(row) + "] is not finite");
    }
  }
  if (!(options.noise_mm > 0.0)) throw std::invalid_argument("noise_mm must be greater than 0");
}

/// Fit to samples as they are.
FitResult fit_as_read(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
                      const FitOptions& options) {
  FitResult out;
  const Unknowns unknowns = make_unknowns(model, options);
  if (unknowns.size() == 0) throw std::invalid_argument("no value of the model is free");
  out.free_columns = unknowns.columns;
  Accumulator accumulator(samples, measured_mm, unknowns.columns, options.robust_mm);
  Eigen::VectorXd z = unknowns.scaled_start();
  if (options.hypothesis && options.robust_mm == 0.0) {
    z = fit_hypothesis(model, samples, measured_mm, accumulator, unknowns, options, out);
  }
  Reached reached;
  if (!options.hypothesis) reached = diagnose(model, samples, measured_mm, accumulator, unknowns, options, out);
  if (!out.usable) minimize_all(model, accumulator, unknowns, options, z, std::move(reached), out);

  Model fitted = model;
  fitted.set_values(out.values);
  const NormalEquations& after = at_or_throw(accumulator, fitted, options.covariance ? Sums::kAll : Sums::kResidual);
  out.residual_mm = accumulator.residual_mm();
  out.rms_after_mm = rms(out.residual_mm);
  // Under Huber's loss the weighted rows keep glitches out of the noise.
  out.noise_mm = std::max(options.noise_mm, std::sqrt(after.squared / static_cast<double>(samples.size())));
  if (!options.covariance) return out;
  if (options.sweep.size() != 0) out.correlation = autocorrelation_time(out.residual_mm, options.sweep);
  const double effective_mm = out.noise_mm * std::sqrt(out.correlation);
  Eigen::MatrixXd spread = first_order_spread(after.information, unknowns, effective_mm);
  if (!options.hypothesis) spread += spread_of_curvature(fitted, samples, accumulator, unknowns, spread, effective_mm);
  out.covariance = Eigen::MatrixXd::Zero(model.size(), model.size());
  out.covariance(unknowns.columns, unknowns.columns) =
      unknowns.scale.asDiagonal() * spread * unknowns.scale.asDiagonal();
  return out;
}

/// Fit where readings may be late: to samples as they are when the gauge is read, until that is the same as fitted.
FitResult fit_late(Model model, const Samples& samples, const Eigen::VectorXd& measured_mm, FitOptions options) {
  constexpr double kSame_s = 0.1e-3;  // 6 um of a slider at 60 mm/s: of a pitch error of 10 mm a fifth of a degree
  constexpr int kMost = 5;            // fits; each divides what the delay is off by ten and more
  FitResult out = fit_as_read(model, when_read(model, samples), measured_mm, options);
  for (int fits = 1; fits < kMost; ++fits) {
    const double before_s = late_s(model);
    model.set_values(out.values);
    if (std::abs(late_s(model) - before_s) < kSame_s) break;
    options.from_minimum = true;
    options.starts.resize(0, 0);
    FitResult next = fit_as_read(model, when_read(model, samples), measured_mm, options);
    next.machine = out.machine;
    next.rms_before_mm = out.rms_before_mm;
    next.iterations += out.iterations;
    out = std::move(next);
  }
  return out;
}

}  // namespace

FitResult fit(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm,
              const FitOptions& options) {
  if (samples.state.row.size() > 0 && has_table(model)) {
    require_columns(model, samples);
    Samples alone = samples;
    alone.state.row.resize(0);
    return fit(of_rows(model, samples.state.row), alone, measured_mm, options);
  }
  require_shapes(samples, measured_mm, options);
  if (may_be_late(model)) return fit_late(model, samples, measured_mm, options);
  return fit_as_read(model, samples, measured_mm, options);
}

}  // namespace hexdbb
