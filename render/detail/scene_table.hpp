#pragma once

#define TOML_EXCEPTIONS 1
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/require.hpp"
#include "core/stand.hpp"
#include "render/radians.hpp"
#include "render/scene.hpp"

namespace sunfleck::detail {

// One table of a scene file. Every key is read through it; `done` refuses what nobody asked for.
class SceneTable {
 public:
  // `node`: none if the file lacks the table. `help`: where to learn of its keys.
  SceneTable(const toml::node* node, std::string file_name, std::string name, std::string help = "scene")
      : file_(std::move(file_name)), name_(std::move(name)), help_(std::move(help)) {
    if (node && !node->is_table()) refuse(*node, name_, "a table: [" + name_ + "]");
    if (node) table_ = node->as_table();
  }

  const std::string& file() const { return file_; }
  const std::string& name() const { return name_; }

  bool has(const std::string& key) const { return table_ && table_->contains(key); }

  double number(const std::string& key, double fallback, double low, double high, const std::string& rule) {
    const toml::node* node = take(key);
    return node ? checked(*node, key, low, high, rule) : fallback;
  }

  // An angle given in degrees, 0 unless it is there [rad].
  float degrees(const std::string& key, double low, double high, const std::string& rule) {
    return radiansOf(number(key, 0., low, high, rule));
  }
  // The same, where zero means something of its own.
  float degreesOrZero(const std::string& key, double low, double high) {
    const std::string rule = fmt::format("0 or in [{}, {}]", low, high);
    const double value = number(key, 0., 0., high, rule);
    if (value != 0. && value < low) refuse(*table_->get(key), key, rule);
    return radiansOf(value);
  }

  int count(const std::string& key, int fallback, int high) {
    const toml::node* node = take(key);
    if (!node) return fallback;
    const auto value = node->value<std::int64_t>();
    if (!node->is_integer() || *value < 1 || *value > high)
      refuse(*node, key, fmt::format("a whole number, 1 to {}", high));
    return static_cast<int>(*value);
  }

  bool flag(const std::string& key, bool fallback) {
    const toml::node* node = take(key);
    if (!node) return fallback;
    if (!node->is_boolean()) refuse(*node, key, "true or false");
    return *node->value<bool>();
  }

  std::string text(const std::string& key, const std::string& fallback) {
    const toml::node* node = take(key);
    if (!node) return fallback;
    if (!node->is_string()) refuse(*node, key, "a text in quotes");
    return *node->value<std::string>();
  }

  // A text, or what TOML knows as a date or a time.
  std::string moment(const std::string& key) {
    const toml::node* node = take(key);
    if (node->is_string()) return *node->value<std::string>();
    std::ostringstream text;
    if (const auto* date = node->as_date()) {
      text << date->get();
    } else if (const auto* time = node->as_time()) {
      text << time->get();
    } else {
      refuse(*node, key, "a text in quotes");
    }
    return text.str();
  }

  // A list of exactly `count` numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count, double low, double high,
                              const std::string& rule) {
    const toml::node* node = take(key);
    return numbersOf(*node, key, count, low, high, rule);
  }

  // A table within this one.
  SceneTable within(const std::string& key) { return SceneTable(take(key), file_, name_ + "." + key, help_); }

  // A list of exactly `count` numbers or rising pairs of such, a number for a pair of the same twice.
  std::vector<std::pair<double, double>> ranges(const std::string& key, std::size_t count, double low, double high,
                                                const std::string& rule) {
    const toml::node* node = take(key);
    if (!node->is_array() || node->as_array()->size() != count) refuse(*node, key, rule);
    std::vector<std::pair<double, double>> all;
    for (const toml::node& item : *node->as_array()) {
      const std::vector<double> limits = item.is_array() ? numbersOf(item, key, 2, low, high, rule)
                                                         : std::vector(2, checked(item, key, low, high, rule));
      if (limits[0] > limits[1]) refuse(item, key, rule);
      all.emplace_back(limits[0], limits[1]);
    }
    return all;
  }

  bool isList(const std::string& key) const { return has(key) && table_->get(key)->is_array(); }
  // A number, or a list of one at least; `once` tells whether each must differ from the others.
  std::vector<double> listed(const std::string& key, double low, double high, const std::string& rule,
                             bool once = true) {
    const toml::node* node = take(key);
    const std::string or_list = rule + ", one number or a list of such";
    if (!node->is_array()) return {checked(*node, key, low, high, or_list)};
    if (node->as_array()->empty()) refuse(*node, key, or_list);
    std::vector<double> values;
    std::set<double> seen;
    for (const toml::node& item : *node->as_array()) {
      const double value = checked(item, key, low, high, rule);
      if (!seen.insert(value).second && once) refuse(item, key, "there once");
      values.push_back(value);
    }
    return values;
  }

