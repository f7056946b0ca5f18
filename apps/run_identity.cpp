#include "apps/run_identity.hpp"

#include "apps/version.hpp"
#include "grid/density_grid.hpp"

namespace sunfleck::apps {

TraceIdentity runIdentity(const Scene& scene, bool with_wood) {
  return {{"program", versionText()},
          {"hash of trees and places", standHash(meshes(scene), scene.stand)},
          {"wood", with_wood ? "with" : "without"}};
}

}  // namespace sunfleck::apps
