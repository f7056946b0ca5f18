#pragma once

#include <filesystem>
#include <vector>

namespace sunfleck::apps {

// A folder for results. It and those above it are made where they are not there yet; those that are empty when the work
// ends, because it was ended early or went wrong, go again.
class OutputFolder {
 public:
  explicit OutputFolder(const std::filesystem::path& folder);  // throws InvalidInput where it cannot be made
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  // innermost first
};

}  // namespace sunfleck::apps