  // A text, or a list of one at least, none of them twice.
  std::vector<std::string> texts(const std::string& key) {
    const toml::node* node = take(key);
    const std::string rule = "a text in quotes or a list of such";
    if (node->is_string()) return {*node->value<std::string>()};
    if (!node->is_array() || node->as_array()->empty()) refuse(*node, key, rule);
    std::vector<std::string> values;
    std::set<std::string> seen;
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_string()) refuse(item, key, rule);
      const auto value = *item.value<std::string>();
      if (!seen.insert(value).second) refuse(item, key, "there once");
      values.push_back(value);
    }
    return values;
  }

  // One number for all bands, or one for each.
  glm::vec3 perBand(const std::string& key, const glm::vec3& fallback, double high = 1.) {
    const toml::node* node = take(key);
    if (!node) return fallback;
    const std::string rule = fmt::format("in [0, {}]: one number, or three for red, green and blue", high);
    if (!node->is_array()) return glm::vec3(static_cast<float>(checked(*node, key, 0., high, rule)));
    const std::vector<double> v = numbersOf(*node, key, kBands, 0., high, rule);
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }

  // A row of `count` numbers for all bands, or one for each; within low and high.
  std::vector<std::vector<double>> rowPerBand(const std::string& key, const std::vector<double>& low,
                                              const std::vector<double>& high, const std::string& rule) {
    const toml::node* node = take(key);
    if (!node->is_array() || node->as_array()->empty()) refuse(*node, key, rule);
    const toml::array& rows = *node->as_array();
    const bool per_band = rows.get(0)->is_array();
    if (per_band && rows.size() != kBands) refuse(*node, key, rule);
    std::vector<std::vector<double>> bands;
    for (std::size_t band = 0; band < kBands; ++band) {
      const toml::node& row = per_band ? *rows.get(band) : *node;
      if (!row.is_array() || row.as_array()->size() != low.size()) refuse(row, key, rule);
      std::vector<double>& values = bands.emplace_back();
      for (std::size_t i = 0; i < low.size(); ++i)
        values.push_back(checked(*row.as_array()->get(i), key, low[i], high[i], rule));
    }
    return bands;
  }

  // A list of [x, y] or [x, y, rotation_deg], each with or without a kind's name at its end. Trees without take the
  // kinds in turn.
  std::vector<Placement> placements(const std::string& key, const std::vector<TreeKind>& kinds) {
    const toml::node* node = take(key);
    const std::string rule =
        "a list of [x, y] or [x, y, rotation_deg], at least one, each number in [-1e6, 1e6], and each with the name of "
        "a kind of tree at its end or without";
    if (!node->is_array() || node->as_array()->empty()) refuse(*node, key, rule);
    std::vector<Placement> trees;
    for (const toml::node& item : *node->as_array()) {
      if (!item.is_array()) refuse(item, key, rule);
      const toml::array& row = *item.as_array();
      const bool named = !row.empty() && row.back().is_string();
      const std::size_t length = row.size() - (named ? 1 : 0);
      if (length != 2 && length != 3) refuse(item, key, rule);
      std::vector<double> v;
      for (std::size_t i = 0; i < length; ++i) v.push_back(checked(*row.get(i), key, -1e6, 1e6, rule));
      Placement& tree =
          trees.emplace_back(Placement{.position = {static_cast<float>(v[0]), static_cast<float>(v[1]), 0.f}});
      if (length == 3) tree.rotation = radiansOf(v[2]);
      tree.kind =
          named ? kindNamed(row.back(), key, kinds) : static_cast<std::uint32_t>((trees.size() - 1) % kinds.size());
    }
    return trees;
  }

  void done() const {
    if (!table_) return;
    for (const auto& [key, node] : *table_)
      if (std::find(taken_.begin(), taken_.end(), key.str()) == taken_.end())
        throw InvalidInput(fmt::format("{}:{}: unknown key \"{}\" in [{}]; see: sunfleck --help {}", file_,
                                       node.source().begin.line, key.str(), name_, help_));
  }

  [[noreturn]] void refuse(const toml::node& node, const std::string& key, const std::string& rule) const {
    std::ostringstream value;
    if (node.is_table())
      value << "a table";
    else if (const auto* number = node.as_floating_point())
      value << fmt::format("{}", number->get());
    else
      node.visit([&](const auto& v) { value << v; });
    throw InvalidInput(fmt::format("{}:{}: {} = {}: must be {}", file_, node.source().begin.line,
                                   key == name_ || name_.empty() ? key : name_ + "." + key, value.str(), rule));
  }

 private:
  std::uint32_t kindNamed(const toml::node& node, const std::string& key, const std::vector<TreeKind>& kinds) const {
    std::string names;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      if (kinds[kind].name == *node.value<std::string>()) return static_cast<std::uint32_t>(kind);
      names += (names.empty() ? "\"" : ", \"") + kinds[kind].name + "\"";
    }
    refuse(node, key, "the name of a kind of tree: " + names);
  }

  const toml::node* take(const std::string& key) {
    taken_.push_back(key);
    return table_ ? table_->get(key) : nullptr;
  }

  double checked(const toml::node& node, const std::string& key, double low, double high,
                 const std::string& rule) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= low && *value <= high)) refuse(node, key, rule);
    return *value;
  }

  std::vector<double> numbersOf(const toml::node& node, const std::string& key, std::size_t count, double low,
                                double high, const std::string& rule) const {
    if (!node.is_array() || node.as_array()->size() != count) refuse(node, key, rule);
    std::vector<double> values;
    for (const toml::node& item : *node.as_array()) values.push_back(checked(item, key, low, high, rule));
    return values;
  }

  std::string file_, name_, help_;
  const toml::table* table_ = nullptr;
  std::vector<std::string> taken_;
};

}  // namespace sunfleck::detail
