#include "plants/detail/gltf_faces.hpp"

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/gltf_numbers.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::uint32_t kNoTexture = NamedTriangles::kNoTexture;

// Exactly so many where they are the first: most files have one large primitive, some many small ones.
template <typename T>
void reserveMore(std::vector<T>& values, std::size_t more) {
  const std::size_t needed = values.size() + more;
  if (needed > values.capacity()) values.reserve(std::max(needed, values.empty() ? needed : 2 * values.capacity()));
}

}  // namespace

GltfFaces::GltfFaces(const tinygltf::Model& model, const std::vector<GltfMaterial>& materials, std::size_t most,
                     const std::string& source)
    : model_(model), materials_(materials), most_(most), source_(source) {}

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
  require(primitive.material >= -1 && primitive.material < static_cast<int>(materials_.size()), source_ + ": material",
          primitive.material, "one of the file's");
  for (const auto& [name, value] : primitive.extensions)
    require(!name.ends_with("_compression"), source_ + ": extension", shown(name), "none that compresses");
  const auto [found, is_new] = known.try_emplace(position->second);
  if (is_new) found->second = addVertices(position->second, placed.to_world);
  Corners of = found->second;
  of.first_texture = textureOf(primitive, of.count);
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
  // A transform that mirrors turns the corners about the other way (glTF 2.0, 3.7.4).
  const bool mirrored = glm::determinant(glm::dmat3(placed.to_world)) < 0.;
  addTriangles(corners, mode, mirrored, of, partOf(primitive, placed));
}

GltfFaces::Corners GltfFaces::addVertices(int positions, const glm::dmat4& to_world) {
  const Numbers numbers(model_, positions, source_ + ": POSITION");
  numbers.requireFloats(TINYGLTF_TYPE_VEC3, "three floats");
  require(numbers.size() <= most_ - std::min(most_, faces.vertices.size()), source_ + ": number of vertices",
          faces.vertices.size() + numbers.size(), "at most " + std::to_string(most_) + " for a file of its size");
  const Corners added{.first = static_cast<std::uint32_t>(faces.vertices.size()), .count = numbers.size()};
  reserveMore(faces.vertices, numbers.size());
  const bool plain = to_world == glm::dmat4(1.);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const glm::vec3 v(numbers.real(i, 0), numbers.real(i, 1), numbers.real(i, 2));
    faces.vertices.push_back(plain ? v : glm::vec3(glm::dvec3(to_world * glm::dvec4(v, 1.))));
  }
  return added;
}

// The first of its vertices' places in their image; kNoTexture without any.
std::uint32_t GltfFaces::textureOf(const tinygltf::Primitive& primitive, std::size_t vertices) {
  static const GltfMaterial none;
  const GltfMaterial& material =
      primitive.material >= 0 ? materials_[static_cast<std::size_t>(primitive.material)] : none;
  const auto at = primitive.attributes.find("TEXCOORD_" + std::to_string(material.texture_coordinates));
  if (at == primitive.attributes.end()) return kNoTexture;
  const Numbers coordinates(model_, at->second, source_ + ": TEXCOORD");
  coordinates.requireType(TINYGLTF_TYPE_VEC2, "of two numbers");
  require(coordinates.size() == vertices, source_ + ": number of texture coordinates", coordinates.size(),
          "that of the vertices, " + std::to_string(vertices));
  const bool moved = material.to_image != glm::dmat3(1.);
  const auto [found, is_new] = first_texture_of_.try_emplace({at->second, moved ? primitive.material : -1},
                                                             static_cast<std::uint32_t>(faces.texture.size()));
  if (!is_new) return found->second;
  require(vertices <= most_ - std::min(most_, faces.texture.size()), source_ + ": number of texture coordinates",
          faces.texture.size() + vertices, "at most " + std::to_string(most_) + " for a file of its size");
  reserveMore(faces.texture, vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    glm::dvec3 in_image(coordinates.share(i, 0), coordinates.share(i, 1), 1.);
    if (moved) in_image = material.to_image * in_image;
    faces.texture.emplace_back(in_image.x, 1. - in_image.y);
  }
  return found->second;
}

void GltfFaces::addTriangles(const std::vector<std::uint32_t>& corners, int mode, bool mirrored, const Corners& of,
                             std::uint32_t part) {
  if (mode == TINYGLTF_MODE_TRIANGLES)
    require(corners.size() % 3 == 0, source_ + ": number of triangles' corners", corners.size(), "a multiple of 3");
  const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
  const std::size_t count = corners.size() < 3 ? 0 : (corners.size() - 3) / step + 1;
  require(count <= most_ - std::min(most_, faces.triangles.size()), source_ + ": number of triangles",
          faces.triangles.size() + count, "at most " + std::to_string(most_) + " for a file of its size");
  const bool textured = of.first_texture != kNoTexture || !faces.texture_corners.empty();
  reserveMore(faces.triangles, count);
  reserveMore(faces.part_of_triangle, count);
  if (textured) {  // those before have none
    reserveMore(faces.texture_corners, faces.triangles.size() - faces.texture_corners.size() + count);
    faces.texture_corners.resize(faces.triangles.size(), glm::uvec3(kNoTexture));
  }
  const auto add = [&](glm::uvec3 t) {
    if (mirrored) std::swap(t.y, t.z);
    faces.triangles.push_back(of.first + t);
    faces.part_of_triangle.push_back(part);
    if (textured)
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
  const int index = primitive.material;
  const auto [known, is_new] =
      part_of_.try_emplace({index, placed.mesh, placed.node}, static_cast<std::uint32_t>(faces.parts.size()));
  if (is_new) {
    Part part{.material = {},
              .object = model_.nodes[static_cast<std::size_t>(placed.node)].name,
              .groups = model_.meshes[static_cast<std::size_t>(placed.mesh)].name,
              .one_group = true,
              .colour = {}};
    if (index >= 0) {
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
