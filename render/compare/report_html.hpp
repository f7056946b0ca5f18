#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/compare/validation.hpp"

namespace sunfleck {

struct ReportPicture {
  std::string caption;
  std::string png;  // the file's bytes
};

struct ReportOrigin {
  std::string command, version, commit;  // what made the report
};

// A page that needs no other file: errors by model as table and plot, irradiance against depth, the pictures, and what
// made it.
std::string reportHtml(std::span<const Validation> validations, std::span<const ReportPicture> pictures,
                       const ReportOrigin& origin);

}  // namespace sunfleck
