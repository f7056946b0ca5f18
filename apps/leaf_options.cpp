#include "apps/leaf_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/csv_rows.hpp"
#include "core/require.hpp"
#include "leaves/measured_leaves.hpp"

namespace sunfleck::apps {

std::vector<std::pair<std::string, double>> namedNumbers(const std::string& text, const std::string& option) {
  std::vector<std::pair<std::string, double>> values;
  for (const std::string_view part : fieldsOf(text, ",")) {
    const std::size_t middle = part.find('=');
    if (middle == std::string_view::npos)
      throw InvalidInput(
          fmt::format("{}: \"{}\": must be NAME=VALUE, as in chlorophyll=40,water=0.01", option, part.substr(0, 40)));
    const std::string name(part.substr(0, middle));
    values.emplace_back(name, numberAt(part.substr(middle + 1), fmt::format("{}: {} = ", option, name.substr(0, 40))));
  }
  return values;
}

LeafContents leafContentsOf(const std::string& species, const std::string& prospect, const std::string& species_option,
                            const std::string& prospect_option) {
  LeafContents leaf;
  if (!species.empty()) leaf = measuredLeaf(species, species_option).contents;
  if (!prospect.empty()) setContents(leaf, namedNumbers(prospect, prospect_option), prospect_option + ": ");
  return leaf;
}

std::vector<WavelengthBand> bandsOf(const std::string& text, const std::string& option) {
  std::vector<WavelengthBand> bands;
  for (const std::string_view part : fieldsOf(text, ",")) {
    std::vector<double> numbers;
    for (const std::string_view field : fieldsOf(part, ":")) numbers.push_back(numberAt(field, option + ": "));
    if (numbers.size() > 3)
      throw InvalidInput(
          fmt::format("{}: \"{}\": must be a wavelength, FROM:TO or FROM:TO:WIDTH in nm", option, part.substr(0, 40)));
    const WavelengthBand all{numbers.front(), numbers.size() > 1 ? numbers[1] : numbers.front()};
    validate(all, option.c_str());
    if (numbers.size() < 3) {
      bands.push_back(all);
    } else {
      require(numbers[2] >= 1., option + ": width", numbers[2], "at least 1 nm");
      for (int i = 0;; ++i) {
        const double from = all.low + i * numbers[2];
        if (!(from < all.high)) break;
        bands.push_back({from, std::min(from + numbers[2], all.high)});
      }
    }
    require(bands.size() <= kMostTextLines, option + ": bands", bands.size(), "at most 10000");
  }
  return bands;
}

LeafByContents leafOf(const LeafOptions& options) {
  return {.species = options.species,
          .contents = leafContentsOf(options.species, options.prospect, "--leaf-species", "--leaf-prospect")};
}

LightBands lightBandsOf(const LeafOptions& options) {
  if (options.bands.empty()) return std::nullopt;
  const std::vector<WavelengthBand> all = bandsOf(options.bands, "--leaf-bands");
  require(all.size() == kBands, "--leaf-bands: number of bands", all.size(), "3");
  LightBands bands(std::in_place);
  std::ranges::copy(all, bands->begin());
  return bands;
}

}  // namespace sunfleck::apps
