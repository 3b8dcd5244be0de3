// Time of one call of the compensator along a circle at 3000 mm/min, 1 kHz: median and tail over single calls, each
// timed with the processor's counter; the cost of reading the counter is subtracted. The tail also depends on the
// system: a busy one interrupts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
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
BENCHMARK_CAPTURE(pose, geometry, geometry_and({}));
BENCHMARK_CAPTURE(pose, usual, geometry_and(kUsual));
BENCHMARK_CAPTURE(pose, all, geometry_and(kAll));

}  // namespace
