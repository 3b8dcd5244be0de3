// Diagnosis: inject known errors, recover what the readings determine, and report what they do not.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "circles.hpp"
#include "drawing.hpp"
#include "hexdbb/diagnosis.hpp"
#include "hexdbb/normal_equations.hpp"
#include "refusal.hpp"

namespace hexdbb::testing {
namespace {

constexpr double kNoise_mm = 0.5e-3;

class Diagnosis : public ::testing::Test {
 protected:
  Machine machine;
  Samples samples = circle_samples(machine, seven_circles(), 120);
  Model model = full_model(machine, 1);
  Eigen::VectorXd scale = prior_sigmas(model);
  FitOptions options = [this] {
    FitOptions out;
    out.noise_mm = kNoise_mm;
    out.free.assign(static_cast<std::size_t>(model.size()), true);
    out.free.back() = false;  // the calibrated bar length
    return out;
  }();

  /// Return readings of a machine with these values, with gauge noise.
  Eigen::VectorXd measure(const Eigen::VectorXd& truth, int seed) const {
    Model real = model;
    real.set_values(truth);
    const Prediction predicted = predict(real, samples, false);
    EXPECT_EQ(predicted.first_failure(), -1);
    Drawing drawing(static_cast<std::uint64_t>(seed));
    return predicted.reading_mm + kNoise_mm * drawing.normals(samples.size());
  }

  /// Draw errors from the prior.
  Eigen::VectorXd draw_truth(int seed) const {
    Drawing drawing(static_cast<std::uint64_t>(seed));
    Eigen::VectorXd truth = scale.cwiseProduct(drawing.normals(model.size()));
    truth[model.size() - 1] = 0.0;
    return truth;
  }

  Eigen::VectorXd residual(const FitResult& result, const Eigen::VectorXd& measured) const {
    Model fitted = model;
    fitted.set_values(result.values);
    return measured - predict(fitted, samples, false).reading_mm;
  }

  /// Return the largest component of Newton's step from the end of a fit, in standard deviations of each value.
  double distance_to_minimum(const FitResult& result, const Eigen::VectorXd& measured) const {
    const auto& free = result.free_columns;
    Model there = model;
    there.set_values(result.values);
    const NormalEquations equations = normal_equations(there, samples, measured);
    const double weight = 1.0 / (kNoise_mm * kNoise_mm);
    const Eigen::VectorXd prior = prior_sigmas(model)(free).cwiseAbs2().cwiseInverse();
    Eigen::MatrixXd information = weight * equations.information(free, free);
    information.diagonal() += prior;
    const Eigen::VectorXd downhill = weight * equations.gradient(free) - prior.cwiseProduct(result.values(free));
    const Eigen::VectorXd sigma = result.covariance(free, free).diagonal().cwiseSqrt();
    return information.ldlt().solve(downhill).cwiseQuotient(sigma).cwiseAbs().maxCoeff();
  }
};

/// Errors of the free values along the principal directions of their stated covariance, in its own standard deviations;
/// best determined last.
struct Misses {
  Eigen::VectorXd in_sigmas;
  Eigen::VectorXd sigma;  // in prior standard deviations
};

Misses misses(const FitResult& result, const Eigen::VectorXd& truth, const Eigen::VectorXd& scale) {
  const auto& free = result.free_columns;
  const Eigen::VectorXd inverse = scale(free).cwiseInverse();
  const Eigen::MatrixXd covariance = inverse.asDiagonal() * result.covariance(free, free) * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(covariance);
  const Eigen::VectorXd miss = (result.values - truth)(free).cwiseProduct(inverse);
  const Eigen::VectorXd sigma = principal.eigenvalues().cwiseSqrt().reverse();
  return {(principal.eigenvectors().transpose() * miss).reverse().cwiseQuotient(sigma), sigma};
}

TEST_F(Diagnosis, RecoversWhatIsIdentifiable) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Eigen::VectorXd truth = draw_truth(seed);
    const FitResult result = fit(model, samples, measure(truth, 100 + seed), options);
    ASSERT_TRUE(result.usable) << result.termination;
    EXPECT_GT(result.rms_before_mm, 100.0 * kNoise_mm);
    EXPECT_NEAR(result.rms_after_mm, kNoise_mm, 0.1 * kNoise_mm) << "seed " << seed;
    EXPECT_EQ(result.machine.rank, 21);
    const Misses found = misses(result, truth, scale);
    EXPECT_LT(found.in_sigmas.cwiseAbs().maxCoeff(), 4.0) << "seed " << seed;
    EXPECT_LT(found.sigma.tail(20).maxCoeff(), 0.05);  // and not by stating large uncertainties
  }
}

