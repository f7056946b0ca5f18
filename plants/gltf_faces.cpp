#include "plants/detail/gltf_faces.hpp"

#include <algorithm>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/gltf_numbers.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::uint32_t kNoTexture = NamedTriangles::kNoTexture;

bool hasMask(const GltfMaterial& material) {
  return material.opacity && !material.opacity->image.empty();
}

}  // namespace

GltfFaces::GltfFaces(const tinygltf::Model& model, const std::vector<GltfMaterial>& materials, std::size_t most,
                     const std::string& source)
    : model_(model),
      materials_(materials),
      most_(most),
      source_(source),
      any_masks_(std::ranges::any_of(materials, hasMask)) {}

void GltfFaces::add(const PlacedMesh& placed) {
  KnownCorners known;
  for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(placed.mesh)].primitives)
    addPrimitive(primitive, placed, known);
}

void GltfFaces::addPrimitive(const tinygltf::Primitive& primitive, const PlacedMesh& placed, KnownCorners& known) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  const auto position = primitive.attributes.find("POSITION");
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN || position == primitive.attributes.end()) {
    ++skipped;
    return;
  }
  for (const auto& [name, value] : primitive.extensions)
    require(!name.ends_with("_compression"), source_ + ": extension", shown(name), "none that compresses");
  const bool has_material = primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < materials_.size();
  const GltfMaterial* const material =
      has_material ? &materials_[static_cast<std::size_t>(primitive.material)] : nullptr;
  int texture = -1;
  if (material && hasMask(*material))
    if (const auto at = primitive.attributes.find("TEXCOORD_" + std::to_string(material->texture_coordinates));
        at != primitive.attributes.end())
      texture = at->second;
  const auto [found, is_new] = known.try_emplace({position->second, texture, texture < 0 ? -1 : primitive.material});
  if (is_new) found->second = addVertices(position->second, texture, material, placed.to_world);
  const Corners of = found->second;
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    const Numbers indices(model_, primitive.indices, source_ + ": indices");
    corners.reserve(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const std::uint32_t index = indices.index(i);
      if (index >= of.count)
        require(false, source_ + ": vertex index", index, "below the number of vertices, " + std::to_string(of.count));
      corners.push_back(index);
    }
  } else {
    for (std::size_t i = 0; i < of.count; ++i) corners.push_back(static_cast<std::uint32_t>(i));
  }
  addTriangles(corners, mode, of, partOf(primitive, placed));
}

GltfFaces::Corners GltfFaces::addVertices(int positions, int texture, const GltfMaterial* material,
                                          const glm::dmat4& to_world) {
  const Numbers numbers(model_, positions, source_ + ": POSITION");
  numbers.requireFloats(TINYGLTF_TYPE_VEC3, "three floats");
  require(numbers.size() <= most_ - std::min(most_, faces.vertices.size()), source_ + ": number of vertices",
          faces.vertices.size() + numbers.size(), "at most " + std::to_string(most_) + " for a file of its size");
  Corners added{
      .first = static_cast<std::uint32_t>(faces.vertices.size()), .first_texture = kNoTexture, .count = numbers.size()};
  faces.vertices.reserve(std::max(faces.vertices.capacity(), faces.vertices.size() + numbers.size()));
  const bool plain = to_world == glm::dmat4(1.);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const glm::vec3 v(numbers.real(i, 0), numbers.real(i, 1), numbers.real(i, 2));
    faces.vertices.push_back(plain ? v : glm::vec3(glm::dvec3(to_world * glm::dvec4(v, 1.))));
  }
  if (texture < 0) return added;
  const Numbers coordinates(model_, texture, source_ + ": TEXCOORD");
  coordinates.requireType(TINYGLTF_TYPE_VEC2, "of two numbers");
  require(coordinates.size() == added.count, source_ + ": number of texture coordinates", coordinates.size(),
          "that of the vertices, " + std::to_string(added.count));
  added.first_texture = static_cast<std::uint32_t>(faces.texture.size());
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const glm::dvec3 at(coordinates.share(i, 0), coordinates.share(i, 1), 1.);
    const glm::dvec3 in_image = material->to_image * at;
    faces.texture.emplace_back(in_image.x, 1. - in_image.y);
  }
  return added;
}

void GltfFaces::addTriangles(const std::vector<std::uint32_t>& corners, int mode, const Corners& of,
                             std::uint32_t part) {
  if (mode == TINYGLTF_MODE_TRIANGLES)
    require(corners.size() % 3 == 0, source_ + ": number of triangles' corners", corners.size(), "a multiple of 3");
  const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
  const std::size_t count = corners.size() < 3 ? 0 : (corners.size() - 3) / step + 1;
  require(count <= most_ - std::min(most_, faces.triangles.size()), source_ + ": number of triangles",
          faces.triangles.size() + count, "at most " + std::to_string(most_) + " for a file of its size");
  const auto add = [&](const glm::uvec3& t) {
    faces.triangles.push_back(of.first + t);
    faces.part_of_triangle.push_back(part);
    if (any_masks_)
      faces.texture_corners.push_back(of.first_texture == kNoTexture ? glm::uvec3(kNoTexture) : of.first_texture + t);
  };
  for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      add({corners[0], corners[i + 1], corners[i + 2]});
    else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1)
      add({corners[i + 1], corners[i], corners[i + 2]});
    else
      add({corners[i], corners[i + 1], corners[i + 2]});
  }
}

std::uint32_t GltfFaces::partOf(const tinygltf::Primitive& primitive, const PlacedMesh& placed) {
  const bool has_material = primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < materials_.size();
  const int index = has_material ? primitive.material : -1;
  const auto [known, is_new] =
      part_of_.try_emplace({index, placed.mesh, placed.node}, static_cast<std::uint32_t>(faces.parts.size()));
  if (is_new) {
    Part part{.material = {},
              .object = model_.nodes[static_cast<std::size_t>(placed.node)].name,
              .groups = model_.meshes[static_cast<std::size_t>(placed.mesh)].name,
              .one_group = true,
              .colour = {}};
    if (has_material) {
      const GltfMaterial& material = materials_[static_cast<std::size_t>(index)];
      part.material = material.name;
      part.colour = material.colour;
      if (material.opacity) part.opacity = &*material.opacity;
    }
    faces.parts.push_back(part);
    material_of_part.push_back(index);
  }
  return known->second;
}

}  // namespace sunfleck::detail
