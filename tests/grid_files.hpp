#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/require.hpp"
#include "grid/density_grid.hpp"
#include "tests/temporary_folder.hpp"

// Files of grids for tests.
namespace sunfleck {

namespace fs = std::filesystem;

inline std::string readBytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void writeBytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// The line that refuses a file; empty when it is read.
inline std::string refusal(const fs::path& file) {
  try {
    DensityGrid::read(file);
  } catch (const InvalidInput& wrong) {
    return wrong.what();
  }
  return "";
}

// A file is refused with one clear line, or its grid is sound.
inline ::testing::AssertionResult refusedOrSound(const fs::path& file) {
  try {
    const DensityGrid grid = DensityGrid::read(file);
    if (!(std::isfinite(grid.leafArea()) && grid.leafArea() >= 0. && grid.at({0.f, 0.f, 0.f}) >= 0.f))
      return ::testing::AssertionFailure() << "leaf area " << grid.leafArea();
  } catch (const InvalidInput& wrong) {
    const std::string line = wrong.what();
    if (!line.starts_with(file.string() + ": ") || line.find('\n') != std::string::npos)
      return ::testing::AssertionFailure() << line;
  }
  return ::testing::AssertionSuccess();
}

inline GridSource sourceNamed(const std::string& name) {
  return {.name = name, .hash = "5e6", .program = "Sunfleck of this test"};
}

}  // namespace sunfleck
