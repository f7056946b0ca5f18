#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

#include "apps/commands.hpp"
#include "apps/run_part.hpp"
#include "apps/sweep_journal.hpp"
#include "apps/sweep_queue.hpp"
#include "apps/sweep_scene.hpp"
#include "apps/sweep_task.hpp"
#include "apps/team.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "render/reference/trace_run.hpp"

namespace sunfleck::apps {
namespace {

using Json = nlohmann::ordered_json;

struct SweepChoices {
  std::string file, table, part;
  bool dry_run = false;
  const CLI::Option* seed = nullptr;
};

// Keeps ready the scene of the last task.
class Scenes {
 public:
  Scenes(const SweepFile& sweep, std::uint64_t seed) : sweep_(sweep), seed_(seed) {}

  SweepScene& of(const SweepTask& task) {
    if (!ready_ || task.scene != number_) {
      ready_.reset();
      ready_ = std::make_unique<SweepScene>(sweep_, task.scene, seed_);
      number_ = task.scene;
    }
    return *ready_;
  }

 private:
  const SweepFile& sweep_;
  std::uint64_t seed_;
  std::unique_ptr<SweepScene> ready_;
  std::size_t number_ = 0;
};

// The rows of a sweep and what is known of them.
class SweepRun {
 public:
  SweepRun(const SweepChoices& options, const RunOptions& run, const SweepFile& sweep, std::uint64_t seed)
      : options_(options), run_(run), sweep_(sweep), scenes_(sweep, seed), journal_(options.table) {
    const std::size_t tasks = taskCount(sweep_);
    const Progress progress = terminalProgress("reading scenes", run.quiet);
    for (std::size_t i = 0; i < tasks; ++i) {
      const SweepTask task = taskAt(sweep_, i);
      rows_.push_back(scenes_.of(task).rows(task));
      if (!goOn(progress, static_cast<double>(i + 1) / static_cast<double>(tasks)))
        throw std::runtime_error("interrupted");
    }
    if (!options.part.empty()) part_ = partNamed(options.part);
    const UnitRanges own = partOf(taskCount(sweep_), part_.number, part_.of);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (own.contains(i) && missingOf(i) > 0) left_.push_back({.task = i, .scene = taskAt(sweep_, i).scene});
    if (const std::vector<std::string>& damaged = journal_.damaged(); !damaged.empty())
      fmt::print(stderr, "sunfleck: {}: damaged{}: computed anew where it is missing\n", damaged.front(),
                 damaged.size() > 1 ? fmt::format(", as are {} lines more", damaged.size() - 1) : "");
  }

  int tell() {
    std::size_t missing = 0;
    double seconds = 0., of_scene = 0.;
    std::optional<std::size_t> guessed;
    if (!run_.json) fmt::print("{},finished\n", sweepHeader().substr(0, sweepHeader().find(",paths,")));
    for (const auto& of_task : rows_)
      for (const SweepRow& row : of_task) {
        const bool finished = journal_.find(row.key);
        missing += !finished;
        if (!run_.json) fmt::print("{},{}\n", row.inputs, finished ? "yes" : "no");
      }
    // Suns and optics of a scene take about the same.
    for (const SweepQueue::Entry& entry : left_) {
      if (interrupted()) break;
      const SweepTask task = taskAt(sweep_, entry.task);
      if (guessed != entry.scene) of_scene = scenes_.of(task).guessedSeconds(task);
      guessed = entry.scene;
      seconds += of_scene;
    }
    if (run_.json)
      fmt::print(
          "{}\n",
          Json{{"rows", rowCount()}, {"missing", missing}, {"tasks", left_.size()}, {"cpu_seconds", seconds}}.dump(2));
    else
      fmt::print("{} rows, {} of them to be computed by {} traces: about {:.2g} minutes of one processor\n", rowCount(),
                 missing, left_.size(), seconds / 60.);
    return 0;
  }

  int work() {
    journal_.open(part_);
    SweepQueue queue(left_, run_.team ? run_.team->size() : 1);
    const Progress progress = terminalProgress("sweep", run_.quiet);
    std::atomic<std::size_t> done = 0;
    std::atomic<bool> stopped = false;
    std::mutex adding;
    const auto add = [&](std::size_t task, const std::vector<std::string>& figures) {
      std::vector<FinishedRow> finished;
      for (std::size_t i = 0; i < figures.size(); ++i) finished.push_back({rows_[task][i].key, figures[i]});
      const std::scoped_lock lock(adding);
      journal_.add(finished);
      ++done;
    };
    std::jthread others;
    if (run_.team) others = std::jthread([&] { deal(queue, add, stopped); });
    try {
      for (std::optional<std::size_t> number; !stopped && !interrupted() && (number = queue.take(0));) {
        const SweepTask task = taskAt(sweep_, *number);
        const auto figures = scenes_.of(task).figures(task, run_.threads, [&](double of_task) {
          const double all = (static_cast<double>(done) + of_task) / static_cast<double>(left_.size());
          return goOn(progress, std::min(all, 1.)) && !stopped;
        });
        if (figures) add(*number, *figures);
      }
    } catch (const std::exception& e) {
      if (run_.team) run_.team->fail(1, std::string("failed: ") + e.what());  // the others may be waiting
      throw;
    }
    if (interrupted()) queue.stop();
    if (others.joinable()) others.join();
    computed_ = done;
    return finish();
  }

 private:
  std::size_t rowCount() const {
    return sweep_.scenes.size() * sweep_.suns.size() * sweep_.optics.size() * sweep_.rowsEach();
  }

