#pragma once

#include <span>
#include <string>

#include "render/compare/validation.hpp"

namespace sunfleck {

// report.json as scripts rely on it: `sunfleck`, `commit`, and of the first validation `scene`, `reference` and
// `models`. When there is a second, of the same tree repeated periodically, the same three stand under `periodic`.
std::string reportJson(std::span<const Validation> validations, const std::string& version, const std::string& commit);

}  // namespace sunfleck
