// Compensation: where the sliders of the real machine must stand for its platform to be where it is told.
//
// Model: the machine as diagnosed. Its effects push at the ports by q(s, sigma, F, T): s slider coordinates, sigma side
// each slider moves to, F leg forces, T temperature. Targets solve s = inverse(pose; q(s, ...)), by fixed-point
// iteration from the last correction: an effect of some um per mm of slider travel changes q by a thousandth to a
// hundredth of an error in s, so that two or three inverse solutions reach 1e-7 mm.
//
// What "where it is told" means: the frame of the platform takes the commanded pose in the model's base frame. A ball
// bar does not see a shift of the whole base (nobody knows where its cup stands to a um); diagnosis keeps what it
// cannot see near the nominal machine, so the model's base frame is the nominal one as nearly as anybody can tell.
//
// Direction: the side sigma of a slider is a play operator of its commanded travel: it goes from -1 to +1 over
// `reversal_travel_mm`, so that the correction for lost motion is continuous, bounded in rate by the slider's own
// speed, and stands still with the slider. The play counts as crossed: the drive is told to cross it, over that travel.
//
// Real time: sliders() and pose() allocate nothing, throw nothing, lock nothing and call no system; at most four
// inverse solutions. One instance belongs to one thread.
#pragma once

#include "hexdbb/compensation_file.hpp"
#include "hexdbb/kinematics.hpp"
#include "hexdbb/slider_polynomials.hpp"

namespace hexdbb {

/// How the machine moves at a pose.
struct Direction {
  /// Commanded, of each slider. Its sign is the direction; where it is 0 the direction follows from the nominal place
  /// of the slider at the call before.
  Vector6 velocity_mm_s = Vector6::Zero();
  double temperature_c = std::numeric_limits<double>::quiet_NaN();  // NaN: not measured, no growth corrected
  /// -1 .. 1, said by a controller that looks ahead and changes sides as fast as its drives may; NaN: see above.
  Vector6 side = Vector6::Constant(std::numeric_limits<double>::quiet_NaN());
};

struct SliderTargets {
  Vector6 sliders_mm = Vector6::Zero();     // where status is not ok: those of the last good call
  Vector6 correction_mm = Vector6::Zero();  // what they have beyond the nominal coordinates
  double largest_correction_mm = 0.0;       // magnitude
  int iterations = 0;                       // inverse solutions under the model, at most 4
  int slider = -1;                          // 0-based, at fault; -1 where none
  Status status = Status::kOk;
};

struct PoseEstimate {
  Pose pose;  // where status is not ok: that of the last good call
  double residual_mm = 0.0;
  int iterations = 0;
  Status status = Status::kOk;
};

class Compensator {
 public:
  /// The nominal machine, nothing compensated.
  explicit Compensator(const Machine& machine);

  /// Throws CompensationError where an effect or one of its values is not known.
  explicit Compensator(const CompensationData& data, const std::string& source = "compensation data");

  /// Targets for a pose; poses in order of motion. Without velocities, a pose more than `kFollow_mm` of slider travel
  /// from the one before is looked at without being followed, unless the next is near it: a controller may try end
  /// points in between.
  SliderTargets sliders(const Pose& pose, const Direction& direction = Direction()) noexcept;

  /// Where the platform stands with the drives at these coordinates: the inverse of sliders() with the sides it holds
  /// and the part of the correction in force. Velocities that are not 0 say the side instead.
  PoseEstimate pose(const Vector6& sliders_mm, const Direction& direction = Direction()) noexcept;

  /// Off or on; it fades over the next `kFadeCalls` calls of sliders(), so that no slider jumps.
  void enable(bool on) noexcept { wanted_part_ = on ? 1.0 : 0.0; }
  double enabled_part() const noexcept { return has_effects_ ? part_ : 0.0; }

  /// Forget how the machine moved before, as after homing.
  void reset() noexcept;

  const Machine& machine() const noexcept { return model_.nominal.machine; }
  const CompensationLimits& limits() const noexcept { return limits_; }

  static constexpr int kMaxIterations = 4;
  static constexpr double kTolerance_mm = 1e-7;
  static constexpr double kFollow_mm = 2.0;
  static constexpr int kFadeCalls = 500;

 private:
  void prepare();
  bool follow(const Vector6& nominal_mm, const Direction& direction) noexcept;
  void set_state(const Direction& direction, const Vector6& side, const Vector6& leg_force) noexcept;
  Vector6 leg_force(const Pose& pose, const Vector6& nominal_mm) const noexcept;
  const Ports& push_at(const Vector6& sliders_mm) noexcept;
  bool solve(const Pose& pose, const Vector6& nominal_mm, SliderTargets& out) noexcept;

  Model model_;                    // effects to be asked in every iteration
  SliderPolynomials polynomials_;  // all others, folded
  CompensationLimits limits_;
  double reference_temperature_c_ = std::numeric_limits<double>::quiet_NaN();
  bool has_effects_ = false, needs_leg_force_ = false;
  double side_per_mm_ = 0.0;
  double contraction_ = 0.0;  // bound of the change of inverse solutions per change of the places effects are asked at
  PlatformTriangle nominal_triangle_;

  Samples now_;  // one row: what the effects are asked about
  Ports none_, push_;
  Vector6 side_ = Vector6::Zero();    // -1 .. 1
  Vector6 followed_mm_, visited_mm_;  // nominal places; NaN where there is none
  Vector6 last_targets_mm_ = Vector6::Zero(), last_correction_mm_ = Vector6::Zero();
  double part_ = 1.0, wanted_part_ = 1.0;
  RssrAngles angles_, nominal_angles_;
  Pose last_pose_;
};

/// Velocities of the sliders between two poses of the nominal machine `step_s` apart; zero where one is out of reach.
Direction direction_between(const NominalGeometry& nominal, const Pose& from, const Pose& to, double step_s) noexcept;

/// From a compensation file; throws CompensationError, whose fault() says why.
Compensator load_compensation(const std::string& path);

/// The same, refusing the file of a machine other than the one the controller believes to drive.
Compensator load_compensation(const std::string& path, const Machine& machine);

}  // namespace hexdbb
