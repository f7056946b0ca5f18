#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "apps/commands.hpp"
#include "apps/team.hpp"
#include "apps/terminal.hpp"
#include "apps/version.hpp"
#include "core/require.hpp"
#include "grid/isolated_read.hpp"
#include "render/scene_file.hpp"

namespace {

using namespace sunfleck;

constexpr int kWrongInput = 2;
constexpr std::string_view kReadGrid = "read-grid";  // how the program calls itself: see grid/isolated_read.hpp

// A user's mistake is told in one line, whatever the message was made of.
std::string oneLine(std::string message) {
  for (char& c : message) {
    if (c == '\n') c = ' ';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';  // a file's bytes must not command the terminal
  }
  return message;
}

int wrongInput(const std::string& message) {
  fmt::print(stderr, "sunfleck: {}\n", oneLine(message));
  return kWrongInput;
}

std::string commandLine(int count, char** arguments) {
  std::string line = "sunfleck";
  for (int i = 1; i < count; ++i) line += std::string(" ") + arguments[i];
  return line;
}

bool asksForSceneHelp(int count, char** arguments) {
  for (int i = 1; i + 1 < count; ++i)
    if (std::string_view(arguments[i]) == "--help" && std::string_view(arguments[i + 1]) == "scene") return true;
  return false;
}

// What was typed, last word first as CLI11 takes it; options without a command are those of validate.
std::vector<std::string> withCommand(const CLI::App& app, int count, char** arguments) {
  std::vector<std::string> words(std::make_reverse_iterator(arguments + count),
                                 std::make_reverse_iterator(arguments + 1));
  // "--help COMMAND" is "COMMAND --help".
  if (words.size() > 1 && (words.back() == "--help" || words.back() == "-h"))
    std::rotate(words.begin(), words.end() - 1, words.end());
  static constexpr std::array own{"-h", "--help", "--version"};
  const auto saysWhatToDo = [&](const std::string& word) {
    return std::find(own.begin(), own.end(), word) != own.end() ||
           !app.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; }).empty();
  };
  const bool starts_with_option = words.empty() || words.back().starts_with('-');
  if (starts_with_option && std::none_of(words.begin(), words.end(), saysWhatToDo)) words.emplace_back("validate");
  return words;
}

int run(int count, char** arguments, apps::Team* team) {
  if (asksForSceneHelp(count, arguments)) {
    fmt::print("{}", sceneFileHelp());
    return 0;
  }
  CLI::App app(
      "Sunfleck computes how sunlight scatters in foliage: exactly where that is possible, fast where it must be, and "
      "with "
      "a measured error always.\nWithout a command it validates the models on the built-in cherry tree.",
      "sunfleck");
  app.set_version_flag("--version", versionText());
  app.footer(
      "sunfleck COMMAND --help shows a command's options; sunfleck --help scene, every key of a scene file.\n"
      "Exit status: 0 done; 2 wrong input or usage; 1 anything else.");
  app.require_subcommand(0, 1);
  apps::RunOptions options;
  options.command_line = commandLine(count, arguments);
  options.team = team;
  int status = 0;
  apps::addValidate(app, options, status);
  apps::addSlab(app, options, status);
  apps::addTables(app, options, status);
  apps::addSlabTable(app, options, status);
  apps::addLeaf(app, options, status);
  apps::addPlant(app, options, status);
  apps::addVoxelize(app, options, status);
  apps::addTrace(app, options, status);
  apps::addSweep(app, options, status);
  apps::addMerge(app, options, status);
  apps::addRender(app, options, status);
  apps::addView(app, options, status);
  apps::addBench(app, options, status);
  try {
    app.parse(withCommand(app, count, arguments));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // help and version
    return wrongInput(std::string(e.what()) + " (see: sunfleck --help)");
  }
  return status;
}

}  // namespace

int main(int count, char** arguments) {
  const std::span<char*> words(arguments, static_cast<std::size_t>(count));
  if (words.size() == 6 && words[1] == kReadGrid)
    return sunfleck::serveIsolatedRead(words[2], words[3], std::strtoull(words[4], nullptr, 10),
                                       std::strtoull(words[5], nullptr, 10));
  apps::catchInterrupts();
  std::unique_ptr<apps::Team> team;
  try {
    team = apps::joinTeam();
    const int status = run(count, arguments, team.get());
    if (std::fflush(stdout) == 0) return status;
    fmt::print(stderr, "sunfleck: the results could not be printed: {}\n", std::strerror(errno));
    return 1;
  } catch (const sunfleck::InvalidInput& e) {
    if (team) team->fail(kWrongInput, oneLine(e.what()));
    return wrongInput(e.what());
  } catch (const std::exception& e) {
    if (team) team->fail(1, std::string("failed: ") + e.what());
    fmt::print(stderr, "sunfleck: failed: {}\n", e.what());
    return 1;
  }
}
