#include "core/available_memory.hpp"

#include <gtest/gtest.h>

#include "grid_files.hpp"

namespace {

using namespace sunfleck;

// A machine as its files tell it.
class AvailableMemory : public ::testing::Test {
 protected:
  void tell(const std::string& file, const std::string& text) {
    const fs::path path = machine / file;
    fs::create_directories(path.parent_path());
    writeBytes(path, text);
  }
  double available() const { return availableMemory(machine / ""); }

  const TemporaryFolder machine;
};

// Check the figure of the system, 8 GiB at most, and that a machine that tells nothing is taken for a large one.
TEST_F(AvailableMemory, IsThatOfTheSystem) {
  EXPECT_EQ(available(), 0x1p33);
  tell("proc/meminfo", "MemTotal: 2000 kB\nMemFree: 10 kB\nMemAvailable:    1000 kB\n");
  EXPECT_EQ(available(), 1000. * 1024.);
  tell("proc/meminfo", "MemAvailable: 99000000 kB\n");
  EXPECT_EQ(available(), 0x1p33);
}

// Check the limits of control groups of version 2: of the group and of those above it, without what files have left.
TEST_F(AvailableMemory, IsWhatControlGroupsLeave) {
  tell("proc/self/cgroup", "0::/above/own\n");
  tell("sys/fs/cgroup/above/own/memory.max", "max\n");
  tell("sys/fs/cgroup/above/own/memory.current", "700\n");
  EXPECT_EQ(available(), 0x1p33);
  tell("sys/fs/cgroup/above/memory.max", "5000\n");
  tell("sys/fs/cgroup/above/memory.current", "3000\n");
  tell("sys/fs/cgroup/above/memory.stat", "anon 1800\nfile 1200\ninactive_file 800\nactive_file 400\n");
  EXPECT_EQ(available(), 5000. - 3000. + 800.);
  tell("sys/fs/cgroup/above/own/memory.max", "1000\n");
  EXPECT_EQ(available(), 300.);
  tell("sys/fs/cgroup/above/own/memory.current", "1200\n");  // for a moment it may be above
  EXPECT_EQ(available(), 0.);
  tell("proc/self/cgroup", "0::/\n");  // as within a container
  EXPECT_EQ(available(), 0x1p33);
  tell("sys/fs/cgroup/memory.max", "4000\n");
  EXPECT_EQ(available(), 4000.);
}

// Check the limits of control groups of version 1.
TEST_F(AvailableMemory, IsWhatOldControlGroupsLeave) {
  tell("proc/self/cgroup", "7:cpu,cpuacct:/jobs\n3:memory:/jobs/one\n0::/\n");
  tell("sys/fs/cgroup/memory/jobs/one/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(available(), 0x1p33);
  tell("sys/fs/cgroup/memory/jobs/one/memory.limit_in_bytes", "6000\n");
  tell("sys/fs/cgroup/memory/jobs/one/memory.usage_in_bytes", "2500\n");
  tell("sys/fs/cgroup/memory/jobs/one/memory.stat", "inactive_file 1\ntotal_inactive_file 500\n");
  EXPECT_EQ(available(), 4000.);
}

}  // namespace
