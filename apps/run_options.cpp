#include "apps/run_options.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>
#include <optional>

#include "apps/team.hpp"
#include "core/require.hpp"

namespace sunfleck::apps {

CLI::Validator numberIn(double low, double high, const std::string& rule) {
  return CLI::Validator(
      [=](const std::string& text) -> std::string {
        double value = 0.;
        const bool ok = !text.empty() && CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                        value >= low && value <= high;
        return ok ? std::string() : text + ": must be " + rule;
      },
      "");
}

CLI::Validator wholeNumberIn(double low, double high, const std::string& rule) {
  return CLI::Validator(
      [=](std::string& text) -> std::string {
        if (const std::string wrong = numberIn(low, high, rule)(text); !wrong.empty()) return wrong;
        if (std::uint64_t plain = 0; CLI::detail::lexical_cast(text, plain))
          return {};  // more digits than a double has
        double value = 0.;
        CLI::detail::lexical_cast(text, value);
        if (value != std::floor(value)) return text + ": must be " + rule;
        text = fmt::format("{:.0f}", value);
        return {};
      },
      "");
}

namespace {

void limitThreads(int threads) {
  static std::optional<tbb::global_control> limit;
  if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
}

}  // namespace

CLI::App* addCommand(CLI::App& app, RunOptions& options, const std::string& name, const std::string& about,
                     Ranks ranks) {
  CLI::App* command = app.add_subcommand(name, about);
  command->add_flag("--json", options.json, "Print results as JSON")->group("Common");
  command->add_flag("--quiet", options.quiet, "Show no progress")->group("Common");
  command->add_option("--threads", options.threads, "Number of threads; 0 takes all cores. Results do not depend on it")
      ->transform(wholeNumberIn(0, 1024, "a whole number, 0 to 1024"))
      ->group("Common");
  command->add_option("--seed", options.seed, "Seed of the random numbers (default 1)")
      ->transform(wholeNumberIn(0, 1e18, "a whole number, 0 to 1e18"))
      ->group("Common");
  command->parse_complete_callback([&options, name, ranks] {
    if (options.team && ranks == Ranks::one)
      throw InvalidInput(name + ": must be started without mpirun: it is one process's work");
    if (options.team && options.threads == 0) options.threads = options.team->fairThreads();
    limitThreads(options.threads);
  });
  return command;
}

}  // namespace sunfleck::apps
