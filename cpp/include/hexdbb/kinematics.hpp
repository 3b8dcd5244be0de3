// Inverse kinematics in closed form, forward kinematics by two solvers. No allocation, no exception, no NaN: a status.
//
// forward():      the thesis' three RSSR loops. Two spheres about the joints of a pair of sliders meet in a circle on
//                 which their ball joint lies, whatever the geometric errors are; three angles (theta, delta, phi),
//                 three side lengths |Q1Q2|, |Q2Q3|, |Q3Q1|. Newton-Raphson, the step by Cramer's rule (2.17)-(2.21).
//                 Exact for every error that leaves the ball joint of a pair shared.
// forward_six():  Newton on the six pose coordinates, one leg length each; any platform (6-6), and the test of the
//                 first.
#pragma once

#include "hexdbb/mechanism.hpp"

namespace hexdbb {

enum class Status : int {
  kOk = 0,
  kUnreachable = 1,      // the legs cannot reach
  kSingular = 2,         // the platform can move with the sliders locked
  kIterationLimit = 3,   // Newton did not converge within its iteration limit
  kTravel = 4,           // a slider would leave its travel
  kGap = 5,              // the sliders of one guideway would come closer than the minimum gap
  kCorrectionLimit = 6,  // a correction would be larger than its file allows (compensation.hpp)
  kNotANumber = 7,       // a pose, coordinate or velocity that is not finite
  kLast = kNotANumber,
};

/// Return the meaning of a status, as "travel: a slider would leave its travel".
const char* status_name(Status status);

struct InverseResult {
  Vector6 sliders_mm = Vector6::Zero();
  Status status = Status::kOk;
  int leg = -1;  // 0-based leg or slider at fault, -1 where none
};

/// Compute the slider coordinates of a pose (thesis 2.6-2.8): s = f -/+ sqrt(l^2 - r^2) with f the ball joint's foot on
/// the guideway and r its distance from it. `push` must not depend on the sliders themselves.
InverseResult inverse(const NominalGeometry& nominal, const Pose& pose, const Ports& push = Ports()) noexcept;

/// The three RSSR angles as cosines and sines: a solution, and the start of the next.
struct RssrAngles {
  // Level platform half-way up: every pair of legs leans inward by 0.41 rad from the vertical above its guideway.
  Vector3 cosine = Vector3::Constant(0.917120822816605);
  Vector3 sine = Vector3::Constant(0.398609327984423);

  /// Return theta, delta, phi in rad with the thesis' signs (positive: leaning inward).
  Vector3 angle_rad() const;
};

struct ForwardResult {
  Pose pose;
  double residual_mm = 0.0;  // largest error of a side (RSSR) or leg (six coordinates)
  int iterations = 0;        // Newton steps taken
  Status status = Status::kOk;
};

constexpr int kMaxIterations = 50;  // of forward_six(): enough for steps shortened to 200 mm or half a radian
constexpr double kResidualTolerance_mm = 1e-12;  // a few roundings of the squares of 400 mm

/// Solve the RSSR loops; `angles` is the start and becomes the solution (unchanged unless the status is kOk).
ForwardResult forward(const Mechanism& mechanism, const PlatformTriangle& triangle, RssrAngles& angles) noexcept;

/// Solve the same with the triangle of the mechanism's own shared joints.
ForwardResult forward(const Mechanism& mechanism, RssrAngles& angles) noexcept;

/// Solve the six pose coordinates by Newton from a start pose.
ForwardResult forward_six(const Mechanism& mechanism, const Pose& start) noexcept;

/// Return the home pose: a level platform half-way up, the start of a search without a neighbour.
Pose home_pose(const NominalGeometry& nominal);

}  // namespace hexdbb
