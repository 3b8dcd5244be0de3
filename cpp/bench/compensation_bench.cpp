// Time of one call of the compensator along a circle at 3000 mm/min, 1 kHz: median and tail over single calls, each
// timed with the processor's counter; the cost of reading the counter is subtracted. The tail also depends on the
// system: a busy one interrupts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "hexdbb/compensation.hpp"

namespace {

using namespace hexdbb;

constexpr double kStep_s = 1e-3, kRadius_mm = 90.0, kSpeed_mm_s = 50.0;

/// Return a machine with these effects at half their prior standard deviations.
CompensationData machine_with(const std::vector<std::string>& effects) {
  Model model{Machine()};
  for (const std::string& name : effects) {
    model.add(find_effect(Machine(), 1, name));
    Term& term = model.terms.back();
    const std::vector<ParameterInfo>& parameters = term.effect->info().parameters;
    for (Eigen::Index value = 0; value < term.values.size(); ++value) {
      term.values[value] = 0.5 * parameters[static_cast<std::size_t>(value) % parameters.size()].prior_sigma;
    }
  }
  return compensation_of(model, "benchmark", "", {2.0, 0.01}, 20.0);
}

/// Return what a function learned from readings becomes: `count` knots, some um of a smooth function.
CompensationTable learned_table(const std::string& port, const std::string& variable, std::vector<TablePush> pushes,
                                double low, double high, int count) {
  CompensationTable out{.effect = "learned", .port = port, .variable = variable, .pushes = std::move(pushes)};
  for (int at = 0; at < count; ++at) {
    const double part = double(at) / (count - 1);
    out.knots.push_back(low + (high - low) * part);
    out.values_mm.push_back(0.01 * std::sin(7.0 * part) + 0.003 * std::cos(23.0 * part));
  }
  return out;
}

/// Return the knots of a function with a step where its variable changes sign: closer about 0.
CompensationTable with_step(CompensationTable table) {
  for (int at = -10; at <= 10; ++at) table.knots.push_back(1e-3 * (at + 0.1));
  std::sort(table.knots.begin(), table.knots.end());
  table.values_mm.clear();
  for (const double knot : table.knots) table.values_mm.push_back(0.01 * std::tanh(knot / 3e-3));
  return table;
}

const CompensationTable kVertical =
    learned_table("slider_joint", "sliders_mm", {{0, 2, 1.0}, {1, 5, 1.0}}, 30.0, 840.0, 289);
const CompensationTable kPosition = learned_table("slider", "sliders_mm", {{3, 3, 1.0}}, 30.0, 840.0, 289);
const CompensationTable kVelocity = with_step(learned_table("slider", "velocity_mm_s", {{3, 3, 1.0}}, -60, 60, 161));
const CompensationTable kAcceleration =
    with_step(learned_table("slider", "acceleration_mm_s2", {{3, 3, 1.0}}, -60, 60, 161));

CompensationTable against_motion(CompensationTable table) {
  table.times = "travel_direction";
  return table;
}
const CompensationTable kSinceReversal =
    against_motion(learned_table("slider", "since_reversal_mm", {{3, 3, 1.0}}, 0.0, 120.0, 161));
const CompensationTable kTurning =
    with_step(learned_table("leg", "slider_joint_rate_rad_s", {{4, 4, 1.0}}, -0.2, 0.2, 161));
const CompensationTable kJointAngle = learned_table("leg", "slider_joint_angle_rad", {{4, 4, 1.0}}, 0.5, 2.5, 161);
const CompensationTable kSwing = with_step(learned_table("leg", "swing_rate_rad_s", {{4, 4, 1.0}}, -0.2, 0.2, 161));
const CompensationTable kPlatformAngle = learned_table("leg", "platform_joint_angle_rad", {{4, 4, 1.0}}, 0.5, 2.5, 161);
const CompensationTable kForce = learned_table("leg", "leg_force", {{2, 2, 1.0}}, -1.0, 0.5, 161);

struct Path {
  std::vector<Pose> pose;
  std::vector<Direction> direction;
};

Path circle() {
  const NominalGeometry nominal{Machine()};
  const int count = static_cast<int>(2.0 * M_PI * kRadius_mm / kSpeed_mm_s / kStep_s);
  Path out;
  for (int at = 0; at < count; ++at) {
    const double angle = 2.0 * M_PI * at / count;
    out.pose.push_back(Pose{Vector3(kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle), 285.0),
                            rotation_from_rpy(0.05, -0.03, 0.1)});
  }
  for (std::size_t at = 0; at < out.pose.size(); ++at) {
    out.direction.push_back(direction_between(nominal, out.pose[at], out.pose[(at + 1) % out.pose.size()], kStep_s));
    out.direction.back().temperature_c = 23.0;
    out.direction.back().acceleration_mm_s2.setConstant(30.0 * std::sin(2.0 * M_PI * double(at) / count));
  }
  return out;
}

