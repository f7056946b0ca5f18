#include <array>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/nil_generator.hpp>
#include <boost/uuid/string_generator.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <vector>

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
  if (!mesh.masks.empty()) {
    add(mesh.patches);
    add(mesh.patch_of_triangle);
    for (const auto& mask : mesh.masks) {
      add(std::array{mask->width, mask->height});
      add(mask->opaque);
    }
  }
  return to_string(hash);
}

std::string standHash(std::span<const TreeMesh* const> kinds, const Stand& stand, std::span<const BandOptics> optics) {
  boost::uuids::uuid hash = boost::uuids::string_generator()(meshHash(*kinds[0]));
  for (const TreeMesh* mesh : kinds.subspan(1)) hash = boost::uuids::name_generator_sha1(hash)(meshHash(*mesh));
  std::vector<float> numbers;
  for (const Placement& tree : stand.trees)
    numbers.insert(numbers.end(), {tree.position.x, tree.position.y, tree.position.z, tree.rotation});
  if (stand.period) numbers.insert(numbers.end(), {stand.period->x, stand.period->y});
  if (kinds.size() > 1)
    for (const Placement& tree : stand.trees) numbers.push_back(static_cast<float>(tree.kind));
  for (const BandOptics& of_kind : optics)
    for (const LeafOptics& band : of_kind) numbers.insert(numbers.end(), {band.reflectance, band.transmittance});
  return to_string(boost::uuids::name_generator_sha1(hash)(numbers.data(), numbers.size() * sizeof(float)));
}

}  // namespace sunfleck
