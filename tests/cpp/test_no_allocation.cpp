// The single-pose path allocates nothing. Every allocation by code linked into this program is counted: `new` is
// replaced here, the C functions (which Eigen calls for its dynamic matrices) are wrapped by the linker.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "compensating.hpp"

namespace {
long allocations = 0;
}

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* old, std::size_t size);
int __real_posix_memalign(void** out, std::size_t alignment, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  ++allocations;
  return __real_realloc(old, size);
}
int __wrap_posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  ++allocations;
  return __real_posix_memalign(out, alignment, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __real_aligned_alloc(alignment, size);
}
}

void* operator new(std::size_t size) {
  ++allocations;
  void* out = __real_malloc(size);
  if (out == nullptr) throw std::bad_alloc();
  return out;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return __real_malloc(size);
}
// Not inlined: otherwise the compiler warns that free() in the caller does not match new.
[[gnu::noinline]] void operator delete(void* old) noexcept { std::free(old); }
[[gnu::noinline]] void operator delete(void* old, std::size_t) noexcept { std::free(old); }

namespace hexdbb::testing {
namespace {

class NoAllocation : public ::testing::Test {
 protected:
  NominalGeometry nominal{Machine()};
  hexdbb::SetUp set_up{{0, 0, 325}, {5, -7, 60}, 100.0};

  /// Count the allocations while `work` runs.
  template <class Work>
  long during(Work work) {
    const long before = allocations;
    work();
    return allocations - before;
  }
};

TEST_F(NoAllocation, TheCounterCounts) {
  volatile int size = 10;
  EXPECT_GE(during([&] {
              Eigen::VectorXd dynamic = Eigen::VectorXd::Zero(size);
              ASSERT_EQ(dynamic.sum(), 0.0);
            }),
            1);
  void* volatile kept = nullptr;  // otherwise the compiler removes the pair of new and delete
  EXPECT_GE(during([&] { kept = ::operator new(static_cast<std::size_t>(size)); }), 1);
  ::operator delete(kept);
}

TEST_F(NoAllocation, SinglePosePath) {
  Drawing drawing(91);
  for (bool shared : {true, false}) {
    for (int i = 0; i < 100; ++i) {
      const Reached reached = draw_reachable(drawing, nominal, kCircleExtent);
      const Ports push = draw_push(drawing, nominal, reached.sliders_mm, 0.1, 1e-3, shared);
      double sum = 0.0;
      EXPECT_EQ(during([&] { sum += inverse(nominal, reached.pose, push).sliders_mm.sum(); }), 0);
      Mechanism mechanism;
      EXPECT_EQ(during([&] { mechanism = assemble(nominal, reached.sliders_mm, push); }), 0);
      RssrAngles angles;
      ForwardResult solved;
      EXPECT_EQ(during([&] { solved = forward(mechanism, angles); }), 0);
      EXPECT_EQ(during([&] { solved = forward_six(mechanism, solved.pose); }), 0);
      ASSERT_EQ(solved.status, Status::kOk);
      EXPECT_EQ(during([&] { sum += reading_mm(solved.pose, set_up, push); }), 0);
      Ports sensitivity;
      EXPECT_EQ(during([&] {
                  const PlatformTriangle triangle(shared_joints(mechanism));
                  reading_sensitivity(nominal, mechanism, triangle, solved.pose, set_up, push, sensitivity);
                }),
                0);
      EXPECT_EQ(during([&] { reading_sensitivity_six(nominal, mechanism, solved.pose, set_up, push, sensitivity); }),
                0);
      EXPECT_NE(sum + sensitivity.value.sum(), 0.0);
    }
  }
}

TEST_F(NoAllocation, AHundredThousandCallsOfTheCompensator) {
  std::vector<std::string> names = kGeometricNames;
  names.insert(names.end(), kCorrectable.begin(), kCorrectable.end());
  names.push_back("leg_thermal");
  names.push_back("screw_thermal");
  CompensationData data = data_of(wrong_machine(names, 92));
  data.tables = all_tables();
  Compensator compensator(data);
  const std::vector<Pose> path = circle_path(0.012, 1.0);
  Direction direction;
  direction.temperature_c = 23.0;
  long failures = 0;
  EXPECT_EQ(during([&] {
              for (std::size_t call = 0; call < 100000; ++call) {
                direction.velocity_mm_s.setConstant(call % 2000 < 1000 ? 1.0 : -1.0);
                direction.acceleration_mm_s2.setConstant(call % 3000 < 1000 ? 5.0 : -5.0);
                const SliderTargets targets = compensator.sliders(path[call % path.size()], direction);
                failures += targets.status != Status::kOk;
                failures += compensator.pose(targets.sliders_mm, direction).status != Status::kOk;
              }
              failures += compensator.sliders(make_pose(0, 0, 900, 0, 0, 0)).status == Status::kOk;
            }),
            0);
  EXPECT_EQ(failures, 0);
}

TEST_F(NoAllocation, FailuresAllocateNothingEither) {
  Vector6 sliders;
  sliders << 20.0, 840.0, 33.1, 832.9, 33.1, 832.9;
  const Mechanism apart = assemble(nominal, sliders, Ports());
  sliders[0] = 33.1;
  sliders[1] = 832.9;
  const Mechanism open = assemble(nominal, sliders, Ports());
  const Pose home = home_pose(nominal);
  RssrAngles angles;
  Status status = Status::kOk;
  EXPECT_EQ(during([&] { status = forward(apart, angles).status; }), 0);
  EXPECT_NE(status, Status::kOk);
  EXPECT_EQ(during([&] { status = forward(open, angles).status; }), 0);
  EXPECT_NE(status, Status::kOk);
  EXPECT_EQ(during([&] { status = forward_six(open, home).status; }), 0);
  EXPECT_NE(status, Status::kOk);
  EXPECT_EQ(during([&] { status = inverse(nominal, make_pose(0, 0, 1000, 0, 0, 0)).status; }), 0);
  EXPECT_NE(status, Status::kOk);
}

}  // namespace
}  // namespace hexdbb::testing
