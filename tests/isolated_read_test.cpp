#include "grid/isolated_read.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <string>

#include "grid_files.hpp"
#include "random_leaves.hpp"

namespace {

using namespace sunfleck;
using Clock = std::chrono::steady_clock;

// A reader that does what a shell script says: $2 is the file, $3 where the grid goes.
class Isolated : public ::testing::Test {
 protected:
  Isolated() { DensityGrid::voxelize(randomLeaves(100, .5f, .1f, glm::vec3(2.f)), .1f).write(file, sourceNamed("x")); }
  DensityGrid readBy(const std::string& script, double seconds = 30., const Progress& progress = {}) {
    const fs::path program = folder / "reader.sh";
    writeBytes(program, "#!/bin/sh\n" + script + "\n");
    fs::permissions(program, fs::perms::owner_all);
    return readIsolated(file, progress, {.program = program.string(), .seconds = seconds});
  }
  std::string refusalBy(const std::string& script, double seconds = 30.) {
    try {
      readBy(script, seconds);
    } catch (const InvalidInput& e) {
      return e.what();
    }
    return "";
  }
  std::string refused(const std::string& why) const { return file.string() + ": " + why; }

  const TemporaryFolder folder;
  const fs::path file = folder / "a.vdb";
};

// Check that the grid comes back as it was read, values and places.
TEST_F(Isolated, GivesTheGridOfTheReader) {
  const DensityGrid grid = DensityGrid::read(file), same = readBy("cat \"$2\" >\"$3\"");
  EXPECT_EQ(same.leafArea(), grid.leafArea());
  EXPECT_EQ(same.occupiedCells(), grid.occupiedCells());
  EXPECT_EQ(same.occupied().low, grid.occupied().low);
  EXPECT_EQ(same.projectedLeafArea({0.f, 0.f, 1.f}), grid.projectedLeafArea({0.f, 0.f, 1.f}));
}

// Check that each way in which a reader can end is one line: its own refusal, a crash, nothing and nonsense in place of
// a grid.
TEST_F(Isolated, RefusesWhatItsReaderDoesNotMaster) {
  EXPECT_EQ(refusalBy("echo \"$2: is not what it seems\" >&2; echo more >&2; exit 2"), refused("is not what it seems"));
  EXPECT_EQ(
      refusalBy("kill -SEGV $$"),
      refused("is corrupt, or needs more memory than there is: reading it ended by signal 11, Segmentation fault"));
  EXPECT_EQ(refusalBy("kill -XCPU $$"), refused("takes more than 30 s to read"));
  EXPECT_EQ(refusalBy(""), refused("is read as a grid that is empty"));
  EXPECT_EQ(refusalBy("echo nonsense >\"$3\""), refused("is read as a grid that is not a .vdb file"));
  EXPECT_EQ(refusalBy("yes | head -c 100000 >&2; exit 2"), "y");
  EXPECT_THROW(readBy("exit 1"), std::runtime_error);
  EXPECT_THROW(readIsolated(file, {}, {.program = (folder / "none").string()}), std::runtime_error);
}

// Check that a reader that hangs is ended when its time is over, or when the user says so, and does not stay.
TEST_F(Isolated, EndsAReaderThatHangs) {
  const auto start = Clock::now();
  EXPECT_EQ(refusalBy("exec sleep 60", 0.2), refused("takes more than 1 s to read"));
  EXPECT_THROW(readBy("exec sleep 60", 30., [](double) { return false; }), std::runtime_error);
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(20));  // of 60
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
