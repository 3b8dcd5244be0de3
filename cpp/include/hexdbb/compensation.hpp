// Compensation: slider coordinates at which the platform of the real machine takes the commanded pose.
//
// Model: the machine as diagnosed. Its effects push at the ports by q(s, sigma, F, T): s slider coordinates, sigma
// directions of travel, F leg forces, T temperature. Targets solve s = inverse(pose; q(s, ...)), by fixed-point
// iteration from the last correction: an effect of some um per mm of slider travel changes q by a thousandth to a
// hundredth of an error in s, so that two or three inverse solutions reach 1e-7 mm.
//
// Frame: the platform takes the commanded pose in the model's base frame. A ball bar does not identify a shift of the
// whole base, because the position of its cup is not known to a um; diagnosis keeps unidentifiable combinations near
// the nominal machine, so the model's base frame is the nominal one as nearly as the readings determine it.
//
// Direction of travel: sigma of a slider is a play operator of its commanded travel. It goes from -1 to +1 over
// `reversal_travel_mm`, so that the correction for lost motion is continuous, bounded in rate by the slider's own
// speed, and constant while the slider rests. The play counts as crossed: the drive is commanded to cross it over that
// travel. The sense in which a leg turns at its slider joint is the same operator on the arc of the leg's far end.
//
// Travel since a reversal counts from where a slider's commanded coordinate turned. It is kept for either direction: that
// of the direction left behind stays until sigma has changed over, so that a function of it changes over as
// continuously, and a slider that turns back before that resumes it, as if it had not turned.
//
// Tables (learned effects) take slider positions as they are in the iteration; what the joints do is that of the nominal
// machine at the commanded pose, turning rates from the commanded velocities, accelerations as they are stated.
//
// Real time: sliders() and pose() allocate nothing, throw nothing, lock nothing and call no system; at most four
// inverse solutions. One instance belongs to one thread.
#pragma once

#include "hexdbb/compensation_file.hpp"
#include "hexdbb/kinematics.hpp"
#include "hexdbb/slider_polynomials.hpp"
#include "hexdbb/slider_waves.hpp"

namespace hexdbb {

/// How the machine moves at a pose.
struct Direction {
  /// Commanded, of each slider. Its sign is the direction of travel; where it is 0, that follows from the slider's
  /// nominal coordinate at the call before.
  Vector6 velocity_mm_s = Vector6::Zero();
  double temperature_c = std::numeric_limits<double>::quiet_NaN();  // NaN: not measured, no growth corrected
  /// Commanded, of each slider. NaN: not known, and functions of it push nothing: the compensator knows no cycle time.
  Vector6 acceleration_mm_s2 = Vector6::Constant(std::numeric_limits<double>::quiet_NaN());
  /// -1 to 1, stated by a controller that looks ahead and reverses as fast as its drives allow; NaN: derived as above.
  Vector6 travel_direction = Vector6::Constant(std::numeric_limits<double>::quiet_NaN());
  /// Travel since a reversal, of motion down and of motion up, stated by a controller that looks ahead; NaN: derived.
  std::array<Vector6, 2> since_reversal_mm = {travel_direction, travel_direction};
};

struct SliderTargets {
  Vector6 sliders_mm = Vector6::Zero();     // where status is not ok: those of the last successful call
  Vector6 correction_mm = Vector6::Zero();  // sliders_mm minus the nominal coordinates
  double largest_correction_mm = 0.0;       // magnitude
  int iterations = 0;                       // inverse solutions under the model, at most 4
  int slider = -1;                          // 0-based, at fault; -1 where none
  Status status = Status::kOk;
};

struct PoseEstimate {
  Pose pose;  // where status is not ok: that of the last successful call
  double residual_mm = 0.0;
  int iterations = 0;
  Status status = Status::kOk;
};

class Compensator {
 public:
  /// Compensate nothing: the nominal machine.
  explicit Compensator(const Machine& machine);

  /// Throw CompensationError where an effect or one of its values is not known.
  explicit Compensator(const CompensationData& data, const std::string& source = "compensation data");

  /// Compute targets for a pose; poses come in order of motion. Without velocities, a pose more than `kFollow_mm` of
  /// slider travel from the one before changes no direction of travel, unless the next is near it: a controller may
  /// check end points in between.
  SliderTargets sliders(const Pose& pose, const Direction& direction = Direction()) noexcept;

  /// Compute the pose with the drives at these coordinates: the inverse of sliders(), with its present directions of
  /// travel and the part of the correction in force. Velocities that are not 0 determine the direction instead.
  PoseEstimate pose(const Vector6& sliders_mm, const Direction& direction = Direction()) noexcept;

