// Prediction in batch: the same as sample by sample, whatever the order of the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "circles.hpp"
#include "drawing.hpp"

namespace hexdbb::testing {
namespace {

class PredictionTest : public ::testing::Test {
 protected:
  Machine machine;
  Samples samples = circle_samples(machine, seven_circles(), 25);
  Model model = [this] {
    Model out = full_model(machine, 1);
    Drawing drawing(61);
    out.set_values(0.05 * drawing.normals(out.size()));
    for (Term& term : out.terms) {
      if (term.effect->info().parameters[0].unit == "rad") term.values *= 0.01;
    }
    return out;
  }();
};

TEST_F(PredictionTest, BatchEqualsSingle) {
  const Prediction batch = predict(model, samples, true);
  ASSERT_EQ(batch.first_failure(), -1);
  for (Eigen::Index row = 0; row < samples.size(); row += 3) {
    const Prediction single = predict(model, samples.rows({row}), true);
    ASSERT_EQ(single.status[0], 0);
    EXPECT_NEAR(single.reading_mm[0], batch.reading_mm[row], 1e-11);
    EXPECT_LT((single.jacobian.row(0) - batch.jacobian.row(row)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST_F(PredictionTest, BatchEqualsTheSixCoordinateSolver) {
  const Prediction batch = predict(model, samples, false);
  for (Eigen::Index row = 0; row < samples.size(); row += 5) {
    Eigen::Matrix<double, 1, port::kCount> pushed = Eigen::Matrix<double, 1, port::kCount>::Zero();
    for (const Term& term : model.terms) {
      Eigen::Matrix<double, Eigen::Dynamic, port::kCount> ports = pushed;
      term.effect->push({samples, row, 1}, term.values, ports);
      pushed = ports;
    }
    Ports push;
    push.value = pushed.transpose();
    const ForwardResult six =
        forward_six(assemble(model.nominal, samples.sliders_mm.row(row).transpose(), push), home_pose(model.nominal));
    ASSERT_EQ(six.status, Status::kOk);
    EXPECT_NEAR(reading_mm(six.pose, samples.set_ups[0], push), batch.reading_mm[row], 1e-9);
  }
}

TEST_F(PredictionTest, JumpsBetweenCirclesAreFollowed) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(samples.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  Drawing drawing(62);
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<std::size_t>(drawing.uniform(0.0, static_cast<double>(i + 1)))]);
  }
  const Prediction in_order = predict(model, samples, false);
  const Prediction shuffled = predict(model, samples.rows(order), false);
  ASSERT_EQ(shuffled.first_failure(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    ASSERT_NEAR(shuffled.reading_mm[static_cast<Eigen::Index>(i)], in_order.reading_mm[order[i]], 1e-11);
  }
}

TEST_F(PredictionTest, PosesAllOverTheWorkspaceAreFoundWithoutANeighbour) {
  constexpr Eigen::Index kPoses = 4000;
  const NominalGeometry nominal{machine};
  Drawing drawing(63);
  Samples anywhere = samples.rows(std::vector<Eigen::Index>(kPoses, 0));
  std::vector<Pose> poses;
  for (Eigen::Index row = 0; row < kPoses; ++row) {
    const Reached reached = draw_reachable(drawing, nominal, kWorkspace);
    anywhere.sliders_mm.row(row) = reached.sliders_mm.transpose();
    poses.push_back(reached.pose);
  }
  const PoseTable table = forward_table(Model(machine), anywhere);
  for (Eigen::Index row = 0; row < kPoses; ++row) {
    ASSERT_EQ(table.status[row], 0) << row;
    const Pose& pose = poses[static_cast<std::size_t>(row)];
    ASSERT_LT((table.pose.row(row).head<3>().transpose() - pose.position).norm(), 1e-7) << row;
  }
}

TEST_F(PredictionTest, FailureIsReportedByRowAndSparesTheOthers) {
  const Prediction whole = predict(model, samples, true);
  samples.sliders_mm(70, 0) = 20.0;  // in the second block of rows
  samples.sliders_mm(70, 1) = 840.0;
  samples.sliders_mm(90, 4) = samples.sliders_mm(90, 5) - 830.0;
  const Prediction predicted = predict(model, samples, true);
  EXPECT_EQ(predicted.first_failure(), 70);
  EXPECT_TRUE(predicted.jacobian.allFinite() && predicted.reading_mm.allFinite());
  for (Eigen::Index row = 0; row < samples.size(); ++row) {
    if (row == 70 || row == 90) {
      EXPECT_EQ(predicted.status[row], static_cast<int>(Status::kUnreachable));
      EXPECT_EQ(predicted.reading_mm[row], 0.0);
      EXPECT_TRUE(predicted.jacobian.row(row).isZero());
    } else {
      EXPECT_EQ(predicted.status[row], 0);
      EXPECT_NEAR(predicted.reading_mm[row], whole.reading_mm[row], 1e-11);
    }
  }
}

TEST_F(PredictionTest, NothingToPredict) {
  const Prediction predicted = predict(model, samples.rows({}), true);
  EXPECT_EQ(predicted.reading_mm.size(), 0);
  EXPECT_EQ(predicted.first_failure(), -1);
}

TEST_F(PredictionTest, PosesOfTheNominalMachine) {
  const PoseTable table = forward_table(Model(machine), samples);
  for (Eigen::Index row = 0; row < samples.size(); ++row) {
    ASSERT_EQ(table.status[row], 0);
    Pose pose;
    pose.position = table.pose.row(row).head<3>();
    for (int i = 0; i < 3; ++i) pose.rotation.row(i) = table.pose.row(row).segment<3>(3 + 3 * i);
    const InverseResult back = inverse(NominalGeometry(machine), pose);
    EXPECT_LT((back.sliders_mm.transpose() - samples.sliders_mm.row(row)).norm(), 1e-10);
  }
}

TEST_F(PredictionTest, PortSensitivityIsThatOfTheJacobian) {
  const RowMajorMatrix ports = port_sensitivity(model, samples);
  const RowMajorMatrix jacobian = predict(model, samples, true).jacobian;
  ASSERT_EQ(model.terms[0].effect->info().name, "leg_length");
  EXPECT_LT((ports.middleCols(port::kLeg, 6) - jacobian.leftCols(6)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(PredictionTest, ValuesAreLaidOutEffectByEffect) {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(model.size(), 1.0, model.size());
  model.set_values(values);
  EXPECT_EQ(model.values(), values);
  EXPECT_EQ(model.terms[1].values[0], 7.0);  // slider_offset follows six leg lengths
}

}  // namespace
}  // namespace hexdbb::testing