  std::size_t missingOf(std::size_t task) const {
    return static_cast<std::size_t>(std::count_if(rows_[task].begin(), rows_[task].end(),
                                                  [&](const SweepRow& row) { return !journal_.find(row.key); }));
  }

  // Has the other ranks work until nothing is left, keeping what they find.
  template <typename Add>
  void deal(SweepQueue& queue, const Add& add, std::atomic<bool>& stopped) {
    Team& team = *run_.team;
    try {
      for (int busy = team.size() - 1; busy > 0;) {
        const auto message = team.heard();
        if (!message) {
          if (interrupted()) queue.stop();
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
          continue;
        }
        const auto& [rank, text] = *message;
        const Json told = Json::parse(text);
        if (told.contains("figures"))
          add(told.at("task").get<std::size_t>(), told.at("figures").get<std::vector<std::string>>());
        if (told.contains("stopped")) {
          stopped = true;
          queue.stop();
        }
        const std::optional<std::size_t> task = queue.take(rank);
        team.answer(rank, task ? Json{{"task", *task}, {"key", rows_[*task][0].key}}.dump() : Json::object().dump());
        busy -= !task;
      }
    } catch (const std::exception& e) {
      team.fail(1, std::string("failed: ") + e.what());
    }
  }

  int finish() {
    const bool ended_early = computed_ < left_.size();
    std::size_t missing = 0;
    std::string text = sweepHeader() + '\n';
    for (const auto& of_task : rows_)
      for (const SweepRow& row : of_task) {
        const std::string* const figures = journal_.find(row.key);
        missing += !figures;
        if (figures) text += row.inputs + ',' + *figures + '\n';
      }
    const bool whole = part_.of == 1;
    if (whole) writeWhole(options_.table, text);
    if (run_.json)
      fmt::print("{}\n", Json{{"rows", rowCount()},
                              {"missing", missing},
                              {"traces", computed_},
                              {"table", whole ? Json(options_.table) : Json()}}
                             .dump(2, ' ', false, Json::error_handler_t::replace));
    else if (whole)
      fmt::print("wrote {}: {} of {} rows, by {} traces now\n", options_.table, rowCount() - missing, rowCount(),
                 computed_);
    else
      fmt::print("part {} of {}: by {} traces now; {} of {} rows are there: sunfleck sweep without --part writes {}\n",
                 part_.number + 1, part_.of, computed_, rowCount() - missing, rowCount(), options_.table);
    if (ended_early) fmt::print(stderr, "sunfleck: ended early: the same command goes on\n");
    return ended_early ? 1 : 0;
  }

  const SweepChoices& options_;
  const RunOptions& run_;
  const SweepFile& sweep_;
  Scenes scenes_;
  SweepJournal journal_;
  RunPart part_;
  std::vector<std::vector<SweepRow>> rows_;  // of each task
  std::vector<SweepQueue::Entry> left_;      // of this part
  std::size_t computed_ = 0;
};

// The work of a rank that is not the first: what that one deals.
void workFor(Team& team, const SweepFile& sweep, std::uint64_t seed, int threads) {
  Scenes scenes(sweep, seed);
  Json result = Json::object();
  for (;;) {
    team.tellFirst(result.dump());
    const Json order = Json::parse(team.hearFirst());
    if (!order.contains("task")) return;
    const auto number = order.at("task").get<std::size_t>();
    const SweepTask task = taskAt(sweep, number);
    SweepScene& scene = scenes.of(task);
    if (scene.rows(task)[0].key != order.at("key"))
      throw InvalidInput(sweep.sceneFile(task.scene) +
                         ": differs from that of rank 0: must be the same, as must the program");
    const auto figures = scene.figures(task, threads, [](double) { return !interrupted(); });
    result = figures ? Json{{"task", number}, {"figures", *figures}} : Json{{"stopped", true}};
  }
}

int runSweep(const SweepChoices& options, const RunOptions& run) {
  const SweepFile sweep = readSweepFile(options.file);
  const std::uint64_t seed = options.seed->count() > 0 ? run.seed : sweep.seed.value_or(run.seed);
  requireNamed(options.table, ".csv");
  if (run.team && options.dry_run) throw InvalidInput("--dry-run: must be started without mpirun");
  if (run.team && run.team->rank() > 0) {
    workFor(*run.team, sweep, seed, run.threads);
    return 0;
  }
  SweepRun work(options, run, sweep, seed);
  return options.dry_run ? work.tell() : work.work();
}

}  // namespace

void addSweep(CLI::App& app, RunOptions& options, int& status) {
  auto sweep = std::make_shared<SweepChoices>();
  CLI::App* command =
      addCommand(app, options, "sweep",
                 "Monte Carlo, and errors of the models against it, for many scenes, suns and optics: "
                 "a row of a table for each combination. What is finished is kept: ended at any moment, "
                 "or with another file, it computes what is missing. mpirun -n N sunfleck sweep ... deals "
                 "them out to N processes. Keys of the file: sunfleck --help sweep",
                 Ranks::any);
  command->add_option("file", sweep->file, "What to combine (.toml)")->required();
  command->add_option("-o,--output", sweep->table, "Table to write (.csv); finished rows are kept beside it, in .rows")
      ->required();
  command->add_option("--part", sweep->part,
                      "Compute the K-th of N equal parts, K/N, on one of N machines; a run without --part then writes "
                      "the table. In a Slurm array: $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT");
  command->add_flag("--dry-run", sweep->dry_run, "Tell the rows and about how long they take; compute nothing");
  sweep->seed = command->get_option("--seed");
  command->footer(sweepFileHelp());
  command->callback([sweep, &options, &status] { status = runSweep(*sweep, options); });
}

}  // namespace sunfleck::apps
