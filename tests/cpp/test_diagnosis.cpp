// Diagnosis: inject known errors, recover what the readings can tell of them, and say what they cannot.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "circles.hpp"
#include "drawing.hpp"
#include "hexdbb/diagnosis.hpp"
#include "refusal.hpp"

namespace hexdbb::testing {
namespace {

constexpr double kNoise_mm = 0.5e-3;

std::vector<CircleSpec> nine_circles() {
  std::vector<CircleSpec> circles = seven_circles();
  circles.push_back({Vector3::Zero(), Vector3(0.14, 0.0, 0.0), 0});
  circles.push_back({Vector3::Zero(), Vector3(0.0, 0.14, 0.0), 0});
  return circles;
}

class Diagnosis : public ::testing::Test {
 protected:
  Machine machine;
  // Two circles in tilted planes beside the seven: horizontal ones see the cup's height in second order only.
  Samples samples = circle_samples(machine, nine_circles(), 120);
  Model model = full_model(machine, 1);
  Eigen::VectorXd scale = expected_sizes(model);
  FitOptions options = [this] {
    FitOptions out;
    out.noise_mm = kNoise_mm;
    out.free.assign(static_cast<std::size_t>(model.size()), true);
    out.free.back() = false;  // the calibrated bar length
    return out;
  }();

  /// Readings of a machine with these values, gauge noise on top.
  Eigen::VectorXd measure(const Eigen::VectorXd& truth, int seed, double noise_mm = kNoise_mm) const {
    Model real = model;
    real.set_values(truth);
    const Prediction predicted = predict(real, samples, false);
    EXPECT_EQ(predicted.first_failure(), -1);
    Drawing drawing(static_cast<std::uint64_t>(seed));
    return predicted.reading_mm + noise_mm * drawing.normals(samples.size());
  }

  Eigen::VectorXd draw_truth(int seed) const {
    Drawing drawing(static_cast<std::uint64_t>(seed));
    Eigen::VectorXd truth = 0.5 * scale.cwiseProduct(drawing.normals(model.size()));
    truth[model.size() - 1] = 0.0;
    return truth;
  }

  /// Scaled coordinates along the identifiable directions.
  Eigen::VectorXd known_part(const FitResult& result, const Eigen::VectorXd& values) const {
    Eigen::VectorXd scaled(static_cast<Eigen::Index>(result.free_columns.size()));
    for (Eigen::Index j = 0; j < scaled.size(); ++j) {
      const int column = result.free_columns[static_cast<std::size_t>(j)];
      scaled[j] = values[column] / scale[column];
    }
    return result.identifiability.identifiable().transpose() * scaled;
  }

