#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>

#include "core/detail/toml_file.hpp"
#include "core/require.hpp"
#include "plants/detail/species_table.hpp"
#include "plants/detail/weber_penn_fields.hpp"
#include "plants/species.hpp"

namespace sunfleck {
namespace {

using detail::eachField;

// By their numbers in the paper.
constexpr std::array<std::string_view, 9> kCrowns{"conical",         "spherical",           "hemispherical",
                                                  "cylindrical",     "tapered_cylindrical", "flame",
                                                  "inverse_conical", "tend_flame",          "envelope"};

class SpeciesReader {
 public:
  SpeciesReader(const toml::table& file, const std::string& source) : file_(file), source_(source) {}

  WeberPenn read() {
    WeberPenn parameters;
    eachField(parameters, [&](const std::string& table, const std::string& key, auto& value, float least, float most) {
      known_.insert({table, key});
      if (const toml::node* node = nodeOf(table, key)) set(value, *node, table + "." + key, least, most);
    });
    refuseUnknown();
    return parameters;
  }

 private:
  const toml::node* nodeOf(const std::string& table, const std::string& key) const {
    const toml::node* node = file_.get(table);
    if (!node) return nullptr;
    if (!node->is_table()) refuse(*node, table, "a table: [" + table + "]");
    return node->as_table()->get(key);
  }

  void set(float& value, const toml::node& node, const std::string& name, float least, float most) const {
    const auto given = node.is_number() ? node.value<double>() : std::nullopt;
    const auto rounded = static_cast<float>(given.value_or(0.));
    if (!given || !(rounded >= least && rounded <= most))
      refuse(node, name, fmt::format("a number in [{}, {}]", least, most));
    value = rounded;
  }

  void set(int& value, const toml::node& node, const std::string& name, float least, float most) const {
    const auto given = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    if (!given || !(static_cast<double>(*given) >= double{least} && static_cast<double>(*given) <= double{most}))
      refuse(node, name, fmt::format("a whole number in [{}, {}]", least, most));
    value = static_cast<int>(*given);
  }

  void set(WeberPenn::Shape& value, const toml::node& node, const std::string& name, float, float) const {
    const auto number = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    auto found = kCrowns.end();
    if (number && *number >= 0 && *number < std::ssize(kCrowns)) found = kCrowns.begin() + *number;
    if (const auto text = node.value<std::string_view>(); node.is_string())
      found = std::find(kCrowns.begin(), kCrowns.end(), *text);
    if (found == kCrowns.end())
      refuse(node, name, fmt::format("0 to 8 or one of \"{}\"", fmt::join(kCrowns, "\", \"")));
    value = static_cast<WeberPenn::Shape>(found - kCrowns.begin());
  }

  void set(LeafShape& value, const toml::node& node, const std::string& name, float, float) const {
    std::string names;
    for (const LeafShape shape : leafShapes()) {
      if (node.is_string() && *node.value<std::string_view>() == nameOf(shape)) {
        value = shape;
        return;
      }
      names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", nameOf(shape));
    }
    refuse(node, name, "one of " + names);
  }

  void refuseUnknown() const {
    for (const auto& [table, node] : file_) {
      const std::string name(table.str());
      if (name == "name" || name == "source") {
        if (!node.is_string()) refuse(node, name, "a text in quotes");
        continue;
      }
      const bool any =
          std::any_of(known_.begin(), known_.end(), [&](const auto& known) { return known.first == name; });
      if (!any) refuseKey(node, name, "must be name, source, [tree], [leaves], [pruning] or [level0] to [level3]");
      for (const auto& [key, value] : *node.as_table())
        if (!known_.contains({name, std::string(key.str())}))
          refuseKey(value, name + "." + std::string(key.str()),
                    "see: sunfleck plant --write-species cherry cherry.toml");
    }
  }

  [[noreturn]] void refuseKey(const toml::node& node, const std::string& key, const std::string& rule) const {
    throw InvalidInput(fmt::format("{}:{}: unknown key \"{}\": {}", source_, node.source().begin.line, key, rule));
  }

  [[noreturn]] void refuse(const toml::node& node, const std::string& name, const std::string& rule) const {
    std::ostringstream value;
    if (node.is_table())
      value << "a table";
    else if (const auto* number = node.as_floating_point())
      value << fmt::format("{}", number->get());
    else
      node.visit([&](const auto& v) { value << v; });
    throw InvalidInput(
        fmt::format("{}:{}: {} = {}: must be {}", source_, node.source().begin.line, name, value.str(), rule));
  }

  const toml::table& file_;
  const std::string& source_;
  std::set<std::pair<std::string, std::string>> known_;
};

}  // namespace

WeberPenn detail::parseSpecies(std::string_view text, const std::string& source) {
  WeberPenn parameters;
  readToml(text, source, [&](const toml::table& table) { parameters = SpeciesReader(table, source).read(); });
  return parameters;
}

WeberPenn readSpecies(const std::filesystem::path& file) {
  WeberPenn parameters;
  const std::string source = file.string();
  detail::readToml(file, [&](const toml::table& table) { parameters = SpeciesReader(table, source).read(); });
  return parameters;
}

}  // namespace sunfleck
