#include "apps/version.hpp"

#include "commit.hpp"  // generated at every build

namespace sunfleck {

std::string version() {
  return SUNFLECK_VERSION;
}
std::string commit() {
  return SUNFLECK_COMMIT;
}
std::string versionText() {
  return "Sunfleck " + version() + ", commit " + commit();
}

}  // namespace sunfleck
