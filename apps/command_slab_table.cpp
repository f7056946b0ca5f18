#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/terminal.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "pp_solver/slab_table_file.hpp"

namespace sunfleck::apps {
namespace {

struct SlabTableOptions {
  std::string input, output;
  double albedo = 0.95;   // omega [1]
  double asymmetry = 0.;  // g [1]
  std::string leaves;     // how they are inclined
  double reflectance = 0.5, transmittance = 0.45;
  double max_megabytes = 64.;
  pp::SlabTableSettings settings;
};

void print(const pp::SlabTable& table, const std::string& file, double seconds, bool json) {
  const pp::SlabTableErrors& errors = table.errors();
  const auto [thickness, depth, mu0, mu] = table.nodes();
  if (json) {
    nlohmann::ordered_json result{{"file", file},
                                  {"medium", table.about()},
                                  {"max_thickness", table.maxThickness()},
                                  {"nodes", table.nodes()},
                                  {"azimuth_modes", table.azimuthModes()},
                                  {"streams", table.streams()},
                                  {"bytes", table.bytes()},
                                  {"error_bound", errors.bound()},
                                  {"radiance_error_max", errors.radiance_max},
                                  {"radiance_error_rms", errors.radiance_rms},
                                  {"power_error_max", errors.power_max},
                                  {"power_error_rms", errors.power_rms},
                                  {"places", errors.places}};
    if (seconds > 0.) result["seconds"] = seconds;
    fmt::print("{}\n", result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  fmt::print("{}\n", table.about());
  fmt::print("  thickness      0 to {:.6g}; thicker slabs are taken as {:.6g}\n", table.maxThickness(),
             table.maxThickness());
  fmt::print("  nodes          {} thickness x {} depth x {} mu0 x {} |mu| x 2 halves, {} azimuth modes\n", thickness,
             depth, mu0, mu, table.azimuthModes());
  fmt::print("  size           {:.2f} MB, made with {} streams\n", 1e-6 * static_cast<double>(table.bytes()),
             table.streams());
  fmt::print("  error bound    {:.2e}, for a beam of irradiance 1: of 4 pi times radiance, and of powers\n",
             errors.bound());
  fmt::print("  errors found   radiance at most {:.2e}, rms {:.2e}; powers at most {:.2e}, rms {:.2e}; {} places\n",
             errors.radiance_max, errors.radiance_rms, errors.power_max, errors.power_rms, errors.places);
  if (seconds > 0.) fmt::print("wrote {} in {:.1f} s\n", file, seconds);
}

int runSlabTable(SlabTableOptions options, const RunOptions& run) {
  if (options.output.empty()) {
    if (options.input.empty())
      throw InvalidInput(
          "slab-table: needs -o FILE.sft to make a table, or a file to read (see: sunfleck slab-table --help)");
    print(pp::readSlabTable(options.input), options.input, 0., run.json);
    return 0;
  }
  requireNamed(options.output, ".sft");
  decltype(pp::Layer::medium) medium;
  if (options.leaves.empty()) {
    medium = Particles{options.albedo, PhaseFunction::henyeyGreenstein(options.asymmetry)};
  } else {
    medium = LeafScattering{.angles = LeafAngles::named(options.leaves),
                            .reflectance = options.reflectance,
                            .transmittance = options.transmittance};
    options.settings.note = options.leaves;
  }
  options.settings.max_bytes = static_cast<std::size_t>(std::lround(options.max_megabytes * 1e6));
  const auto start = std::chrono::steady_clock::now();
  const auto table = pp::SlabTable::build(medium, options.settings, terminalProgress("solving slabs", run.quiet));
  if (!table) {
    fmt::print(stderr, "sunfleck: interrupted: nothing written\n");
    return 1;
  }
  pp::writeSlabTable(options.output, *table);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print(*table, options.output, seconds, run.json);
  return 0;
}

}  // namespace

void addSlabTable(CLI::App& app, RunOptions& options, int& status) {
  auto table = std::make_shared<SlabTableOptions>();
  CLI::App* command = addCommand(app, options, "slab-table",
                                 "Tabulate the exact solution of slabs for shading, or tell what a table holds");
  CLI::Option* input = command->add_option("input", table->input, "A table to read (.sft) instead of making one");
  CLI::Option* output = command->add_option("-o,--output", table->output, "Table to write: .sft");
  CLI::Option* albedo = command->add_option("--omega", table->albedo, "Single-scattering albedo (default 0.95)")
                            ->check(numberIn(0., 1., "in [0, 1]"));
  CLI::Option* asymmetry =
      command->add_option("--g", table->asymmetry, "Asymmetry of Henyey and Greenstein's phase function (default 0)")
          ->check(numberIn(-0.99, 0.99, "in [-0.99, 0.99]"));
  CLI::Option* leaves =
      command
          ->add_option("--leaves", table->leaves, "Leaves inclined like this instead of particles; depth is leaf area")
          ->check(CLI::IsMember({"spherical", "planophile", "erectophile", "plagiophile", "extremophile", "uniform"}));
  CLI::Option* reflectance =
      command->add_option("--reflectance", table->reflectance, "Reflectance of a leaf (default 0.5)")
          ->check(numberIn(0., 1., "in [0, 1]"));
  CLI::Option* transmittance =
      command->add_option("--transmittance", table->transmittance, "Transmittance of a leaf (default 0.45)")
          ->check(numberIn(0., 1., "in [0, 1]"));
  CLI::Option* thickness =
      command->add_option("--max-thickness", table->settings.max_thickness, "Thickest slab of the table (default 16)")
          ->check(numberIn(0.01, 1000., "in [0.01, 1000]"));
  CLI::Option* error = command
                           ->add_option("--max-error", table->settings.max_error,
                                        "Error bound to reach (default 0.02); 0: as small as --max-size allows")
                           ->check(numberIn(0., 1000., "0, or in [1e-6, 1000]"));
  CLI::Option* size = command->add_option("--max-size", table->max_megabytes, "Megabytes to stay within (default 64)")
                          ->check(numberIn(2., 4000., "in [2, 4000]"));
  CLI::Option* streams =
      command->add_option("--streams", table->settings.streams, "Directions of the solver to begin with (default 32)")
          ->check(numberIn(8., 128., "a whole even number, 8 to 128"));
  for (CLI::Option* of_particles : {albedo, asymmetry}) of_particles->excludes(leaves);
  for (CLI::Option* of_leaves : {reflectance, transmittance}) of_leaves->needs(leaves);
  for (CLI::Option* of_making :
       {albedo, asymmetry, leaves, reflectance, transmittance, thickness, error, size, streams})
    of_making->needs(output);
  input->excludes(output);
  command->callback([table, &options, &status] { status = runSlabTable(*table, options); });
}

}  // namespace sunfleck::apps