  /// Switch off or on; the correction fades over the next `kFadeCalls` calls of sliders(), so that no slider jumps.
  void enable(bool on) noexcept { wanted_part_ = on ? 1.0 : 0.0; }
  double enabled_part() const noexcept { return has_effects_ ? part_ : 0.0; }

  /// Forget the motion so far, as after homing.
  void reset() noexcept;

  const Machine& machine() const noexcept { return model_.nominal.machine; }
  const CompensationLimits& limits() const noexcept { return limits_; }

  static constexpr int kMaxIterations = 4;       // two or three suffice, see above
  static constexpr double kTolerance_mm = 1e-7;  // a thousandth of an encoder count
  static constexpr double kFollow_mm = 2.0;      // a period of 1 ms at 2 m/s, more than a drive does
  static constexpr int kFadeCalls = 500;         // half a second at 1 kHz

 private:
  void prepare();
  bool follow(const Vector6& nominal_mm, const Direction& direction) noexcept;
  void follow_joints(const Vector6& nominal_mm, const Vector6& velocity_mm_s) noexcept;
  void follow_reversals(const Vector6& nominal_mm, const Direction& direction) noexcept;
  void set_state(const Direction& direction, const Vector6& travel_direction, const Vector6& leg_force) noexcept;
  void set_tables(const Direction& direction, const Vector6& travel_direction, const Vector6& leg_force,
                  const Pose& nominal_pose, const Vector6& nominal_mm) noexcept;
  Vector6 leg_force(const Pose& pose, const Vector6& nominal_mm) const noexcept;
  const LegPorts& push_at(const LegRow& sliders_mm) noexcept;
  void push_beside(const LegRow& sliders_mm) noexcept;
  int reach(const Pose& pose) noexcept;
  bool solve(const Pose& pose, SliderTargets& out) noexcept;
  void remember(const SliderTargets& out) noexcept;

  Model model_;                    // effects evaluated in every iteration
  SliderPolynomials polynomials_;  // all others, folded
  SliderWaves waves_;
  TableSet tables_;
  CompensationLimits limits_;
  double reference_temperature_c_ = std::numeric_limits<double>::quiet_NaN();
  bool has_effects_ = false, is_folded_ = false, needs_leg_force_ = false, needs_pose_ = false;
  double direction_per_mm_ = 0.0;
  double contraction_ = 0.0;  // bound of the change of targets per change of the coordinates at which effects are taken
  double bend_ = 0.0;         // bound of the change of that from one side of a table's knot to the other
  NominalLegs legs_;
  PlatformTriangle nominal_triangle_;

  Samples now_;  // one row: the state in which the effects are evaluated
  TableState table_state_;
  LegPorts push_;
  LegRow reach_mm_[3], nominal_mm_;  // at the present pose: nominal ball joints from the vertices, nominal coordinates
  Vector6 travel_direction_ = Vector6::Zero();  // -1 .. 1
  Vector6 joint_direction_ = Vector6::Zero();   // -1 .. 1
  std::array<Vector6, 2> since_reversal_mm_;    // of travel down and up
  Vector6 followed_mm_, checked_mm_;            // nominal coordinates; NaN where there are none
  Vector6 last_targets_mm_ = Vector6::Zero();
  LegRow correction_mm_, last_correction_mm_;  // at the present pose, and of the last call that counted
  LegRow correction_step_mm_;                  // from the last correction but one to the last
  bool has_last_ = false;                      // any of them
  double part_ = 1.0, wanted_part_ = 1.0;
  RssrAngles angles_, nominal_angles_;
  Pose last_pose_;
};

/// Compute the velocities of the sliders between two poses of the nominal machine `step_s` apart; zero where one of the
/// poses is out of reach.
Direction direction_between(const NominalGeometry& nominal, const Pose& from, const Pose& to, double step_s) noexcept;

/// Return velocities and accelerations of sliders at the second of three sets of coordinates, by the parabola through
/// them: the seconds from the first to the second, and on to the third.
Direction direction_through(const Vector6& before_mm, const Vector6& at_mm, const Vector6& after_mm, double before_s,
                            double after_s) noexcept;

/// Load a compensation file. Throws CompensationError, whose fault() is the reason.
Compensator load_compensation(const std::string& path);

/// Load a compensation file, refusing that of a machine other than the one the controller drives.
Compensator load_compensation(const std::string& path, const Machine& machine);

}  // namespace hexdbb
