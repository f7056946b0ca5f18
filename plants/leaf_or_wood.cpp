#include "plants/detail/leaf_or_wood.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::array<std::string_view, 11> kLeafWords{"leaf",     "leaves", "foliage", "needle", "needles", "blossom",
                                                      "blossoms", "petal",  "petals",  "flower", "flowers"};
constexpr std::array<std::string_view, 14> kWoodWords{"wood",     "bark",  "trunk", "trunks", "branch",
                                                      "branches", "stem",  "stems", "twig",   "twigs",
                                                      "limb",     "limbs", "bough", "boughs"};

bool matches(const std::string& pattern, const std::string& name) {
  const bool whole = pattern.find_first_of("*?[") != std::string::npos;
  return fnmatch((whole ? pattern : "*" + pattern + "*").c_str(), name.c_str(), FNM_CASEFOLD) == 0;
}

std::vector<std::string> namesOf(const Part& part) {
  std::vector<std::string> names{part.material};
  names.insert(names.end(), part.groups.begin(), part.groups.end());
  names.push_back(part.object);
  std::erase(names, "");
  return names;
}

bool isAll(const std::vector<std::string>& patterns) {
  return std::find(patterns.begin(), patterns.end(), "*") != patterns.end();
}

// Whether a pattern other than "*" matches a name of the part.
bool named(const std::vector<std::string>& patterns, const Part& part) {
  for (const std::string& name : namesOf(part))
    for (const std::string& pattern : patterns)
      if (pattern != "*" && matches(pattern, name)) return true;
  return false;
}

std::string quoted(const Part& part) {
  std::string text;
  const auto add = [&](const std::string& what, const std::string& name) {
    if (!name.empty()) text += (text.empty() ? "" : ", ") + what + " \"" + shown(name) + "\"";
  };
  add("material", part.material);
  for (const std::string& group : part.groups) add("group", group);
  add("object", part.object);
  return text.empty() ? "no name" : text;
}

// The parts in words, the first eight of them.
std::string listed(const std::vector<Part>& parts) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(parts.size(), kShown); ++i) text += (i > 0 ? "; " : "") + quoted(parts[i]);
  if (parts.size() > kShown) text += "; and " + std::to_string(parts.size() - kShown) + " more";
  return text;
}

// The words of a name, in lower case: "OakLeaf_02" is "oak" and "leaf".
std::vector<std::string> wordsOf(std::string_view name) {
  std::vector<std::string> words;
  bool inside = false, capital_before = false;
  for (const char raw : name) {
    const auto c = static_cast<unsigned char>(raw);
    const bool letter = std::isalpha(c) != 0, capital = std::isupper(c) != 0;
    if (letter && (!inside || (capital && !capital_before))) words.emplace_back();
    if (letter) words.back() += static_cast<char>(std::tolower(c));
    inside = letter;
    capital_before = capital;
  }
  return words;
}

std::string lowered(std::string_view name) {
  std::string text(name);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// What a name says: by whole words first ("cottonwood_leaf" is leaf), then by parts of words ("oakleaves").
std::optional<Kind> kindByWords(std::string_view name) {
  const auto decide = [](bool leaf, bool wood) -> std::optional<Kind> {
    if (leaf == wood) return std::nullopt;
    return leaf ? Kind::leaf : Kind::wood;
  };
  const std::vector<std::string> words = wordsOf(name);
  const auto has = [&](const auto& list) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return std::find(list.begin(), list.end(), word) != list.end();
    });
  };
  if (has(kLeafWords) || has(kWoodWords)) return decide(has(kLeafWords), has(kWoodWords));
  const std::string text = lowered(name);
  const auto holds = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(),
                       [&](std::string_view word) { return text.find(word) != std::string::npos; });
  };
  return decide(holds(kLeafWords), holds(kWoodWords));
}

// The material decides; where it says nothing, the groups, then the object.
std::optional<Kind> kindByNames(const Part& part) {
  for (const std::string& name : namesOf(part))
    if (const std::optional<Kind> kind = kindByWords(name)) return kind;
  return std::nullopt;
}

