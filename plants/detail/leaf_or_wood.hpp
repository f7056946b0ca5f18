#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plants/import.hpp"

namespace sunfleck::detail {

// Faces of a file that bear the same names.
struct Part {
  std::string material, object;
  std::vector<std::string> groups;
  std::optional<glm::vec3> colour;  // diffuse colour of the material [1], when the file's materials are known
};

enum class Kind { leaf, wood };

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