TEST_F(Diagnosis, StatedUncertaintiesAreCorrect) {
  // The mean squared error in stated standard deviations is 1 where they are right, over many directions and machines.
  double sum = 0.0;
  int count = 0;
  for (int seed = 1; seed <= 12; ++seed) {
    const Eigen::VectorXd truth = draw_truth(200 + seed);
    const FitResult result = fit(model, samples, measure(truth, 300 + seed), options);
    ASSERT_TRUE(result.usable);
    const Misses found = misses(result, truth, scale);
    sum += found.in_sigmas.squaredNorm();
    count += static_cast<int>(found.in_sigmas.size());
  }
  EXPECT_NEAR(sum / count, 1.0, 5.0 * std::sqrt(2.0 / count));
}

TEST_F(Diagnosis, CountsResidualsAndParameters) {
  const Eigen::VectorXd measured = measure(draw_truth(6), 106);
  const FitResult result = fit(model, samples, measured, options);
  EXPECT_EQ(result.residual_mm.size(), 7 * 120);
  EXPECT_EQ(result.values.size(), 33 + 3 + 3 + 1);
  EXPECT_EQ(result.covariance.rows(), 40);
  EXPECT_EQ(result.covariance.cols(), 40);
  EXPECT_EQ(result.free_columns.size(), 39u);
  EXPECT_EQ(result.machine.directions.rows(), 33);
  EXPECT_EQ(result.values[39], 0.0);  // held
  EXPECT_TRUE(result.covariance.row(39).isZero() && result.covariance.col(39).isZero());
  EXPECT_TRUE(result.covariance.isApprox(result.covariance.transpose()));
  EXPECT_GT(result.iterations, 0);
  EXPECT_LE(result.iterations, 25);
  EXPECT_LT((result.residual_mm - residual(result, measured)).cwiseAbs().maxCoeff(), 10 * kResidualTolerance_mm);
}

