// The state of samples beyond slider coordinates: what effects may depend on besides the place of the sliders.
//
// Every column is optional: empty where it is not known. A record's columns are filled by the functions below; a motion
// controller that predicts or corrects one sample fills what it knows itself. An effect says which columns it needs
// (EffectInfo::needs), and a model refuses samples that lack one.
//
// Assumptions: inside a sweep (one uninterrupted capture) the sliders move smoothly; before it, each slider moved as it
// does at its start. Encoder positions are smoothed by a parabola through the neighbours within 50 ms (at least two on
// either side): long against quantisation of 0.1 um, short against circles, which take seconds.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "hexdbb/mechanism.hpp"

namespace hexdbb {

struct Samples;

using SliderTable = Eigen::Matrix<double, Eigen::Dynamic, kLegs>;  // a row a sample, a column a slider

constexpr double kGravity_m_s2 = 9.80665;  // standard gravity (CGPM 1901)
constexpr double kReversal_mm = 0.002;     // a slider that returns by less has not reversed: encoder noise
constexpr double kLongAgo = 1e6;           // s or mm since a reversal that never was

struct State {
  Eigen::VectorXi row;     // place in the table the samples were taken from; empty: the samples are the whole table
  Eigen::VectorXd time_s;  // since the record's first sample
  Eigen::VectorXi circle;  // as the plan counts circles
  Eigen::VectorXi sweep;   // uninterrupted capture
  Eigen::VectorXi lap;
  Eigen::VectorXd direction;           // +1 counter-clockwise, -1 clockwise
  Eigen::VectorXd angle_rad;           // commanded polar angle
  Eigen::VectorXd feed_mm_s;           // commanded
  Eigen::VectorXd temperature_c;       // NaN where not measured
  Eigen::VectorXd warming_k;           // temperature minus the record's first one; NaN where not measured
  Eigen::VectorXd nominal_reading_mm;  // of the nominal machine: what the programme asks of the bar
  SliderTable velocity_mm_s;
  SliderTable acceleration_mm_s2;
  SliderTable jerk_mm_s3;
  SliderTable snap_mm_s4;
  SliderTable side;               // +1 or -1: where the slider last moved to; 0 where it never moved
  SliderTable since_reversal_s;   // kLongAgo where there was none in the sweep
  SliderTable since_reversal_mm;  // travel from the turning point, likewise
  SliderTable leg_force;  // axial force per newton of vertical load at the platform's reference point; tension +

  /// The same columns for some rows.
  State rows(const std::vector<Eigen::Index>& which) const;
};

/// Calls visit(name, column) for every column, in the order above.
template <class StateType, class Visit>
void for_each_column(StateType& state, Visit visit) {
  visit("row", state.row);
  visit("time_s", state.time_s);
  visit("circle", state.circle);
  visit("sweep", state.sweep);
  visit("lap", state.lap);
  visit("direction", state.direction);
  visit("angle_rad", state.angle_rad);
  visit("feed_mm_s", state.feed_mm_s);
  visit("temperature_c", state.temperature_c);
  visit("warming_k", state.warming_k);
  visit("nominal_reading_mm", state.nominal_reading_mm);
  visit("velocity_mm_s", state.velocity_mm_s);
  visit("acceleration_mm_s2", state.acceleration_mm_s2);
  visit("jerk_mm_s3", state.jerk_mm_s3);
  visit("snap_mm_s4", state.snap_mm_s4);
  visit("side", state.side);
  visit("since_reversal_s", state.since_reversal_s);
  visit("since_reversal_mm", state.since_reversal_mm);
  visit("leg_force", state.leg_force);
}

/// Throws std::invalid_argument where a column that `who` needs is empty, or holds no number in some row (allowed for
/// temperature_c and warming_k alone).
void require_column(const State& state, const std::string& column, const std::string& who);

/// What follows from the sliders' places over time, sweep by sweep.
struct Motion {
  SliderTable velocity_mm_s;       // NaN in a sweep of one sample
  SliderTable acceleration_mm_s2;  // NaN likewise
  SliderTable jerk_mm_s3;          // NaN likewise
  SliderTable snap_mm_s4;          // NaN likewise
  SliderTable side;
  SliderTable since_reversal_s;
  SliderTable since_reversal_mm;
};

/// Rows of a sweep need not be neighbours but must be in order of time, else std::invalid_argument names the row.
Motion motion(const Eigen::VectorXd& time_s, const Eigen::VectorXi& sweep, const SliderTable& sliders_mm);

/// Static equilibrium of the nominal machine: axial force in each leg per newton of load, tension positive. By virtual
/// work it is -dz / dl_k, the height's answer to a longer leg. NaN where the nominal machine has no pose.
SliderTable leg_force(const NominalGeometry& nominal, const SliderTable& sliders_mm);

/// Readings of the nominal machine in the nominal set-up; NaN where it has no pose.
Eigen::VectorXd nominal_reading_mm(const NominalGeometry& nominal, const Samples& samples);

/// Fill every column that follows from others: motion from time_s and sweep, leg forces and nominal readings.
void derive(const NominalGeometry& nominal, Samples& samples);

}  // namespace hexdbb