double now_ns() {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double part(std::vector<double>& times, double fraction) {
  const auto place = times.begin() + static_cast<std::ptrdiff_t>(fraction * double(times.size() - 1));
  std::nth_element(times.begin(), place, times.end());
  return *place;
}

/// Mean of the middle half: as steady as the median, and finer than the clock's steps (10 ns on some machines).
double middle(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  const auto quarter = static_cast<std::ptrdiff_t>(times.size() / 4);
  return std::accumulate(times.begin() + quarter, times.end() - quarter, 0.0) / double(times.size() - 2 * quarter);
}

/// Throughput as the benchmark's own time; median and p99.9 of single calls as counters.
void sliders(benchmark::State& state, const std::vector<std::string>& effects) {
  Compensator compensator(machine_with(effects));
  const Path path = circle();
  std::vector<double> times, empty;
  for (int call = 0; call < 10000; ++call) {
    const double begin = now_ns();
    empty.push_back(now_ns() - begin);
  }
  const double clock_ns = part(empty, 0.5);
  std::size_t at = 0;
  int iterations = 0;
  for (auto _ : state) {
    const double begin = now_ns();
    const SliderTargets targets = compensator.sliders(path.pose[at], path.direction[at]);
    const double taken_ns = now_ns() - begin - clock_ns;
    if (targets.status != Status::kOk) state.SkipWithError(status_name(targets.status));
    iterations = std::max(iterations, targets.iterations);
    times.push_back(taken_ns);
    state.SetIterationTime(1e-9 * std::max(taken_ns, 0.0));
    at = (at + 1) % path.pose.size();
  }
  state.counters["median_ns"] = part(times, 0.5);
  state.counters["p999_ns"] = part(times, 0.999);
  state.counters["iterations_needed"] = iterations;
}

/// The same pose with and without one table, call by call in turn: what the table adds, whatever else the processor does.
void table(benchmark::State& state, const std::vector<std::string>& effects, const CompensationTable& added) {
  CompensationData data = machine_with(effects);
  Compensator without(data);
  data.tables = {added};
  Compensator with(data);
  const Path path = circle();
  std::vector<double> times_without, times_with;
  std::size_t at = 0;
  const auto timed = [&](Compensator& compensator, std::vector<double>& times) {
    const double begin = now_ns();
    const SliderTargets targets = compensator.sliders(path.pose[at], path.direction[at]);
    times.push_back(now_ns() - begin);
    if (targets.status != Status::kOk) state.SkipWithError(status_name(targets.status));
  };
  for (auto _ : state) {
    const bool is_even = at % 2 == 0;
    timed(is_even ? without : with, is_even ? times_without : times_with);
    timed(is_even ? with : without, is_even ? times_with : times_without);
    state.SetIterationTime(1e-9 * times_with.back());
    at = (at + 1) % path.pose.size();
  }
  state.counters["without_ns"] = middle(times_without);
  state.counters["with_ns"] = middle(times_with);
}

void pose(benchmark::State& state, const std::vector<std::string>& effects) {
  Compensator compensator(machine_with(effects));
  const Path path = circle();
  std::vector<Vector6> targets;
  for (std::size_t at = 0; at < path.pose.size(); ++at) {
    targets.push_back(compensator.sliders(path.pose[at], path.direction[at]).sliders_mm);
  }
  std::size_t at = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(compensator.pose(targets[at], path.direction[at]));
    at = (at + 1) % targets.size();
  }
}

std::vector<std::string> geometry_and(const std::vector<std::string>& more) {
  std::vector<std::string> out = effect_names(group::kGeometry);
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

const std::vector<std::string> kUsual = {"backlash", "pitch_cyclic", "gravity_sag"};
const std::vector<std::string> kAll = {"backlash",     "pitch_cyclic", "gravity_sag", "lead_error",   "straightness",
                                       "joint_offset", "servo_lag",    "leg_thermal", "screw_thermal"};

BENCHMARK_CAPTURE(sliders, geometry, geometry_and({}))->UseManualTime();
BENCHMARK_CAPTURE(sliders, backlash, geometry_and({"backlash"}))->UseManualTime();
BENCHMARK_CAPTURE(sliders, pitch, geometry_and({"pitch_cyclic"}))->UseManualTime();
BENCHMARK_CAPTURE(sliders, sag, geometry_and({"gravity_sag"}))->UseManualTime();
BENCHMARK_CAPTURE(sliders, usual, geometry_and(kUsual))->UseManualTime();
BENCHMARK_CAPTURE(sliders, all, geometry_and(kAll))->UseManualTime();
BENCHMARK_CAPTURE(table, vertical, geometry_and({"backlash"}), kVertical)->UseManualTime();
BENCHMARK_CAPTURE(table, position, geometry_and({"backlash"}), kPosition)->UseManualTime();
BENCHMARK_CAPTURE(table, velocity, geometry_and({"backlash"}), kVelocity)->UseManualTime();
BENCHMARK_CAPTURE(table, acceleration, geometry_and({"backlash"}), kAcceleration)->UseManualTime();
BENCHMARK_CAPTURE(table, since_reversal, geometry_and({"backlash"}), kSinceReversal)->UseManualTime();
BENCHMARK_CAPTURE(table, turning, geometry_and({"backlash"}), kTurning)->UseManualTime();
BENCHMARK_CAPTURE(table, joint_angle, geometry_and({"backlash"}), kJointAngle)->UseManualTime();
BENCHMARK_CAPTURE(table, swing, geometry_and({"backlash"}), kSwing)->UseManualTime();
BENCHMARK_CAPTURE(table, platform_angle, geometry_and({"backlash"}), kPlatformAngle)->UseManualTime();
BENCHMARK_CAPTURE(table, force, geometry_and({"backlash"}), kForce)->UseManualTime();
BENCHMARK_CAPTURE(table, usual_turning, geometry_and(kUsual), kTurning)->UseManualTime();
BENCHMARK_CAPTURE(table, usual_vertical, geometry_and(kUsual), kVertical)->UseManualTime();
BENCHMARK_CAPTURE(pose, geometry, geometry_and({}));
BENCHMARK_CAPTURE(pose, usual, geometry_and(kUsual));
BENCHMARK_CAPTURE(pose, all, geometry_and(kAll));

}  // namespace
