#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/reference/trace_store.hpp"

namespace sunfleck::apps {
namespace {

struct MergeOptions {
  std::vector<std::string> files;
  std::string output;
};

std::string textOf(const UnitRanges& units) {
  constexpr std::size_t kMostRanges = 8;
  std::string text;
  const std::vector<UnitRanges::Range> ranges = units.ranges();
  for (std::size_t i = 0; i < std::min(ranges.size(), kMostRanges); ++i)
    text += fmt::format("{}{} to {}", i > 0 ? ", " : "", ranges[i].first, ranges[i].second - 1);
  if (ranges.size() > kMostRanges) text += fmt::format(" and {} more ranges", ranges.size() - kMostRanges);
  return text;
}

int runMerge(const MergeOptions& options, const RunOptions& run) {
  requireNamed(options.output, ".trace");
  const TraceLock lock(options.output);
  TraceFile whole;
  for (const std::string& file : options.files) addPart(whole, readTraceFile(file), file);
  writeTraceFile(options.output, whole);

  nlohmann::ordered_json json;
  for (const TraceSection& section : whole.sections) {
    nlohmann::ordered_json missing = nlohmann::ordered_json::array();
    if (!run.json) {
      fmt::print("{}: {} units", section.name, section.sums.units());
      for (const auto& [seed, units] : section.sums.done())
        fmt::print(", {} of seed {}{}", units.count(), seed,
                   section.asked > 0 ? fmt::format(" of {} asked for", section.asked) : "");
      fmt::print("\n");
    }
    for (const auto& [seed, units] : missingUnits(section)) {
      missing.push_back({{"seed", seed}, {"units", units.ranges()}});
      if (!run.json) fmt::print("  missing of seed {}: {}\n", seed, textOf(units));
    }
    json["sections"].push_back(
        {{"name", section.name}, {"units", section.sums.units()}, {"asked", section.asked}, {"missing", missing}});
  }
  if (run.json)
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  else
    fmt::print("wrote {}: sunfleck trace with --checkpoint and the options of the parts goes on from it\n",
               options.output);
  return 0;
}

}  // namespace

void addMerge(CLI::App& app, RunOptions& options, int& status) {
  auto merge = std::make_shared<MergeOptions>();
  CLI::App* command = addCommand(app, options, "merge",
                                 "Put together trace files of one run: its parts, or runs of other seeds. What is "
                                 "missing is named; files of other "
                                 "scenes, settings or versions and units that come twice are refused");
  command->add_option("files", merge->files, "Trace files (.trace)")->required();
  command->add_option("-o,--output", merge->output, "Trace file to write")->required();
  command->callback([merge, &options, &status] { status = runMerge(*merge, options); });
}

}  // namespace sunfleck::apps
