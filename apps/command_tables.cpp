#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/terminal.hpp"
#include "render/compare/paper_slab_tables.hpp"
#include "render/compare/slab_tables.hpp"

namespace sunfleck::apps {
namespace {

using Models = std::vector<const SlabModel*>;
using Rows = std::vector<SlabTableRow>;

// The RMS over the rows of one model that `wanted` names [%].
template <typename Wanted>
double percent(const Rows& rows, const SlabModel* model, int table, const Wanted& wanted) {
  double squares = 0.;
  int count = 0;
  for (const SlabTableRow& row : rows)
    if (row.table == table && row.model == model && wanted(row)) {
      squares += row.rms * row.rms;
      ++count;
    }
  return 100. * std::sqrt(squares / std::max(count, 1));
}

bool isAlbedo(const SlabTableRow& row, std::size_t albedo) {  // the one after the last: all
  return albedo >= paper::kAlbedos.size() || row.albedo == paper::kAlbedos[albedo];
}

std::string albedoName(std::size_t albedo) {
  return albedo < paper::kAlbedos.size() ? fmt::format("{:g}", paper::kAlbedos[albedo]) : "total";
}

std::string header(const Models& models, const std::string& paper_columns) {
  std::string text = fmt::format("  {:<8}{}", "albedo", paper_columns);
  for (const SlabModel* model : models) text += fmt::format(" {:>9}", model->name);
  return text + "\n";
}

std::string firstTable(const Rows& rows, const Models& models) {
  std::string text =
      fmt::format("Table 1: RMS error of radiance in a slab of thickness {:g} [%]\n", paper::kTable1Thickness);
  for (const paper::Table1Column& column : paper::kTable1) {
    text += fmt::format("\ng = {:g}\n", column.asymmetry) +
            header(models, fmt::format("{:>9} {:>9}", "paper S", "paper R"));
    for (std::size_t a = 0; a < column.refined.size(); ++a) {
      text += fmt::format("  {:<8}{:9.1f} {:9.1f}", albedoName(a), column.simplified[a], column.refined[a]);
      for (const SlabModel* model : models)
        text += fmt::format(" {:9.3f}", percent(rows, model, 1, [&](const SlabTableRow& row) {
                              return row.asymmetry == column.asymmetry && isAlbedo(row, a);
                            }));
      text += '\n';
    }
  }
  return text;
}

std::string secondTable(const Rows& rows, const Models& models) {
  std::string text = "\nTable 2: the same by thickness; ours over the three g of Table 1 [%]\n";
  for (const paper::Table2Column& column : paper::kTable2) {
    text += fmt::format("\nthickness {:g}\n", column.thickness) + header(models, fmt::format("{:>9}", "paper R"));
    for (std::size_t a = 0; a < column.refined.size(); ++a) {
      text += fmt::format("  {:<8}{:9.1f}", albedoName(a), column.refined[a]);
      for (const SlabModel* model : models)
        text += fmt::format(" {:9.3f}", percent(rows, model, 2, [&](const SlabTableRow& row) {
                              return row.thickness == column.thickness && isAlbedo(row, a);
                            }));
      text += '\n';
    }
  }
  return text;
}

std::string irradianceTable(const std::vector<double>& irradiance, const Models& models) {
  std::string text =
      fmt::format("\nIrradiance of leaves in slabs of thickness 1 .. 16: RMS error [%]\n\n{}", header(models, ""));
  text += fmt::format("  {:<8g}", kIrradianceAlbedo);
  for (const double error : irradiance) text += fmt::format(" {:9.3f}", 100. * error);
  return text + '\n';
}

std::string notes(const Models& models) {
  std::string text =
      "\nEach is against the exact solution (N = 32): diffuse radiance over all directions, depths 0, 1 ... 10 (or to "
      "the\n"
      "thickness) and beams 0, 10 ... 60 degrees from the normal, per power that arrives; total: RMS over the "
      "albedos.\n"
      "Irradiance: (P+ + P-) / 2 at eleven depths, isotropic, sun upright; RMS of the errors over RMS of the exact "
      "values.\n"
      "paper: Shinya et al. 2013, S simplified, R refined; how many directions and depths it takes, how it forms its\n"
      "total and which g its Table 2 is for is not printed.\n";
  for (const SlabModel* model : models) text += fmt::format("{}: {}\n", model->name, model->label);
  return text;
}

std::string json(const Rows& rows, const std::vector<double>& irradiance, const Models& models) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SlabTableRow& row : rows) {
    nlohmann::ordered_json entry{{"table", row.table}, {"g", row.asymmetry}, {"albedo", row.albedo}};
    if (std::isfinite(row.thickness))
      entry["thickness"] = row.thickness;
    else
      entry["thickness"] = "inf";  // JSON has no such number
    entry["model"] = row.model->name;
    entry["rms"] = row.rms;
    list.push_back(std::move(entry));
  }
  nlohmann::ordered_json leaves = nlohmann::ordered_json::array();
  for (std::size_t m = 0; m < models.size(); ++m)
    leaves.push_back({{"g", 0},
                      {"albedo", kIrradianceAlbedo},
                      {"mu0", 1},
                      {"thickness", {1, 16}},
                      {"model", models[m]->name},
                      {"rms", irradiance[m]}});
  return nlohmann::ordered_json{{"rows", std::move(list)}, {"leaf_irradiance", std::move(leaves)}}.dump(2) + "\n";
}

int runTables(const RunOptions& run) {
  const Models models = judgedSlabModels();
  const Rows rows = slabTables(models, terminalProgress("solving", run.quiet));
  if (rows.empty()) {
    fmt::print(stderr, "sunfleck: interrupted before the tables were done\n");
    return 1;
  }
  const std::vector<double> irradiance = slabIrradianceErrors(models, kIrradianceAlbedo);
  fmt::print("{}", run.json ? json(rows, irradiance, models)
                            : firstTable(rows, models) + secondTable(rows, models) +
                                  irradianceTable(irradiance, models) + notes(models));
  return 0;
}

}  // namespace

void addTables(CLI::App& app, RunOptions& options, int& status) {
  CLI::App* command =
      addCommand(app, options, "tables", "Tables 1 and 2 of Shinya et al. 2013, errors of slab models, beside ours");
  command->callback([&options, &status] { status = runTables(options); });
}

}  // namespace sunfleck::apps
