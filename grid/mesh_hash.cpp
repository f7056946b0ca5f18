#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/nil_generator.hpp>
#include <boost/uuid/uuid_io.hpp>

#include "grid/density_grid.hpp"

namespace sunfleck {

std::string meshHash(const TreeMesh& mesh) {
  boost::uuids::uuid hash = boost::uuids::nil_uuid();
  const auto add = [&](const auto& values) {
    hash = boost::uuids::name_generator_sha1(hash)(values.data(), values.size() * sizeof(values[0]));
  };
  add(mesh.vertices);
  add(mesh.leaf_triangles);
  add(mesh.wood_triangles);
  return to_string(hash);
}

}  // namespace sunfleck
