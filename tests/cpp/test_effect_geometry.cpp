// Pushes of the geometric effects against the geometry they describe, and the redundancies among them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "circles.hpp"
#include "drawing.hpp"

namespace hexdbb::testing {
namespace {

using PortRows = Eigen::Matrix<double, Eigen::Dynamic, port::kCount>;

class EffectGeometry : public ::testing::Test {
 protected:
  Machine machine;
  NominalGeometry nominal{machine};
  Samples samples = circle_samples(machine, seven_circles(), 12);

  PortRows push_of(const std::string& name, const Eigen::VectorXd& values) const {
    PortRows ports = PortRows::Zero(samples.size(), int{port::kCount});
    find_effect(machine, 1, name)->push({samples, 0, samples.size()}, values, ports);
    return ports;
  }

  /// Predict readings with these effects at these values.
  Eigen::VectorXd readings(const std::vector<std::pair<std::string, Eigen::VectorXd>>& effects) const {
    Model model(machine);
    for (const auto& [name, values] : effects) {
      model.add(find_effect(machine, 1, name));
      model.terms.back().values = values;
    }
    const Prediction predicted = predict(model, samples, false);
    EXPECT_EQ(predicted.first_failure(), -1);
    return predicted.reading_mm;
  }
};

TEST_F(EffectGeometry, NominalMachineReadsZero) { EXPECT_LT(readings({}).cwiseAbs().maxCoeff(), 1e-11); }

TEST_F(EffectGeometry, PlatformSidesHaveExactlyTheStatedLength) {
  Drawing drawing(51);
  for (int i = 0; i < 20; ++i) {
    const Vector3 longer = drawing.vector(5.0);
    const PortRows push = push_of("platform_side", longer);
    Vector3 joint[3], centroid = Vector3::Zero();
    for (int g = 0; g < kGuideways; ++g) {
      const Vector3 moved = push.row(0).segment<3>(port::kPlatformJoint + 6 * g);
      EXPECT_EQ(moved, Vector3(push.row(0).segment<3>(port::kPlatformJoint + 6 * g + 3)));  // one joint a pair
      EXPECT_EQ(moved.z(), 0.0);
      joint[g] = platform_joint(machine, g) + moved;
      centroid += moved;
    }
    const double side = std::sqrt(3.0) * machine.platform_circumradius_mm;
    EXPECT_NEAR((joint[0] - joint[1]).norm(), side + longer[0], 1e-11);
    EXPECT_NEAR((joint[1] - joint[2]).norm(), side + longer[1], 1e-11);
    EXPECT_NEAR((joint[2] - joint[0]).norm(), side + longer[2], 1e-11);
    EXPECT_LT(centroid.norm(), 1e-11);
    EXPECT_EQ(push.leftCols(port::kPlatformJoint).cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ(push.rightCols(port::kCount - port::kBall).cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST_F(EffectGeometry, GuidewaysRotateAsRigidBodies) {
  struct Case {
    const char* name;
    int local_axis;
    bool about_midpoint;
  };
  const Vector3 angle(0.02, -0.013, 0.007);
  for (const Case& each : {Case{"guideway_rotation_xy", 2, true}, Case{"guideway_rotation_yz", 0, true},
                           Case{"guideway_rotation_centre", 2, false}}) {
    const PortRows push = push_of(each.name, angle);
    for (int k = 0; k < kLegs; ++k) {
      const int g = guideway_of(k);
      const Vector3 centre = each.about_midpoint ? guideway_midpoint(machine, g) : Vector3(0.0, 0.0, 0.0);
      const Matrix3 turn =
          Eigen::AngleAxisd(angle[g], guideway_axes(machine, g).col(each.local_axis)).toRotationMatrix();
      for (Eigen::Index row = 0; row < samples.size(); ++row) {
        const Vector3 nominal_joint = nominal.vertex.col(k) + samples.sliders_mm(row, k) * nominal.direction.col(k);
        const Vector3 wanted = centre + turn * (nominal_joint - centre);
        const Vector3 found = nominal_joint + push.row(row).segment<3>(port::kSliderJoint + 3 * k).transpose();
        EXPECT_LT((found - wanted).norm(), 1e-12 * 500.0) << each.name << " leg " << k;
      }
    }
  }
}

TEST_F(EffectGeometry, TranslationFollowsTheLocalAxes) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(9);
  values.segment<3>(3) << 0.3, 0.2, 0.1;  // guideway 2
  const PortRows push = push_of("guideway_translation", values);
  const Vector3 outward = guideway_midpoint(machine, 1).normalized();
  const Vector3 wanted = 0.3 * outward - 0.2 * guideway_direction(machine, 1) + Vector3(0, 0, 0.1);
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 found = push.row(5).segment<3>(port::kSliderJoint + 3 * k);
    EXPECT_LT((found - (guideway_of(k) == 1 ? wanted : Vector3(0, 0, 0))).norm(), 1e-15) << "leg " << k;
  }
}

TEST_F(EffectGeometry, TranslationAlongTheGuidewayIsAnOffsetOfBothSliders) {
  Eigen::VectorXd translation = Eigen::VectorXd::Zero(9), offset(6);
  translation[1] = 0.8;
  translation[4] = -0.3;
  translation[7] = 0.5;
  offset << -0.8, -0.8, 0.3, 0.3, -0.5, -0.5;  // local y points against the slider coordinate
  const Eigen::VectorXd one = readings({{"guideway_translation", translation}});
  EXPECT_GT(one.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((one - readings({{"slider_offset", offset}})).cwiseAbs().maxCoeff(), 1e-10);
}

TEST_F(EffectGeometry, RotationAboutTheBaseCentreIsOneAboutTheMidpointAndATranslation) {
  const Vector3 angle(5e-3, -3e-3, 8e-3);
  Eigen::VectorXd exact = Eigen::VectorXd::Zero(9);
  for (int g = 0; g < kGuideways; ++g) {  // displacement of the midpoint, local axes
    exact[3 * g] = machine.base_inradius_mm * (std::cos(angle[g]) - 1.0);
    exact[3 * g + 1] = machine.base_inradius_mm * std::sin(angle[g]);
  }
  const Eigen::VectorXd one = readings({{"guideway_rotation_centre", angle}});
  EXPECT_GT(one.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((one - readings({{"guideway_rotation_xy", angle}, {"guideway_translation", exact}})).cwiseAbs().maxCoeff(),
            1e-10);
}

TEST_F(EffectGeometry, RedundanciesAreExactToFirstOrder) {
  Model model(machine);
  for (const char* name :
       {"slider_offset", "guideway_translation", "guideway_rotation_xy", "guideway_rotation_centre"}) {
    model.add(find_effect(machine, 1, name));
  }
  const RowMajorMatrix jacobian = predict(model, samples, true).jacobian;
  for (int g = 0; g < kGuideways; ++g) {
    const Eigen::VectorXd along = jacobian.col(6 + 3 * g + 1);
    EXPECT_LT((along + jacobian.col(2 * g) + jacobian.col(2 * g + 1)).norm(), 1e-12 * along.norm());
    const Eigen::VectorXd turned = jacobian.col(18 + g);
    EXPECT_LT((turned - jacobian.col(15 + g) - machine.base_inradius_mm * along).norm(), 1e-12 * turned.norm());
  }
}

TEST_F(EffectGeometry, LongerBarReadsLess) {
  const Eigen::VectorXd longer = Eigen::VectorXd::Constant(1, 0.02);
  EXPECT_LT((readings({{"bar_length", longer}}).array() + 0.02).abs().maxCoeff(), 1e-11);
}

}  // namespace
}  // namespace hexdbb::testing
