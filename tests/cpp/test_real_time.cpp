// A hundred thousand calls of the compensator in a process that the kernel ends at its first system call: seccomp's
// strict mode allows only read, write and exit. A waiting lock would call futex, growing memory brk or mmap.
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "compensating.hpp"

namespace hexdbb::testing {
namespace {

constexpr int kCalls = 100000;

[[noreturn]] void leave(int code) {
  syscall(SYS_exit, code);  // not exit_group, which strict mode forbids
  __builtin_unreachable();
}

/// Run `work` in a child under strict seccomp and return the status of waitpid.
template <class Work>
int confined(Work work) {
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) leave(2);
    leave(work() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(RealTime, TheConfinementEndsASystemCall) {
  const int status = confined([] { return getppid() != 0; });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(RealTime, NoSystemCallInAHundredThousand) {
  std::vector<std::string> names = kGeometricNames;
  names.insert(names.end(), kCorrectable.begin(), kCorrectable.end());
  names.push_back("leg_thermal");
  const Model truth = wrong_machine(names, 31);
  CompensationData data = data_of(truth);
  data.tables = all_tables();
  Compensator compensator(data);
  const std::vector<Pose> path = circle_path(0.004, 1.0);
  std::vector<Direction> directions(path.size());
  for (std::size_t at = 0; at < path.size(); ++at) {
    directions[at] = direction_between(truth.nominal, path[at], path[(at + 1) % path.size()], 0.004);
    directions[at].temperature_c = 22.0;
    directions[at].acceleration_mm_s2.setConstant(at % 100 < 50 ? 5.0 : -5.0);
  }
  const int status = confined([&] {
    bool are_good = true;
    for (int call = 0; call < kCalls; ++call) {
      const std::size_t at = static_cast<std::size_t>(call) % path.size();
      const SliderTargets targets = compensator.sliders(path[at], directions[at]);
      are_good = are_good && targets.status == Status::kOk;
      are_good = are_good && compensator.pose(targets.sliders_mm, directions[at]).status == Status::kOk;
    }
    return are_good && compensator.sliders(make_pose(0, 0, 900, 0, 0, 0)).status == Status::kUnreachable;
  });
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace hexdbb::testing
