// Speed of single poses: inverse, forward warm and from home, reading and its complete sensitivity. Poses are drawn
// over the workspace; a warm start is 0.1 mm away. Every solution is to 1e-12 mm.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <random>
#include <vector>

#include "block.hpp"
#include "hexdbb/ball_bar.hpp"
#include "hexdbb/prediction.hpp"

namespace {

using namespace hexdbb;

constexpr int kPoses = 1024;

struct Case {
  Pose pose;
  Vector6 sliders;
  RssrAngles solved;     // of the pose itself
  RssrAngles neighbour;  // of a pose 0.1 mm away
  Pose neighbour_pose;
  Mechanism mechanism;
};

const NominalGeometry& nominal() {
  static const NominalGeometry geometry{Machine()};
  return geometry;
}

const PlatformTriangle& triangle() {
  static const PlatformTriangle prepared(shared_joints(assemble(nominal(), Vector6::Zero(), Ports())));
  return prepared;
}

const SetUp& set_up() {
  static const SetUp bar{Vector3(0.0, 0.0, 340.0), Vector3(0.0, 0.0, 60.0), 100.0};
  return bar;
}

std::vector<Case> make_cases(double tilt_rad) {
  std::mt19937_64 random(20060701);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Case> cases;
  while (static_cast<int>(cases.size()) < kPoses) {
    Case each;
    each.pose.position = Vector3(100.0 * unit(random), 100.0 * unit(random), 280.0 + 15.0 * unit(random));
    each.pose.rotation = rotation_from_rpy(tilt_rad * unit(random), tilt_rad * unit(random), tilt_rad * unit(random));
    const InverseResult there = inverse(nominal(), each.pose);
    each.neighbour_pose = each.pose;
    each.neighbour_pose.position += 0.1 * Vector3(unit(random), unit(random), unit(random)).normalized();
    const InverseResult near = inverse(nominal(), each.neighbour_pose);
    if (there.status != Status::kOk || near.status != Status::kOk) continue;
    each.sliders = there.sliders_mm;
    each.mechanism = assemble(nominal(), each.sliders, Ports());
    if (forward(each.mechanism, each.solved).status != Status::kOk) std::abort();
    if (forward(assemble(nominal(), near.sliders_mm, Ports()), each.neighbour).status != Status::kOk) std::abort();
    cases.push_back(each);
  }
  return cases;
}

const std::vector<Case>& level() {
  static const std::vector<Case> cases = make_cases(0.0);
  return cases;
}

const std::vector<Case>& tilted() {
  static const std::vector<Case> cases = make_cases(0.15);
  return cases;
}

template <class Work>
void each_case(benchmark::State& state, const std::vector<Case>& cases, Work work) {
  std::size_t at = 0;
  for (auto _ : state) {
    work(cases[at]);
    at = (at + 1) % cases.size();
  }
}

void inverse_pose(benchmark::State& state) {
  const Ports none;
  each_case(state, level(), [&](const Case& each) { benchmark::DoNotOptimize(inverse(nominal(), each.pose, none)); });
}

void forward_warm(benchmark::State& state, const std::vector<Case>& cases) {
  const Ports none;
  each_case(state, cases, [&](const Case& each) {
    RssrAngles angles = each.neighbour;
    benchmark::DoNotOptimize(forward(assemble(nominal(), each.sliders, none), triangle(), angles));
  });
}

void forward_home(benchmark::State& state, const std::vector<Case>& cases) {
  const Ports none;
  each_case(state, cases, [&](const Case& each) {
    RssrAngles angles;
    benchmark::DoNotOptimize(forward(assemble(nominal(), each.sliders, none), triangle(), angles));
  });
}

void forward_six_warm(benchmark::State& state) {
  const Ports none;
  each_case(state, level(), [&](const Case& each) {
    benchmark::DoNotOptimize(forward_six(assemble(nominal(), each.sliders, none), each.neighbour_pose));
  });
}

void sensitivity(benchmark::State& state) {
  const Ports none;
  Ports answer;
  each_case(state, tilted(), [&](const Case& each) {
    benchmark::DoNotOptimize(
        reading_sensitivity(nominal(), each.mechanism, triangle(), each.pose, set_up(), none, answer));
    benchmark::DoNotOptimize(answer);
  });
}

void sensitivity_six(benchmark::State& state) {
  const Ports none;
  Ports answer;
  each_case(state, tilted(), [&](const Case& each) {
    benchmark::DoNotOptimize(reading_sensitivity_six(nominal(), each.mechanism, each.pose, set_up(), none, answer));
    benchmark::DoNotOptimize(answer);
  });
}

/// A block of samples 0.2 mm apart along a circle: 3000 mm/min at 250 Hz.
Block circle_block() {
  Block block;
  block.ports.setZero();
  for (Eigen::Index row = 0; row < Block::kRows; ++row) {
    const double angle = 0.002 * static_cast<double>(row);
    const Pose pose{Vector3(100.0 * std::cos(angle), 100.0 * std::sin(angle), 280.0), Matrix3::Identity()};
    block.sliders_mm.row(row) = inverse(nominal(), pose).sliders_mm.transpose();
    block.cup_mm.row(row) = set_up().cup_mm.transpose();
    block.ball_mm.row(row) = set_up().ball_offset_mm.transpose();
    block.bar_length_mm(row) = set_up().bar_length_mm;
  }
  return block;
}

/// The angles of a block's first row, for all rows.
Block::Angles angles_of_first(const Block& block) {
  RssrAngles first;
  forward(assemble(nominal(), block.sliders_mm.row(0).transpose(), Ports()), first);
  Block::Angles out;
  for (Eigen::Index row = 0; row < Block::kRows; ++row)
    out.row(row) << first.cosine.transpose(), first.sine.transpose();
  return out;
}

/// Time per pose, the reading included, with or without its derivative at all ports.
void batch(benchmark::State& state, bool want_sensitivity) {
  static Block block = circle_block();
  const Block::Angles start = angles_of_first(block);
  for (auto _ : state) {
    Block::Angles angles = start;
    solve_block(nominal(), block, angles, Block::kRows, Start::kNeighbour, want_sensitivity);
    benchmark::DoNotOptimize(block.reading_mm.data());
  }
  state.SetItemsProcessed(state.iterations() * Block::kRows);
}

BENCHMARK(inverse_pose);
BENCHMARK_CAPTURE(batch, reading, false);
BENCHMARK_CAPTURE(batch, sensitivity, true);
BENCHMARK_CAPTURE(forward_warm, level, level());
BENCHMARK_CAPTURE(forward_warm, tilted, tilted());
BENCHMARK_CAPTURE(forward_home, level, level());
BENCHMARK_CAPTURE(forward_home, tilted, tilted());
BENCHMARK(forward_six_warm);
BENCHMARK(sensitivity);
BENCHMARK(sensitivity_six);

}  // namespace
