#pragma once

#include "apps/run_options.hpp"

// Each command adds itself to the program with its options; when it is chosen it runs and sets `status`, the program's
// exit status: 0 done, 1 ended early.
namespace sunfleck::apps {

void addValidate(CLI::App& app, RunOptions& options, int& status);
void addSlab(CLI::App& app, RunOptions& options, int& status);
void addTables(CLI::App& app, RunOptions& options, int& status);
void addSlabTable(CLI::App& app, RunOptions& options, int& status);
void addLeaf(CLI::App& app, RunOptions& options, int& status);
void addPlant(CLI::App& app, RunOptions& options, int& status);
void addVoxelize(CLI::App& app, RunOptions& options, int& status);
void addTrace(CLI::App& app, RunOptions& options, int& status);
void addSweep(CLI::App& app, RunOptions& options, int& status);
void addMerge(CLI::App& app, RunOptions& options, int& status);
void addRender(CLI::App& app, RunOptions& options, int& status);
void addView(CLI::App& app, RunOptions& options, int& status);
void addBench(CLI::App& app, RunOptions& options, int& status);

}  // namespace sunfleck::apps
