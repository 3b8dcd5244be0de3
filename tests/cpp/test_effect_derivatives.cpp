// Every effect's derivatives, through the whole prediction, against central differences: at values other than zero,
// with all other effects present. One test per effect of the catalogue, so that a new effect is tested automatically.
#include <gtest/gtest.h>

#include <cmath>

#include "circles.hpp"
#include "drawing.hpp"
#include "hexdbb/diagnosis.hpp"
#include "read_late.hpp"
#include "refusal.hpp"

namespace hexdbb::testing {
namespace {

constexpr int kMounts = 2;

class EffectDerivatives : public ::testing::TestWithParam<std::string> {
 protected:
  Machine machine;
  Samples samples = [this] {
    std::vector<CircleSpec> circles = seven_circles();
    circles[1].mount = circles[4].mount = 1;
    circles.push_back({Vector3::Zero(), Vector3(0.14, 0.0, 0.0), 1});
    return moving_samples(machine, circles, 40);
  }();
  Model model = model_of_everything(machine, kMounts);
};

TEST_P(EffectDerivatives, AgainstDifferences) {
  Eigen::VectorXd sizes = 2.0 * prior_sigmas(model);
  Eigen::VectorXd steps = 5e-3 * sizes;
  int first = -1, count = 0;
  Eigen::Index at = 0;
  for (const Term& term : model.terms) {
    const EffectInfo& info = term.effect->info();
    if (info.name == GetParam()) {
      first = static_cast<int>(at);
      count = info.size();
    }
    for (int j = 0; j < info.size(); ++j, ++at) {
      if (info.parameters[static_cast<std::size_t>(j) % info.parameters.size()].is_shape) steps[at] *= 0.1;
    }
  }
  ASSERT_GT(count, 0);
  Drawing drawing(41);
  model.set_values(sizes.cwiseProduct(drawing.normals(model.size())));
  // The place at which effects act counts as given: where readings are late, the sliders' when the gauge is read.
  samples = when_read(model, samples);
  const Prediction predicted = predict(model, samples, true);
  ASSERT_EQ(predicted.first_failure(), -1);
  for (int value = first; value < first + count; ++value) {
    // Of two steps (Richardson): what decays within milliseconds bends within one.
    const Eigen::VectorXd whole = difference(model, samples, value, steps[value]);
    const Eigen::VectorXd half = difference(model, samples, value, 0.5 * steps[value]);
    const Eigen::VectorXd slope = (4.0 * half - whole) / 3.0;
    const double largest = slope.cwiseAbs().maxCoeff();
    ASSERT_GT(largest, 0.0) << "value " << value - first << " has no effect anywhere";
    // All readings of the differences are solved to the kinematics' tolerance, which the steps divide: 8/3 and 1/3 of it.
    const double rounding = 3.0 * kResidualTolerance_mm / steps[value];
    EXPECT_LT((predicted.jacobian.col(value) - slope).cwiseAbs().maxCoeff(), 1e-6 * largest + rounding)
        << "value " << value - first;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EffectDerivatives, ::testing::ValuesIn(effect_names()),
                         [](const auto& info) { return info.param; });

TEST(Effects, ThereAreThirtyThreeGeometricErrors) {
  const Machine machine;
  int total = 0;
  for (const std::string& name : effect_names(group::kGeometry)) {
    const EffectInfo info = find_effect(machine, kMounts, name)->info();
    EXPECT_FALSE(info.is_set_up);
    total += info.size();
  }
  EXPECT_EQ(total, 33);
  for (const std::string& name : effect_names(group::kSetUp)) {
    EXPECT_TRUE(find_effect(machine, kMounts, name)->info().is_set_up);
  }
  EXPECT_TRUE(find_effect(machine, kMounts, "ball_rotation")->info().is_set_up);
  EXPECT_EQ(find_effect(machine, kMounts, "cup_position")->info().size(), 3 * kMounts);
}

TEST(Effects, UnknownNameIsRefusedWithTheKnownOnes) {
  const std::string said = refusal([] { find_effect(Machine(), 1, "leg_lenght"); });
  EXPECT_TRUE(contains(said, "\"leg_lenght\"")) << said;
  for (const std::string& name : effect_names()) EXPECT_TRUE(contains(said, name)) << said;
}

}  // namespace
}  // namespace hexdbb::testing
