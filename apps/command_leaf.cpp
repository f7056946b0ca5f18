#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "apps/commands.hpp"
#include "apps/csv_rows.hpp"
#include "apps/leaf_maps_output.hpp"
#include "apps/leaf_options.hpp"
#include "apps/leaf_output.hpp"
#include "apps/leaf_tissue.hpp"
#include "core/distinct_files.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "leaves/prospect.hpp"

namespace sunfleck::apps {
namespace {

struct LeafCommand {
  std::string species, prospect, bands;
  std::string fit, held;
  bool parts = false, list = false;
  std::string tissue, sides;
  std::string csv, bands_csv, plot;
  bool fit_maps = false;
  LeafMapFiles maps;
};

constexpr std::array<std::string_view, 3> kHeaders{"wavelength_nm,reflectance,transmittance",
                                                   "wavelength_nm,reflectance", "wavelength_nm,transmittance"};

std::string_view headerOf(const std::string& file) {
  std::ifstream in = openedText(file);
  std::string line;
  std::getline(in, line);
  removeByteOrderMark(line);
  removeReturn(line);
  const auto found = std::ranges::find(kHeaders, line);
  return found == kHeaders.end() ? kHeaders.front() : *found;
}

void readMeasured(const std::string& file, LeafReport& leaf) {
  std::error_code failure;
  if (std::filesystem::exists(file, failure) && !std::filesystem::is_regular_file(file, failure))
    throw InvalidInput(file + ": cannot be read: it is no regular file");
  const std::string_view header = headerOf(file);
  const bool reflectance_first = header != kHeaders[2];
  for (const CsvRow& row : readCsvRows(file, header)) {
    const double wavelength = numberAt(row.fields[0], row.where + "wavelength_nm: ");
    require(wavelength > 0. && wavelength < 1e6, row.where + "wavelength_nm", wavelength, "in (0, 1e6)");
    std::array<double, 2> shares{};
    for (std::size_t i = 1; i < row.fields.size(); ++i) {
      const std::string where = fmt::format("{}{}", row.where, fieldsOf(header, ",")[i]);
      shares[i - 1] = numberAt(row.fields[i], where + ": ");
      require(shares[i - 1] >= -0.1 && shares[i - 1] <= 1.1, where, shares[i - 1], "in [-0.1, 1.1]");
    }
    require(row.fields.size() < 3 || shares[0] + shares[1] <= 1.1, row.where + "reflectance + transmittance",
            shares[0] + shares[1], "at most 1.1: 1, and 0.1 for the noise of what is measured");
    if (wavelength < kFirstWavelength || wavelength > kLastWavelength) {
      ++leaf.left_out;
      continue;
    }
    leaf.measured.wavelengths.push_back(wavelength);
    (reflectance_first ? leaf.measured.reflectance : leaf.measured.transmittance).push_back(shares[0]);
    if (row.fields.size() > 2) leaf.measured.transmittance.push_back(shares[1]);
  }
  if (leaf.measured.wavelengths.empty()) throw InvalidInput(file + ": must have at least one row in [400, 2500] nm");
}

void fitTo(const LeafCommand& options, LeafReport& leaf) {
  readMeasured(options.fit, leaf);
  ProspectFitSettings settings{.parts = options.parts, .held = {}};
  if (!options.held.empty()) settings.held = namedNumbers(options.held, "--hold");
  try {
    leaf.fit = fitProspect(leaf.measured, settings);
  } catch (const InvalidInput& e) {
    const std::string wrong = e.what();
    throw InvalidInput((wrong.starts_with("held ") ? "--hold: " : options.fit + ": ") + wrong);
  }
  leaf.contents = leaf.fit->contents;
  leaf.title = std::filesystem::path(options.fit).filename().string();
}

int runList(const RunOptions& run) {
  if (run.json) throw InvalidInput("--json: does not go with --list, which prints names");
  for (const std::string& name : measuredLeafNames()) fmt::print("{:<24}{}\n", name, measuredLeaf(name).title);
  return 0;
}

int runLeaf(const LeafCommand& options, const RunOptions& run) {
  if (options.list) return runList(run);
  if (options.fit_maps) {
    fmt::print("{}", fitMapsReport(options.maps, run.json));
    return 0;
  }
  if (!options.tissue.empty() || !options.sides.empty()) {
    fmt::print("{}",
               options.sides.empty() ? tissueReport(options.tissue, run.json) : sidesReport(options.sides, run.json));
    return 0;
  }
  for (const auto& [file, extension] :
       {std::pair(&options.csv, ".csv"), {&options.bands_csv, ".csv"}, {&options.plot, ".svg"}})
    if (!file->empty()) requireNamed(*file, extension);
  for (const std::string* file : {&options.csv, &options.bands_csv}) requireOther(*file, options.fit);
  requireOther(options.bands_csv, options.csv);
  LeafReport leaf;
  if (!options.bands.empty()) leaf.bands = bandsOf(options.bands, "--bands");
  if (!options.fit.empty()) {
    fitTo(options, leaf);
  } else {
    leaf.contents = leafContentsOf(options.species, options.prospect, "species", "--prospect");
    if (!options.species.empty() && options.prospect.empty()) leaf.species = &measuredLeaf(options.species);
    leaf.title = options.species.empty() ? "Leaf of PROSPECT" : measuredLeaf(options.species).title;
    if (!options.species.empty() && !leaf.species) leaf.title += ", changed";
  }
  leaf.spectrum = prospect(leaf.contents);
  std::string text = run.json ? leafJson(leaf) : leafText(leaf);
  const auto write = [&](const std::string& file, const std::string& content) {
    if (file.empty()) return;
    writeWhole(file, content);
    if (!run.json) text += fmt::format("\nwrote {}\n", file);
  };
  write(options.csv, leafCsv(leaf.spectrum));
  write(options.bands_csv, bandsCsv(leaf));
  write(options.plot, leafPlot(leaf));
  fmt::print("{}", text);
  return 0;
}

std::string footer() {
  std::string text = "Contents, with their ranges; the leaf without any has those in brackets:\n";
  const LeafContents usual;
  for (const LeafContent& content : leafContents())
    text += fmt::format("  {:<20} {:<6} {:g} to {:g} {:<8} ({:g})\n", content.name, content.symbol, content.low,
                        content.high, content.unit, usual.*content.value);
  return text +
         "Protein and carbon-based constituents stand in for dry matter (PROSPECT-PRO). docs/LEAVES.md has more.";
}

// `others`: options that do not go with these.
void addFitMaps(CLI::App& command, LeafCommand& leaf, const std::vector<CLI::Option*>& others) {
  const std::string group = "A slab of tissue behind measured maps";
  CLI::Option* fit_maps = command.add_flag(
      "--fit-maps", leaf.fit_maps,
      "Find tissue, albedo and thickness of every place from images of linear values; places of alpha below 0.5 are "
      "off the leaf");
  CLI::Option* upper =
      command.add_option("--upper-reflectance", leaf.maps.upper_reflectance, "Image of what the upper side reflects");
  CLI::Option* lower = command.add_option("--lower-reflectance", leaf.maps.lower_reflectance,
                                          "Image of what the lower side reflects (as the upper if not given)");
  CLI::Option* through = command.add_option("--transmittance", leaf.maps.transmittance, "Image of what is let through");
  CLI::Option* thickness =
      command.add_option("--thickness", leaf.maps.thickness, "Mean thickness of the leaf in mm (default 0.2)")
          ->check(numberIn(0.001, 250., "in [0.001, 250] mm"));
  CLI::Option* output = command.add_option(
      "-o,--output", leaf.maps.output,
      "NAME.png (16 bits) or NAME.exr: writes NAME_upper, NAME_lower and a scene of this leaf, NAME.toml");
  fit_maps->group(group)->needs(upper)->needs(through)->needs(output);
  for (CLI::Option* option : {upper, lower, through, thickness, output}) option->group(group)->needs(fit_maps);
  for (CLI::Option* option : others) fit_maps->excludes(option);
  for (CLI::Option* option : {upper, lower, through, output})
    option->check([](const std::string& text) { return text.empty() ? "must not be empty" : std::string(); });
}

}  // namespace

void addLeaf(CLI::App& app, RunOptions& options, int& status) {
  auto leaf = std::make_shared<LeafCommand>();
  CLI::App* command =
      addCommand(app, options, "leaf",
                 "What a leaf reflects and lets through, 400 to 2500 nm: of a measured species, by what "
                 "is in it, or found from a measured spectrum");
  CLI::Option* species = command->add_option("species", leaf->species, "A measured species, see --list");
  CLI::Option* list = command->add_flag("--list", leaf->list, "Print the names of the measured species");
  CLI::Option* contents = command->add_option(
      "--prospect", leaf->prospect,
      "Contents of the leaf as NAME=VALUE,..., by PROSPECT-D or PROSPECT-PRO; with a species, what is "
      "different about it");
  CLI::Option* fit = command->add_option(
      "--fit", leaf->fit,
      "Find the contents behind this CSV file, columns wavelength_nm,reflectance[,transmittance] or "
      "wavelength_nm,transmittance");
  CLI::Option* parts = command->add_flag("--protein", leaf->parts,
                                         "Of --fit: find protein and carbon-based constituents, not dry matter");
  CLI::Option* held = command->add_option("--hold", leaf->held, "Of --fit: contents that are known, as NAME=VALUE,...");
  CLI::Option* bands =
      command->add_option("--bands", leaf->bands,
                          "Bands to tell, too, in nm, such as 550,620:680 or 400:2500:50 for as many as are 50 wide");
  CLI::Option* csv = command->add_option("--csv", leaf->csv, "File for the spectrum by 1 nm: .csv");
  CLI::Option* bands_csv =
      command->add_option("--bands-csv", leaf->bands_csv, "File for --bands, as trace --spectrum takes them: .csv");
  CLI::Option* plot = command->add_option("--plot", leaf->plot, "Draw the spectrum into this SVG file");
  CLI::Option* tissue = command->add_option(
      "--tissue", leaf->tissue, "A leaf as a slab: absorption=..,scattering=..,thickness=.. in 1/mm and mm");
  CLI::Option* sides = command->add_option(
      "--sides", leaf->sides, "The slab behind reflectance=..,transmittance=..[,thickness=..] (default 0.2 mm)");
  tissue->excludes(sides);
  for (CLI::Option* option : {species, contents, fit, held, bands, csv, bands_csv, plot, list}) {
    tissue->excludes(option);
    sides->excludes(option);
  }
  fit->excludes(species)->excludes(contents);
  parts->needs(fit);
  held->needs(fit);
  bands_csv->needs(bands);
  for (CLI::Option* option : {species, contents, fit, held, bands, csv, bands_csv, plot, tissue, sides}) {
    list->excludes(option);
    option->check([](const std::string& text) { return text.empty() ? "must not be empty" : std::string(); });
  }
  addFitMaps(*command, *leaf, {species, list, contents, fit, bands, csv, bands_csv, plot, tissue, sides});
  command->footer(footer());
  command->callback([leaf, &options, &status] { status = runLeaf(*leaf, options); });
}

}  // namespace sunfleck::apps
