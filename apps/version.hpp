#pragma once

#include <string>

namespace sunfleck {

std::string version();      // "0.1.0"
std::string commit();       // what was built, "-dirty" when files had changed
std::string versionText();  // both, for people

}  // namespace sunfleck