  /// Standard deviations of the same coordinates, from the stated covariance.
  Eigen::VectorXd known_sigma(const FitResult& result) const {
    Eigen::MatrixXd scaled(result.identifiability.directions.rows(), result.identifiability.directions.rows());
    for (Eigen::Index i = 0; i < scaled.rows(); ++i) {
      for (Eigen::Index j = 0; j < scaled.cols(); ++j) {
        const int row = result.free_columns[static_cast<std::size_t>(i)];
        const int column = result.free_columns[static_cast<std::size_t>(j)];
        scaled(i, j) = result.covariance(row, column) / (scale[row] * scale[column]);
      }
    }
    const Eigen::MatrixXd basis = result.identifiability.identifiable();
    return (basis.transpose() * scaled * basis).diagonal().cwiseSqrt();
  }
};

TEST_F(Diagnosis, RecoversWhatCanBeKnown) {
  const FitResult probe = fit(model, samples, Eigen::VectorXd::Zero(samples.size()), options);
  const Eigen::MatrixXd basis = probe.identifiability.identifiable();
  for (int seed = 1; seed <= 5; ++seed) {
    // Errors in the directions that can be known; what lies across them would show in second order and shift the answer.
    Eigen::VectorXd truth = Eigen::VectorXd::Zero(model.size());
    const Eigen::VectorXd known = basis * known_part(probe, draw_truth(seed));
    for (Eigen::Index j = 0; j < known.size(); ++j) truth[j] = scale[j] * known[j];
    const FitResult result = fit(model, samples, measure(truth, 100 + seed), options);
    ASSERT_TRUE(result.usable) << result.termination;
    EXPECT_GT(result.rms_before_mm, 20.0 * kNoise_mm);
    EXPECT_NEAR(result.rms_after_mm, kNoise_mm, 0.1 * kNoise_mm);
    EXPECT_EQ(result.identifiability.rank, 27);  // 24 of the machine, cup and ball, that one level plane leaves open less
    const Eigen::VectorXd miss = known_part(result, result.values) - known_part(result, truth);
    EXPECT_LT(miss.cwiseQuotient(known_sigma(result)).cwiseAbs().maxCoeff(), 4.0) << "seed " << seed;
  }
}

TEST_F(Diagnosis, ExplainsAnyErrorsOfTheExpectedSize) {
  for (int seed = 1; seed <= 5; ++seed) {
    const FitResult result = fit(model, samples, measure(2.0 * draw_truth(seed), 120 + seed), options);
    ASSERT_TRUE(result.usable) << result.termination;
    EXPECT_NEAR(result.rms_after_mm, kNoise_mm, 0.1 * kNoise_mm) << "seed " << seed;
  }
}

TEST_F(Diagnosis, HorizontalCirclesLeaveTheCupsHeightOpenAndTheMisfitShows) {
  // The bar is off level then and reads delta^2 / 200 mm longer: nothing to first order, 5 um at 1 mm.
  Eigen::VectorXd truth = draw_truth(4);
  truth[35] = 1.0;
  const FitResult nine = fit(model, samples, measure(truth, 113), options);
  samples = circle_samples(machine, seven_circles(), 120);
  const FitResult seven = fit(model, samples, measure(truth, 113), options);
  EXPECT_EQ(nine.identifiability.rank, 27);
  EXPECT_EQ(seven.identifiability.rank, 26);
  EXPECT_NEAR(nine.rms_after_mm, kNoise_mm, 0.1 * kNoise_mm);
  EXPECT_LT(seven.rms_after_mm, 2.0 * kNoise_mm);
  EXPECT_GT(seven.noise_mm, 1.2 * kNoise_mm);  // the stated uncertainties are stretched to match
}

TEST_F(Diagnosis, StatedUncertaintiesAreTheRealOnes) {
  // Mean squared normalised miss over many directions and seeds is 1 for honest sigmas.
  double sum = 0.0;
  int count = 0;
  for (int seed = 1; seed <= 12; ++seed) {
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(model.size());
    const FitResult result = fit(model, samples, measure(nothing, 200 + seed), options);
    ASSERT_TRUE(result.usable);
    const Eigen::VectorXd normalised = known_part(result, result.values).cwiseQuotient(known_sigma(result));
    sum += normalised.squaredNorm();
    count += static_cast<int>(normalised.size());
  }
  EXPECT_NEAR(sum / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST_F(Diagnosis, CountsResidualsAndParameters) {
  const FitResult result = fit(model, samples, measure(draw_truth(6), 106), options);
  EXPECT_EQ(result.residual_mm.size(), 9 * 120);
  EXPECT_EQ(result.values.size(), 33 + 3 + 3 + 1);
  EXPECT_EQ(result.covariance.rows(), 40);
  EXPECT_EQ(result.covariance.cols(), 40);
  EXPECT_EQ(result.identifiable.size(), 40u);
  EXPECT_EQ(result.free_columns.size(), 39u);
  EXPECT_EQ(result.identifiability.directions.rows(), 39);
  EXPECT_EQ(result.values[39], 0.0);  // held
  EXPECT_TRUE(result.covariance.row(39).isZero() && result.covariance.col(39).isZero());
  EXPECT_FALSE(result.identifiable[39]);
  EXPECT_GT(result.iterations, 0);
  EXPECT_LE(result.iterations, 25);
  EXPECT_LT((result.residual_mm - (measure(draw_truth(6), 106) - [&] {
               Model fitted = model;
               fitted.set_values(result.values);
               return predict(fitted, samples, false).reading_mm;
             }())).norm(),
            1e-12);
}

TEST_F(Diagnosis, UnknownDirectionsKeepTheirPlace) {
  const FitResult result = fit(model, samples, measure(draw_truth(7), 107), options);
  const Eigen::MatrixXd loose = result.identifiability.unidentifiable();
  Eigen::VectorXd scaled(39);
  for (Eigen::Index j = 0; j < 39; ++j) scaled[j] = result.values[j] / scale[j];
  EXPECT_LT((loose.transpose() * scaled).cwiseAbs().maxCoeff(), 1e-9 * scaled.norm());
}

TEST_F(Diagnosis, StartInKnownDirectionsDoesNotMatter) {
  const Eigen::VectorXd measured = measure(draw_truth(8), 108);
  const FitResult first = fit(model, samples, measured, options);
  ASSERT_TRUE(first.usable);
  Drawing drawing(81);
  const Eigen::MatrixXd basis = first.identifiability.identifiable();
  Eigen::VectorXd start = Eigen::VectorXd::Zero(model.size());
  const Eigen::VectorXd along = basis * drawing.normals(basis.cols());
  for (Eigen::Index j = 0; j < along.size(); ++j) start[j] = scale[j] * along[j];
  Model perturbed = model;
  perturbed.set_values(start);
  const FitResult second = fit(perturbed, samples, measured, options);
  ASSERT_TRUE(second.usable);
  EXPECT_GT(std::abs(second.rms_before_mm - first.rms_before_mm), 10.0 * kNoise_mm);  // it did start elsewhere
  EXPECT_NEAR(second.rms_after_mm, first.rms_after_mm, 1e-9);
  EXPECT_LT((second.values - first.values).cwiseQuotient(scale).cwiseAbs().maxCoeff(), 1e-4);
}

TEST_F(Diagnosis, NoiseFromTheResidualsWhereNoneIsStated) {
  options.noise_is_stated = false;
  options.noise_mm = 5.0 * kNoise_mm;  // a wrong guess
  const FitResult result = fit(model, samples, measure(draw_truth(9), 109), options);
  EXPECT_NEAR(result.noise_mm, kNoise_mm, 0.1 * kNoise_mm);
}

TEST_F(Diagnosis, MisfitStretchesTheUncertainty) {
  Eigen::VectorXd measured = measure(draw_truth(10), 110);
  for (Eigen::Index row = 0; row < measured.size(); row += 2) measured[row] += 0.01;  // no geometry does this
  const FitResult result = fit(model, samples, measured, options);
  EXPECT_NEAR(result.noise_mm, 5e-3, 1e-3);
  EXPECT_GT(result.rms_after_mm, 4e-3);
}

TEST_F(Diagnosis, FreeSubsetIsRecoveredOnItsOwn) {
  options.free.assign(40, false);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(40);
  for (int j : {0, 2, 4}) {  // one leg of each pair
    options.free[static_cast<std::size_t>(j)] = true;
    truth[j] = 0.03 * (j + 1);
  }
  const FitResult result = fit(model, samples, measure(truth, 111), options);
  EXPECT_EQ(result.identifiability.rank, 3);
  for (int j : {0, 2, 4}) {
    EXPECT_TRUE(result.identifiable[static_cast<std::size_t>(j)]);
    EXPECT_NEAR(result.values[j], truth[j], 4.0 * std::sqrt(result.covariance(j, j)));
  }
  for (int j : {1, 3, 5, 6, 39}) EXPECT_EQ(result.values[j], 0.0);
}

TEST_F(Diagnosis, NothingKnownIsRankZero) {
  // One level circle, ball in the joint plane: guideways that stand higher do not show.
  samples = circle_samples(machine, {CircleSpec()}, 90, {0.0, 0.0, 300.0}, {0.0, 0.0, 20.0});
  options.free.assign(40, false);
  for (int j : {14, 17, 20}) options.free[static_cast<std::size_t>(j)] = true;  // z of the guideway translations
  const FitResult result = fit(model, samples, measure(Eigen::VectorXd::Zero(40), 112), options);
  EXPECT_EQ(result.identifiability.rank, 0);
  EXPECT_TRUE(result.values.isZero());
  EXPECT_TRUE(result.covariance.isZero());
  EXPECT_TRUE(contains(result.termination, "rank 0")) << result.termination;
  EXPECT_FALSE(result.usable);
  EXPECT_EQ(result.rms_after_mm, result.rms_before_mm);
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
  EXPECT_THROW(fit(model, rows(samples, {}), Eigen::VectorXd(0), options), std::invalid_argument);
  FitOptions short_free = options;
  short_free.free.pop_back();
  EXPECT_EQ(refusal([&] { fit(model, samples, measured, short_free); }), "free has 39 entries, expected 40");
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
