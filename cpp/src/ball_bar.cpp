#include "hexdbb/ball_bar.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "multiversion.hpp"

namespace hexdbb {

namespace {

constexpr double kSingularRatio = 1e-9;

struct Bar {
  Vector3 ball;       // platform frame
  Vector3 arm;        // R ball, base frame
  Vector3 direction;  // unit vector from cup to ball, base frame
  double length_mm;
};

Bar bar(const Pose& pose, const SetUp& set_up, const Ports& push) {
  Bar out;
  out.ball = set_up.ball_offset_mm + push.ball();
  out.arm = pose.rotation * out.ball;
  const Vector3 along = pose.position + out.arm - set_up.cup_mm - push.cup();
  out.length_mm = along.norm();
  out.direction = along / (out.length_mm > 0.0 ? out.length_mm : 1.0);
  return out;
}

/// `share[k] * leg_k` is the force in leg k, leg_k the vector from slider joint to ball joint.
void fill(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose, const Bar& along,
          const Matrix36& leg, const Vector6& share, Ports& out) {
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 force = share[k] * leg.col(k);
    out.slider()[k] = force.dot(nominal.direction.col(k));
    out.leg()[k] = share[k] * mechanism.leg_length[k];
    out.slider_joint(k) = force;
    out.platform_joint(k).noalias() = -pose.rotation.transpose() * force;
  }
  out.ball().noalias() = pose.rotation.transpose() * along.direction;
  out.cup() = -along.direction;
  out.reading() = 1.0;
}

}  // namespace

double reading_mm(const Pose& pose, const SetUp& set_up, const Ports& push) noexcept {
  const Vector3 ball = set_up.ball_offset_mm + push.ball();
  return (pose.position + pose.rotation * ball - set_up.cup_mm - push.cup()).norm() - set_up.bar_length_mm +
         push.reading();
}

// The bar's unit force n at ball = Q1 + alpha x + beta y + gamma x*y (x = Q2-Q1, y = Q3-Q1) is equivalent to forces h_i at the three
// ball joints. Adding forces m along the sides keeps it so; they are chosen such that no joint force has a component along
// t_i, the normal of the plane of its two legs: a cyclic 3 x 3 system, the transpose of the loops' own (2.17).
HEXDBB_MULTIVERSION
bool reading_sensitivity(const NominalGeometry& nominal, const Mechanism& mechanism, const PlatformTriangle& triangle,
                         const Pose& pose, const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept {
  sensitivity.value.setZero();
  const Bar along = bar(pose, set_up, push);
  if (!(along.length_mm > 0.0)) return false;
  const Vector3& n = along.direction;

  Matrix3 q;
  q.noalias() = pose.rotation * triangle.joints;
  q.colwise() += pose.position;
  Matrix36 leg;
  Matrix3 normal;
  for (int i = 0; i < kGuideways; ++i) {
    leg.col(2 * i) = q.col(i) - mechanism.slider_joint.col(2 * i);
    leg.col(2 * i + 1) = q.col(i) - mechanism.slider_joint.col(2 * i + 1);
    normal.col(i) = Vector3(leg.col(2 * i)).cross(Vector3(leg.col(2 * i + 1)));
  }

  const Vector3 x = q.col(1) - q.col(0);
  const Vector3 y = q.col(2) - q.col(0);
  const Vector3 place = triangle.frame_inverse * (along.ball - triangle.joints.col(0));
  Matrix3 force;
  force.col(1) = place[0] * n + place[2] * y.cross(n);
  force.col(2) = place[1] * n + place[2] * n.cross(x);
  force.col(0) = n - force.col(1) - force.col(2);

  Matrix3 side;  // Q1-Q2, Q2-Q3, Q3-Q1
  side << -x, x - y, y;
  double a[3], d[3], g[3];
  for (int i = 0; i < kGuideways; ++i) {
    const int before = i == 0 ? 2 : i - 1;
    a[i] = side.col(i).dot(normal.col(i));
    d[i] = side.col(before).dot(normal.col(i));
    g[i] = -force.col(i).dot(normal.col(i));
  }
  const double determinant = a[0] * a[1] * a[2] - d[0] * d[1] * d[2];
  const double scale = normal.colwise().norm().prod() * side.colwise().norm().prod();
  if (!(std::abs(determinant) > kSingularRatio * scale)) return false;
  double m[3];
  for (int i = 0; i < kGuideways; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = j == 2 ? 0 : j + 1;
    m[i] = (g[i] * a[j] * a[k] + d[i] * (g[k] * a[j] + d[k] * g[j])) / determinant;
  }
  for (int i = 0; i < kGuideways; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    force.col(i) += m[i] * side.col(i);
    force.col(j) -= m[i] * side.col(i);
  }

  Vector6 share;
  for (int i = 0; i < kGuideways; ++i) {
    const Vector3 f = force.col(i), t = normal.col(i), first = leg.col(2 * i), second = leg.col(2 * i + 1);
    const double inverse = 1.0 / t.squaredNorm();
    share[2 * i] = f.cross(second).dot(t) * inverse;
    share[2 * i + 1] = first.cross(f).dot(t) * inverse;
  }
  fill(nominal, mechanism, pose, along, leg, share, sensitivity);
  return true;
}

bool reading_sensitivity_six(const NominalGeometry& nominal, const Mechanism& mechanism, const Pose& pose,
                             const SetUp& set_up, const Ports& push, Ports& sensitivity) noexcept {
  sensitivity.value.setZero();
  const Bar along = bar(pose, set_up, push);
  if (!(along.length_mm > 0.0)) return false;
  Matrix36 leg;
  Eigen::Matrix<double, 6, 6> wrench;  // of a unit force per mm of leg, about the platform's reference point
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 arm = pose.rotation * mechanism.platform_joint.col(k);
    leg.col(k) = pose.position + arm - mechanism.slider_joint.col(k);
    wrench.col(k) << leg.col(k), arm.cross(Vector3(leg.col(k)));
  }
  Vector6 wanted;
  wanted << along.direction, along.arm.cross(along.direction);
  const Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>> lu(wrench);
  const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff<Eigen::PropagateNaN>() > kSingularRatio * pivots.maxCoeff())) return false;
  fill(nominal, mechanism, pose, along, leg, lu.solve(wanted), sensitivity);
  return true;
}

}  // namespace hexdbb
