#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace sunfleck::apps {

class Team;

// What every command takes.
struct RunOptions {
  bool json = false;         // machine-readable results on stdout
  bool quiet = false;        // no progress
  int threads = 0;           // 0: all cores
  std::uint64_t seed = 1;    // of random numbers
  std::string command_line;  // as typed, for reports
  Team* team = nullptr;      // of the processes that mpirun started with this one; none: it is alone
};

// A command line check: a finite number in [low, high], or the message "must be <rule>".
CLI::Validator numberIn(double low, double high, const std::string& rule);

// The same of a whole number, in whatever way it is written: for option->transform().
CLI::Validator wholeNumberIn(double low, double high, const std::string& rule);

// Whether a command is one that the processes of a team can do together.
enum class Ranks { one, any };

// Adds a command to `app` and gives it the options of RunOptions.
CLI::App* addCommand(CLI::App& app, RunOptions& options, const std::string& name, const std::string& about,
                     Ranks ranks = Ranks::one);

}  // namespace sunfleck::apps
