#include "apps/bench_run.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "apps/output_folder.hpp"
#include "apps/terminal.hpp"
#include "core/whole_file.hpp"

namespace sunfleck::apps {

int runBench(const std::string& folder_name, const std::vector<std::string>& names, const RunOptions& run,
             const std::function<std::optional<BenchReport>(const Progress&)>& measure) {
  const std::filesystem::path folder(folder_name);
  const OutputFolder made(folder);
  for (const std::string& name : names) requireWritable(folder / name);
  const std::optional<BenchReport> report = measure(terminalProgress("measuring", run.quiet));
  if (!report) {
    fmt::print(stderr, "sunfleck: interrupted: nothing was written\n");
    return 1;
  }
  for (std::size_t i = 0; i < names.size(); ++i) writeWhole(folder / names[i], report->files[i]);
  if (run.json) {
    fmt::print("{}\n", report->json.dump(2));
    return 0;
  }
  fmt::print("{}\nwrote {}", report->table, (folder / names.front()).string());
  for (std::size_t i = 1; i < names.size(); ++i) fmt::print(" and {}", names[i]);
  fmt::print("\n");
  return 0;
}

}  // namespace sunfleck::apps