TEST_F(Diagnosis, PerfectMachineStaysPerfect) {
  const FitResult result = fit(model, samples, Eigen::VectorXd::Zero(samples.size()), options);
  EXPECT_LT(result.values.cwiseQuotient(scale).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT(result.rms_after_mm, 1e-9);
  EXPECT_EQ(result.noise_mm, kNoise_mm);  // not less than the stated noise of the gauge
}

TEST_F(Diagnosis, NullDirectionsKeepTheirPrior) {
  // A guideway moved along itself and both its sliders moved back: no reading changes, so value and sigma stay the
  // prior's.
  const FitResult result = fit(model, samples, measure(draw_truth(7), 107), options);
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(40);
  direction[6] = direction[7] = direction[13] = 0.1;  // slider offsets 1 and 2, y of guideway 1: all mm of one size
  direction.normalize();
  const double sigma = std::sqrt(direction.dot(result.covariance * direction));
  EXPECT_NEAR(sigma, 0.1, 1e-3);
  EXPECT_LT(std::abs(direction.dot(result.values)), 1e-3);
}

TEST_F(Diagnosis, APriorThreeTimesAsWideHoldsAThirdAsMuch) {
  FitOptions wide = options;
  wide.prior_scale = Eigen::VectorXd::Constant(model.size(), 3.0);
  const Eigen::VectorXd measured = measure(draw_truth(7), 107);
  const FitResult normal = fit(model, samples, measured, options), wider = fit(model, samples, measured, wide);
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(40);
  direction[6] = direction[7] = direction[13] = 1.0;  // what no reading sees, as above
  const auto sigma = [&](const FitResult& result) { return std::sqrt(direction.dot(result.covariance * direction)); };
  EXPECT_NEAR(sigma(wider), 3.0 * sigma(normal), 0.01 * sigma(wider));
  // What the prior pulls at is what readings hardly tell: all of it together is smaller in the wider prior's units.
  const auto pulled = [&](const FitResult& result) { return result.values.cwiseQuotient(scale).norm(); };
  EXPECT_GT(pulled(wider), pulled(normal));
  EXPECT_LE(wider.rms_after_mm, normal.rms_after_mm);
}

TEST_F(Diagnosis, StartDoesNotMatter) {
  const Eigen::VectorXd measured = measure(draw_truth(8), 108);
  const FitResult first = fit(model, samples, measured, options);
  Model perturbed = model;
  perturbed.set_values(draw_truth(9));
  const FitResult second = fit(perturbed, samples, measured, options);
  ASSERT_TRUE(first.usable && second.usable);
  EXPECT_GT(std::abs(second.rms_before_mm - first.rms_before_mm), 10.0 * kNoise_mm);  // the starts did differ
  EXPECT_NEAR(second.rms_after_mm, first.rms_after_mm, 1e-8);
  EXPECT_LT((second.values - first.values).cwiseQuotient(scale).cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(Diagnosis, CoarseToFineEndsAtTheMinimumOfAllReadings) {
  // 12,600 readings: the way is on a part of them. A loss that is linear beyond 1 m is least squares too, and goes by
  // Ceres on all readings from the start.
  samples = circle_samples(machine, seven_circles(), 1800);
  const Eigen::VectorXd measured = measure(draw_truth(21), 121);
  const FitResult result = fit(model, samples, measured, options);
  FitOptions on_all = options;
  on_all.robust_mm = 1e3;
  const FitResult expected = fit(model, samples, measured, on_all);
  ASSERT_TRUE(result.usable && expected.usable);
  EXPECT_LT(result.iterations, expected.iterations);
  const auto& free = result.free_columns;
  const Eigen::VectorXd sigma = expected.covariance(free, free).diagonal().cwiseSqrt();
  EXPECT_LT((result.values - expected.values)(free).cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 2e-3);
  // The other fit ends where no step pays 1e-9 of its cost: how far the minimum is, Newton's step says better.
  EXPECT_LT(distance_to_minimum(result, measured), 1e-4);
  EXPECT_LT((result.covariance(free, free).diagonal().cwiseSqrt().cwiseQuotient(sigma).array() - 1.0).abs().maxCoeff(),
            1e-4);
  EXPECT_EQ(result.machine.rank, expected.machine.rank);
  EXPECT_NEAR(result.machine.condition, expected.machine.condition, 1e-9 * expected.machine.condition);
  EXPECT_LT((result.residual_mm - residual(result, measured)).cwiseAbs().maxCoeff(), 10 * kResidualTolerance_mm);
}

TEST_F(Diagnosis, CoarseToFineWithEffectsThatDependOnTheState) {
  // Geometry is affine in the sliders' coordinates; play and the places of two set-ups are not.
  std::vector<CircleSpec> circles = seven_circles();
  for (std::size_t at = 4; at < circles.size(); ++at) circles[at].mount = 1;
  samples = moving_samples(machine, circles, 1300);
  model = full_model(machine, 2);
  model.add(find_effect(machine, 2, "backlash"));
  scale = prior_sigmas(model);
  options.free.clear();
  Drawing drawing(23);
  const Eigen::VectorXd measured = measure(0.5 * scale.cwiseProduct(drawing.normals(model.size()).cwiseAbs()), 123);
  const FitResult result = fit(model, samples, measured, options);
  ASSERT_TRUE(result.usable);
  EXPECT_LT(result.rms_after_mm, 1.05 * kNoise_mm);
  EXPECT_LT(distance_to_minimum(result, measured), 1e-4);
  EXPECT_LT((result.residual_mm - residual(result, measured)).cwiseAbs().maxCoeff(), 10 * kResidualTolerance_mm);
}

TEST_F(Diagnosis, MisfitStretchesTheUncertainty) {
  Eigen::VectorXd measured = measure(draw_truth(10), 110);
  const FitResult clean = fit(model, samples, measured, options);
  for (Eigen::Index row = 0; row < measured.size(); row += 2) measured[row] += 0.01;  // no geometry can explain this
  const FitResult result = fit(model, samples, measured, options);
  EXPECT_NEAR(result.noise_mm, 5e-3, 1e-3);
  EXPECT_GT(result.rms_after_mm, 4e-3);
  EXPECT_GT(result.covariance.trace(), clean.covariance.trace());
}

TEST_F(Diagnosis, FreeSubsetIsRecoveredOnItsOwn) {
  options.free.assign(40, false);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(40);
  for (int j : {0, 2, 4}) {  // one leg of each pair
    options.free[static_cast<std::size_t>(j)] = true;
    truth[j] = 0.03 * (j + 1);
  }
  const FitResult result = fit(model, samples, measure(truth, 111), options);
  EXPECT_EQ(result.machine.rank, 3);
  for (int j = 0; j < 40; ++j) {
    if (options.free[static_cast<std::size_t>(j)]) {
      const double sigma = std::sqrt(result.covariance(j, j));
      EXPECT_NEAR(result.values[j], truth[j], 4.0 * sigma);
      EXPECT_LT(sigma, 3e-4);
    } else {
      EXPECT_EQ(result.values[j], 0.0);
      EXPECT_EQ(result.covariance(j, j), 0.0);
    }
  }
}

TEST_F(Diagnosis, NothingIdentifiableIsRankZero) {
  // One level circle, ball in the joint plane: the height of the guideways does not affect the readings.
  samples = circle_samples(machine, {CircleSpec()}, 90, {0.0, 0.0, 300.0}, {0.0, 0.0, 20.0});
  options.free.assign(40, false);
  for (int j : {14, 17, 20}) options.free[static_cast<std::size_t>(j)] = true;  // z of the guideway translations
  const FitResult result = fit(model, samples, measure(Eigen::VectorXd::Zero(40), 112), options);
  EXPECT_EQ(result.machine.rank, 0);
  EXPECT_EQ(result.machine.condition, 0.0);
  for (int j : {14, 17, 20}) {
    EXPECT_NEAR(std::sqrt(result.covariance(j, j)), scale[j], 0.01 * scale[j]);  // the prior
    EXPECT_LT(std::abs(result.values[j]), scale[j]);
  }
  EXPECT_NEAR(result.rms_after_mm, result.rms_before_mm, 0.02 * kNoise_mm);
}

TEST_F(Diagnosis, UnreachableStartIsRefusedByRow) {
  samples.sliders_mm(33, 0) = 20.0;
  samples.sliders_mm(33, 1) = 840.0;
  const std::string said = refusal([this] { fit(model, samples, Eigen::VectorXd::Zero(samples.size()), options); });
  EXPECT_TRUE(contains(said, "sample 33: unreachable")) << said;
}

TEST_F(Diagnosis, ShapesThatDisagreeAreRefused) {
  const Eigen::VectorXd measured = Eigen::VectorXd::Zero(samples.size());
  EXPECT_THROW(fit(model, samples, measured.head(10), options), std::invalid_argument);
  EXPECT_THROW(fit(model, samples.rows({}), Eigen::VectorXd(0), options), std::invalid_argument);
  FitOptions short_free = options;
  short_free.free.pop_back();
  EXPECT_EQ(refusal([&] { fit(model, samples, measured, short_free); }), "free has 39 entries, expected 40");
  FitOptions held = options;
  held.free.assign(static_cast<std::size_t>(model.size()), false);
  EXPECT_EQ(refusal([&] { fit(model, samples, measured, held); }), "no value of the model is free");
  FitOptions unscaled = options;
  unscaled.prior_scale = Eigen::VectorXd::Ones(3);
  EXPECT_EQ(refusal([&] { fit(model, samples, measured, unscaled); }),
            "prior_scale: expected 40 factors greater than 0");
  unscaled.prior_scale = Eigen::VectorXd::Zero(model.size());
  EXPECT_EQ(refusal([&] { fit(model, samples, measured, unscaled); }),
            "prior_scale: expected 40 factors greater than 0");
  FitOptions begun = options;
  begun.starts = Eigen::MatrixXd::Zero(3, 2);
  EXPECT_EQ(refusal([&] { fit(model, samples, measured, begun); }), "starts: expected 40 rows, one per value");
  FitOptions silent = options;
  silent.noise_mm = 0.0;
  EXPECT_THROW(fit(model, samples, measured, silent), std::invalid_argument);
}

TEST_F(Diagnosis, ReadingThatIsNotANumberIsRefused) {
  Eigen::VectorXd measured = Eigen::VectorXd::Zero(samples.size());
  measured[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fit(model, samples, measured, options), std::invalid_argument);
}

}  // namespace
}  // namespace hexdbb::testing
