#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "apps/run_part.hpp"
#include "render/reference/trace_store.hpp"

namespace sunfleck::apps {

// A finished row of a sweep.
struct FinishedRow {
  std::string key, figures;
};

// The finished rows of a sweep, in text files beside its table: TABLE.rows, and TABLE.KofN.rows of its parts. Each line
// is a row with its key and a check sum. A file is only ever added to, so that a sweep that is killed at any moment has
// lost nothing but what it was about to finish.
class SweepJournal {
 public:
  // Reads all of the files that are there; a last line that was not finished counts for nothing, and so does a damaged
  // one, of which damaged() tells.
  explicit SweepJournal(const std::filesystem::path& table);

  // Makes ready to write this part's file. Throws InvalidInput when that cannot be written or when another process
  // does.
  void open(const RunPart& part);
  // Writes them, all the way to the disk. Throws std::runtime_error when that fails.
  void add(const std::vector<FinishedRow>& rows);

  // The figures of a row; none if it is not finished.
  const std::string* find(const std::string& key) const;
  const std::vector<std::string>& damaged() const { return damaged_; }  // "FILE:LINE"

 private:
  void read(const std::filesystem::path& file);

  std::filesystem::path table_;
  std::unordered_map<std::string, std::string> rows_;
  std::vector<std::string> damaged_;
  std::unique_ptr<TraceLock> lock_;
  std::filesystem::path own_;
};

}  // namespace sunfleck::apps
