// The state of samples beyond slider coordinates: what effects, and predictors of a residual, may depend on.
//
// Every column is optional: empty where it is not known. A record provides some columns, derive() computes the others;
// a motion controller that predicts or corrects one sample fills in what it knows. An effect lists the columns it needs
// (EffectInfo::needs), and a model refuses samples that lack one.
//
// Assumptions: inside a sweep (one uninterrupted capture) the sliders move smoothly; before it, they came along the last
// kRunUp_rad of the circle as they do a lap later, so that a reversal there is known; before a sweep of less than a lap,
// each slider moved as it does at its start. Encoder positions are smoothed by a parabola through the neighbours within
// 50 ms (at least two on either side): long against quantisation of 0.1 um, short against circles, which take seconds.
// Derivatives are those of a longer polynomial, over 0.4 rad of the motion on either side; where sampling is fast, the
// velocity has what is faster than that besides. Time stamps of even samples are taken without the rounding of their
// last digit.
//
// The joints of leg k. u is the unit vector from the slider joint to the platform joint. The slider translates, so the
// leg's angular velocity relative to it is u x du/dt (rotation about the leg's own line is not determined and moves
// nothing). It has two components: the swing about the guideway, which both legs of a pair share (the RSSR angle), and
// the inclination to the guideway, the leg's own. The joint's angle is the inclination, acos(u . d), d the guideway's
// direction; its rate is positive while the leg turns away from d. The magnitude of the whole angular velocity is not
// used: along a circle it never vanishes and its direction rotates, so that it has no reversal. At the platform the
// angle is likewise that between the leg and the platform's normal, and the rate is relative to the platform.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hexdbb/mechanism.hpp"

namespace hexdbb {

struct Samples;

using SliderTable = Eigen::Matrix<double, Eigen::Dynamic, kLegs>;  // a row per sample, a column per slider or leg
using AxisTable = Eigen::Matrix<double, Eigen::Dynamic, 3>;        // a row per sample, three components

constexpr double kGravity_m_s2 = 9.80665;  // standard gravity (CGPM 1901)
constexpr double kReversal_mm = 0.002;     // a return by less is encoder noise, not a reversal
constexpr double kLongAgo = 1e6;           // s, mm or rad since a reversal that never was
// Angle of a circle driven before its first reading: the overshoot of the plans here. A record does not state it; what a
// slider did longer ago has settled at usual feeds.
constexpr double kRunUp_rad = M_PI / 4.0;

struct State {
  Eigen::VectorXi row;
  Eigen::VectorXd time_s;
  Eigen::VectorXi circle;
  Eigen::VectorXi sweep;
  Eigen::VectorXi lap;
  Eigen::VectorXd direction;
  Eigen::VectorXd angle_rad;
  Eigen::VectorXd angle_wrapped_rad;
  Eigen::VectorXd feed_mm_s;
  Eigen::VectorXd temperature_c;
  Eigen::VectorXd warming_k;
  Eigen::VectorXd nominal_reading_mm;
  AxisTable position_mm;
  AxisTable platform_rpy_rad;
  Eigen::VectorXd speed_mm_s;
  AxisTable platform_velocity_mm_s;
  SliderTable velocity_mm_s;
  SliderTable acceleration_mm_s2;
  SliderTable jerk_mm_s3;
  SliderTable snap_mm_s4;
  SliderTable travel_direction;
  SliderTable since_reversal_s;
  SliderTable since_reversal_mm;
  SliderTable leg_force;
  SliderTable slider_joint_angle_rad;
  SliderTable slider_joint_rate_rad_s;
  SliderTable slider_joint_direction;
  SliderTable slider_joint_since_reversal_rad;
  SliderTable platform_joint_angle_rad;
  SliderTable platform_joint_rate_rad_s;