// Brown: hue between red-orange and yellow (10 .. 45 degrees), clearly coloured.
bool isBrown(const glm::vec3& colour) {
  if (!(colour.r > colour.g && colour.g > colour.b)) return false;
  const float range = colour.r - colour.b;
  const float hue = 60.f * (colour.g - colour.b) / range;
  return range > 0.15f * colour.r && hue >= 10.f && hue <= 45.f;
}

[[noreturn]] void refuse(const std::string& source, const std::string& reason, const std::string& remark) {
  throw InvalidInput(source + ": " + reason + (remark.empty() ? "" : " (" + remark + ")") +
                     ": say which with --leaf NAME or --wood NAME, or --leaf '*' when everything is leaf");
}

Verdict tellByRules(const std::vector<Part>& parts, const ImportRules& rules, const std::string& source) {
  Verdict verdict{.kinds = {}, .how = "by the given names"};
  const bool rest_is_leaf = isAll(rules.leaf) || (rules.leaf.empty() && !isAll(rules.wood));
  const bool rest_is_wood = isAll(rules.wood) || (rules.wood.empty() && !isAll(rules.leaf));
  if (isAll(rules.leaf) && isAll(rules.wood)) refuse(source, "everything is asked to be both leaf and wood", "");
  bool any_named = isAll(rules.leaf) || isAll(rules.wood);
  for (const Part& part : parts) {
    const bool leaf = named(rules.leaf, part), wood = named(rules.wood, part);
    if (leaf && wood) refuse(source, "the rules name " + quoted(part) + " as both leaf and wood", "");
    if (!leaf && !wood && !rest_is_leaf && !rest_is_wood)
      refuse(source, "the rules leave open what " + quoted(part) + " is", "");
    any_named = any_named || leaf || wood;
    verdict.kinds.push_back(leaf || (!wood && rest_is_leaf) ? Kind::leaf : Kind::wood);
  }
  if (!any_named) refuse(source, "no name matches the rules; it has " + listed(parts), "");
  return verdict;
}

}  // namespace

void validate(const ImportRules& rules) {
  require(std::isfinite(rules.scale) && rules.scale > 0.f, "scale", rules.scale,
          "a finite number of metres per unit above 0");
  for (const auto& patterns : {rules.leaf, rules.wood})
    for (const std::string& pattern : patterns)
      require(!pattern.empty(), "leaf or wood name", "\"\"", "a name or a pattern with *");
}

Verdict tellApart(const std::vector<Part>& parts, const ImportRules& rules, const std::string& source,
                  const std::string& remark) {
  const auto count = [](const Verdict& verdict, Kind kind) {
    return std::count(verdict.kinds.begin(), verdict.kinds.end(), kind);
  };
  const auto requireLeaf = [&](const Verdict& verdict) {
    if (count(verdict, Kind::leaf) == 0) refuse(source, "has only wood and no leaf (" + listed(parts) + ")", remark);
    return verdict;
  };
  if (!rules.leaf.empty() || !rules.wood.empty()) return requireLeaf(tellByRules(parts, rules, source));

  Verdict by_names{.kinds = {}, .how = "by the names in the file"};
  std::vector<Part> unknown;
  for (const Part& part : parts) {
    const std::optional<Kind> kind = kindByNames(part);
    by_names.kinds.push_back(kind.value_or(Kind::leaf));
    if (!kind) unknown.push_back(part);
  }
  if (unknown.empty()) {
    if (count(by_names, Kind::wood) == 0) by_names.how += "; every name says leaf";
    return requireLeaf(by_names);
  }
  const bool all_coloured = std::all_of(parts.begin(), parts.end(), [](const Part& p) { return p.colour.has_value(); });
  if (unknown.size() == parts.size() && all_coloured) {
    Verdict by_colour{.kinds = {}, .how = "by the materials' colours: brown is wood"};
    for (const Part& part : parts) by_colour.kinds.push_back(isBrown(*part.colour) ? Kind::wood : Kind::leaf);
    if (count(by_colour, Kind::leaf) > 0 && count(by_colour, Kind::wood) > 0) return by_colour;
  }
  refuse(source, "leaf and wood cannot be told apart: no telling what " + listed(unknown) + " is", remark);
}

}  // namespace sunfleck::detail
