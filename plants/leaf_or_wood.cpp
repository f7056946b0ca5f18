#include "plants/detail/leaf_or_wood.hpp"

#include <fnmatch.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::array<std::string_view, 11> kLeafWords{"leaf",     "leaves", "foliage", "needle", "needles", "blossom",
                                                      "blossoms", "petal",  "petals",  "flower", "flowers"};
constexpr std::array<std::string_view, 14> kWoodWords{"wood",     "bark",  "trunk", "trunks", "branch",
                                                      "branches", "stem",  "stems", "twig",   "twigs",
                                                      "limb",     "limbs", "bough", "boughs"};

enum class Match { none, by_pattern, exact };

Match matches(const std::string& pattern, const std::string& name) {
  if (strcasecmp(pattern.c_str(), name.c_str()) == 0) return Match::exact;
  const bool whole = pattern.find_first_of("*?[") != std::string::npos;
  const bool fits = fnmatch((whole ? pattern : "*" + pattern + "*").c_str(), name.c_str(), FNM_CASEFOLD) == 0;
  return fits ? Match::by_pattern : Match::none;
}

// In the order in which they are asked: material, groups, object.
std::vector<std::string_view> namesOf(const Part& part) {
  std::vector<std::string_view> names{part.material};
  if (part.one_group) {
    names.push_back(part.groups);
  } else {
    for (std::string_view left = part.groups; !left.empty();) {
      const std::size_t start = std::min(left.find_first_not_of(" \t"), left.size());
      const std::size_t end = std::min(left.find_first_of(" \t", start), left.size());
      names.push_back(left.substr(start, end - start));
      left.remove_prefix(end);
    }
  }
  names.push_back(part.object);
  std::erase(names, "");
  return names;
}

bool isAll(const std::vector<std::string>& patterns) {
  return std::find(patterns.begin(), patterns.end(), "*") != patterns.end();
}

std::string quoted(const Part& part) {
  std::string text;
  const auto add = [&](const std::string& what, std::string_view name) {
    if (!name.empty()) text += (text.empty() ? "" : ", ") + what + " \"" + shown(name) + "\"";
  };
  add("material", part.material);
  Part of_groups = part;
  of_groups.material = of_groups.object = {};
  for (const std::string_view group : namesOf(of_groups)) add("group", group);
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
  for (const std::string_view name : namesOf(part))
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

// The user's patterns and what they have matched so far.
class Patterns {
 public:
  Patterns(const std::vector<std::string>& patterns, const char* kind)
      : patterns_(patterns), kind_(kind), used_(patterns.size(), false) {}

  // The best match of a name with a pattern other than "*".
  Match match(const std::string& name) {
    Match best = Match::none;
    for (std::size_t i = 0; i < patterns_.size(); ++i) {
      if (patterns_[i] == "*") continue;
      const Match match = matches(patterns_[i], name);
      used_[i] = used_[i] || match != Match::none;
      best = std::max(best, match);
    }
    return best;
  }

  void requireUsed(const std::vector<Part>& parts, const std::string& source) const {
    for (std::size_t i = 0; i < patterns_.size(); ++i)
      if (!used_[i] && patterns_[i] != "*")
        throw InvalidInput(source + ": " + kind_ + " \"" + shown(patterns_[i]) +
                           "\": must match a material, group or object; it has " + listed(parts));
  }

 private:
  const std::vector<std::string>& patterns_;
  const char* kind_;
  std::vector<bool> used_;
};

// What a part's names are by the rules: the first name that a pattern matches decides, and of patterns that match the
// same name the one that is the whole name.
class RuleJudge {
 public:
  RuleJudge(const ImportRules& rules, const std::string& source)
      : leaf_(rules.leaf, "leaf"), wood_(rules.wood, "wood"), source_(source) {}

  std::optional<Kind> kindOf(const Part& part) {
    std::optional<Kind> decided;
    for (const std::string_view name : namesOf(part)) {
      const auto [leaf, wood] = matchesOf(name);
      if (decided || leaf == wood) {
        if (!decided && leaf != Match::none)
          refuse(source_, "the rules name " + quoted(part) + " as both leaf and wood", "");
        continue;
      }
      decided = leaf > wood ? Kind::leaf : Kind::wood;
    }
    return decided;
  }

  void requireUsed(const std::vector<Part>& parts) const {
    leaf_.requireUsed(parts, source_);
    wood_.requireUsed(parts, source_);
  }

 private:
  // Each name is asked once: a file may have as many parts as leaves, of one material.
  std::pair<Match, Match> matchesOf(std::string_view name) {
    const auto [known, is_new] = known_.try_emplace(name);
    if (is_new) known->second = {leaf_.match(std::string(name)), wood_.match(std::string(name))};
    return known->second;
  }

  Patterns leaf_, wood_;
  std::unordered_map<std::string_view, std::pair<Match, Match>> known_;
  const std::string& source_;
};

Verdict tellByRules(const std::vector<Part>& parts, const ImportRules& rules, const std::string& source) {
  Verdict verdict{.kinds = {}, .how = "by the given names"};
  if (isAll(rules.leaf) && isAll(rules.wood)) refuse(source, "everything is asked to be both leaf and wood", "");
  std::optional<Kind> rest;
  if (isAll(rules.leaf) || (rules.leaf.empty() && !isAll(rules.wood))) rest = Kind::leaf;
  if (isAll(rules.wood) || (rules.wood.empty() && !isAll(rules.leaf))) rest = Kind::wood;
  RuleJudge judge(rules, source);
  const Part* open = nullptr;
  for (const Part& part : parts) {
    const std::optional<Kind> kind = judge.kindOf(part);
    if (!kind && !rest && !open) open = &part;
    verdict.kinds.push_back(kind.value_or(rest.value_or(Kind::leaf)));
  }
  judge.requireUsed(parts);
  if (open) refuse(source, "the rules leave open what " + quoted(*open) + " is", "");
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