  /// Return the same columns for some rows.
  State rows(const std::vector<Eigen::Index>& which) const;
};

/// What the numbers of a column belong to.
enum class ColumnOf { kSample, kAxis, kSlider, kLeg };

/// A column as lists, tables and messages describe it.
struct ColumnInfo {
  const char* name;
  const char* unit;  // "1" where it has none
  const char* meaning;
  ColumnOf of = ColumnOf::kSample;
  bool may_be_nan = false;  // NaN is a value: not measured
};

/// Call visit(ColumnInfo, column) for every column: the one vocabulary of what a sample's state holds.
template <class StateType, class Visit>
void for_each_column(StateType& state, Visit visit) {
  using Of = ColumnOf;
  visit(ColumnInfo{"row", "1", "index in the table from which the samples were taken; empty: they are the table"},
        state.row);
  visit(ColumnInfo{"time_s", "s", "time since the record's first sample"}, state.time_s);
  visit(ColumnInfo{"circle", "1", "id of the circle in the plan"}, state.circle);
  visit(ColumnInfo{"sweep", "1", "number of the uninterrupted capture"}, state.sweep);
  visit(ColumnInfo{"lap", "1", "number of the turn within its sweep"}, state.lap);
  visit(ColumnInfo{"direction", "1", "sense of the circle: +1 counter-clockwise, -1 clockwise"}, state.direction);
  visit(ColumnInfo{"angle_rad", "rad", "commanded polar angle as recorded, any number of turns"}, state.angle_rad);
  visit(ColumnInfo{"angle_wrapped_rad", "rad", "commanded polar angle within 0 to 2 pi"}, state.angle_wrapped_rad);
  visit(ColumnInfo{"feed_mm_s", "mm/s", "commanded speed along the circle"}, state.feed_mm_s);
  visit(ColumnInfo{"temperature_c", "degC", "measured temperature; NaN: not measured", Of::kSample, true},
        state.temperature_c);
  visit(ColumnInfo{"warming_k", "K", "temperature minus the record's first one; NaN: not measured", Of::kSample, true},
        state.warming_k);
  visit(ColumnInfo{"nominal_reading_mm", "mm", "reading of the nominal machine in the nominal set-up"},
        state.nominal_reading_mm);
  visit(ColumnInfo{"position_mm", "mm", "reference point of the nominal platform, base frame", Of::kAxis},
        state.position_mm);
  visit(ColumnInfo{"platform_rpy_rad", "rad", "roll, pitch and yaw of the nominal platform", Of::kAxis},
        state.platform_rpy_rad);
  visit(ColumnInfo{"speed_mm_s", "mm/s", "speed of the nominal platform's reference point"}, state.speed_mm_s);
  visit(ColumnInfo{"platform_velocity_mm_s", "mm/s", "velocity of the same, base frame", Of::kAxis},
        state.platform_velocity_mm_s);
  visit(ColumnInfo{"velocity_mm_s", "mm/s", "velocity of the slider", Of::kSlider}, state.velocity_mm_s);
  visit(ColumnInfo{"acceleration_mm_s2", "mm/s^2", "acceleration of the slider", Of::kSlider},
        state.acceleration_mm_s2);
  visit(ColumnInfo{"jerk_mm_s3", "mm/s^3", "third time derivative of the slider's coordinate", Of::kSlider},
        state.jerk_mm_s3);
  visit(ColumnInfo{"snap_mm_s4", "mm/s^4", "fourth time derivative of the slider's coordinate", Of::kSlider},
        state.snap_mm_s4);
  visit(ColumnInfo{"travel_direction", "1", "direction in which the slider last moved, +1 or -1; 0: never moved",
                   Of::kSlider},
        state.travel_direction);
  visit(ColumnInfo{"since_reversal_s", "s",
                   "time since the slider last reversed; 1e6: neither in its sweep nor along the run-up", Of::kSlider},
        state.since_reversal_s);
  visit(ColumnInfo{"since_reversal_mm", "mm", "travel since the slider last reversed; 1e6: likewise", Of::kSlider},
        state.since_reversal_mm);
  visit(ColumnInfo{"leg_force", "1",
                   "axial force per newton of vertical load at the platform's reference point, tension positive",
                   Of::kLeg},
        state.leg_force);
  visit(ColumnInfo{"slider_joint_angle_rad", "rad", "angle between the leg and its guideway's direction", Of::kLeg},
        state.slider_joint_angle_rad);
  visit(ColumnInfo{"slider_joint_rate_rad_s", "rad/s", "rate of the angle between the leg and its guideway", Of::kLeg},
        state.slider_joint_rate_rad_s);
  visit(
      ColumnInfo{"slider_joint_direction", "1",
                 "sense in which the leg last turned at its slider joint, +1: away from the guideway's direction, -1; "
                 "0: never turned",
                 Of::kLeg},
      state.slider_joint_direction);
  visit(ColumnInfo{"slider_joint_since_reversal_rad", "rad",
                   "angle turned since the slider joint last reversed; 1e6: likewise", Of::kLeg},
        state.slider_joint_since_reversal_rad);
  visit(ColumnInfo{"platform_joint_angle_rad", "rad", "angle between the leg and the platform's normal", Of::kLeg},
        state.platform_joint_angle_rad);
  visit(ColumnInfo{"platform_joint_rate_rad_s", "rad/s", "rate of the angle between the leg and the platform's normal",
                   Of::kLeg},
        state.platform_joint_rate_rad_s);
}

/// Throw std::invalid_argument where a column that `who` needs is empty, or NaN in some row (unless
/// ColumnInfo::may_be_nan).
void require_column(const State& state, const std::string& column, const std::string& who);

/// What follows from coordinates over time, sweep by sweep.
struct Motion {
  SliderTable velocity_mm_s;       // NaN in a sweep of one sample
  SliderTable acceleration_mm_s2;  // likewise
  SliderTable jerk_mm_s3;          // likewise
  SliderTable snap_mm_s4;          // likewise
  SliderTable travel_direction;
  SliderTable since_reversal_s;
  SliderTable since_reversal_mm;
};

constexpr int kMostDerivatives = 4;  // velocity to snap

/// Six coordinates, and how many of their derivatives by time to compute, 1 to kMostDerivatives.
struct Coordinates {
  const SliderTable& table;
  int derivatives;
};

/// Compute the motion of several tables of coordinates with common times, as motion(); derivatives beyond those wanted
/// stay empty. With polar angles, a reversal along the run-up of a circle is known.
std::vector<Motion> motions(const Eigen::VectorXd& time_s, const Eigen::VectorXi& sweep,
                            const Eigen::VectorXd& angle_rad, const std::vector<Coordinates>& coordinates);

/// Compute the motion of six coordinates, in sweeps before which nothing is known. Rows of a sweep need not be neighbours
/// but must be in order of time, otherwise std::invalid_argument names the row.
Motion motion(const Eigen::VectorXd& time_s, const Eigen::VectorXi& sweep, const SliderTable& sliders_mm);

/// Axial force in each leg per newton of load in static equilibrium of the nominal machine, tension positive. By
/// virtual work it is -dz / dl_k, the change of height per length of the leg. NaN where the nominal machine has no
/// pose.
SliderTable leg_force(const NominalGeometry& nominal, const SliderTable& sliders_mm);

/// Pose of the nominal platform and the angles of its joints; NaN where the nominal machine has no pose.
struct NominalPoses {
  AxisTable position_mm;
  AxisTable platform_rpy_rad;
  SliderTable slider_joint_angle_rad;
  SliderTable platform_joint_angle_rad;
};
NominalPoses nominal_poses(const NominalGeometry& nominal, const SliderTable& sliders_mm);

/// Readings of the nominal machine in the nominal set-up; NaN where it has no pose.
Eigen::VectorXd nominal_reading_mm(const NominalGeometry& nominal, const Samples& samples);

/// Fill columns that follow from time_s, sweep, angle_rad (where known) and the sliders: motion, wrapped angle, pose, leg
/// forces, joints, nominal readings. `columns` names those that are wanted; what is found on the way is filled too. All
/// are where it is empty. Throws std::invalid_argument for a column that follows from no others.
void derive(const NominalGeometry& nominal, Samples& samples, const std::vector<std::string>& columns = {});

}  // namespace hexdbb
