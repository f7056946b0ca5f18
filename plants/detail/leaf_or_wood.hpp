#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plants/import.hpp"

namespace sunfleck::detail {

struct Opacity;

// Faces of a file that bear the same names, which lie in what was read of the file.
struct Part {
  std::string_view material, object;
  std::string_view groups;           // names of groups apart by blanks, or one name
  bool one_group = false;            // whether `groups` is one name, blanks and all
  std::optional<glm::vec3> colour;   // diffuse colour of the material [1], when the file's materials are known
  const Opacity* opacity = nullptr;  // of the material; null: all of it is there
};

enum class Kind : unsigned char { leaf, wood };

struct Verdict {
  std::vector<Kind> kinds;  // of each part
  std::string how;          // one line for the user
};

// Tells leaf from wood. `remark` is added to the message when that fails. Throws InvalidInput("<source>: ...").
Verdict tellApart(const std::vector<Part>& parts, const ImportRules& rules, const std::string& source,
                  const std::string& remark);

// Throws InvalidInput unless the rules can be applied: patterns not empty, scale finite and > 0.
void validate(const ImportRules& rules);

}  // namespace sunfleck::detail
