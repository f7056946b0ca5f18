#include "plants/detail/gltf_scene.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "core/require.hpp"
#include "plants/detail/gltf_numbers.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kMostPlacements = 2'000'000;

void checkExtensions(const tinygltf::Model& model, const std::string& source) {
  for (const std::string& name : model.extensionsRequired) {
    const bool known = name == "EXT_mesh_gpu_instancing" || name == "KHR_texture_transform" ||
                       name.starts_with("KHR_materials_") || name.starts_with("KHR_lights");
    require(known, source + ": required extension", shown(name), "one that is read: EXT_mesh_gpu_instancing alone");
  }
}

glm::dmat4 placed(const glm::dvec3& move, const glm::dquat& turn, const glm::dvec3& scale) {
  glm::dmat4 matrix = glm::mat4_cast(turn);
  for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
  matrix[3] = glm::dvec4(move, 1.);
  return matrix;
}

glm::dquat unitTurn(const glm::dquat& turn, const std::string& source) {
  const double length = glm::length(turn);
  require(std::abs(length - 1.) <= 0.01, source + ": length of a rotation", length, "1");
  return turn / length;
}

glm::dmat4 matrixOf(const tinygltf::Node& node, const std::string& source) {
  const auto requireCount = [&](const std::vector<double>& numbers, std::size_t count, const char* name) {
    require(numbers.empty() || numbers.size() == count, source + ": numbers of a node's " + name, numbers.size(),
            std::to_string(count));
  };
  requireCount(node.matrix, 16, "matrix");
  requireCount(node.translation, 3, "translation");
  requireCount(node.rotation, 4, "rotation");
  requireCount(node.scale, 3, "scale");
  if (!node.matrix.empty()) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  const auto three = [](const std::vector<double>& v, double fallback) {
    return v.empty() ? glm::dvec3(fallback) : glm::dvec3(v[0], v[1], v[2]);
  };
  const std::vector<double>& r = node.rotation;
  const glm::dquat turn = r.empty() ? glm::dquat(1., 0., 0., 0.) : unitTurn(glm::dquat(r[3], r[0], r[1], r[2]), source);
  return placed(three(node.translation, 0.), turn, three(node.scale, 1.));
}

// Where a node's mesh stands, in its own coordinates: once, or as often as EXT_mesh_gpu_instancing says.
std::vector<glm::dmat4> instancesOf(const tinygltf::Model& model, const tinygltf::Node& node,
                                    const std::string& source) {
  const auto found = node.extensions.find("EXT_mesh_gpu_instancing");
  if (found == node.extensions.end()) return {glm::dmat4(1.)};
  const tinygltf::Value& attributes = found->second.Get("attributes");
  std::optional<Numbers> move, turn, scale;
  const auto take = [&](const char* name, std::optional<Numbers>& numbers, int type, const char* rule) {
    if (!attributes.IsObject() || !attributes.Has(name)) return;
    numbers.emplace(model, attributes.Get(name).GetNumberAsInt(), source + ": instances' " + name);
    numbers->requireFloats(type, rule);
  };
  take("TRANSLATION", move, TINYGLTF_TYPE_VEC3, "three floats");
  take("ROTATION", turn, TINYGLTF_TYPE_VEC4, "four floats");
  take("SCALE", scale, TINYGLTF_TYPE_VEC3, "three floats");
  std::optional<std::size_t> count;
  for (const auto* numbers : {&move, &turn, &scale})
    if (*numbers) {
      require(!count || *count == (*numbers)->size(), source + ": number of instances", (*numbers)->size(),
              "the same in all attributes");
      count = (*numbers)->size();
    }
  require(count.value_or(0) <= kMostPlacements, source + ": number of instances", count.value_or(0), "at most 2000000");
  std::vector<glm::dmat4> places;
  places.reserve(count.value_or(0));
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    const auto three = [&](const std::optional<Numbers>& n, double fallback) {
      return n ? glm::dvec3(n->real(i, 0), n->real(i, 1), n->real(i, 2)) : glm::dvec3(fallback);
    };
    const glm::dquat rotation =
        turn ? unitTurn({turn->real(i, 3), turn->real(i, 0), turn->real(i, 1), turn->real(i, 2)}, source)
             : glm::dquat(1., 0., 0., 0.);
    places.push_back(placed(three(move, 0.), rotation, three(scale, 1.)));
  }
  return places;
}

}  // namespace

std::vector<PlacedMesh> placedMeshes(const tinygltf::Model& model, const std::string& source) {
  checkExtensions(model, source);
  const int scene = model.defaultScene >= 0 ? model.defaultScene : 0;
  if (model.scenes.empty()) throw InvalidInput(source + ": has no scene, so no leaves");
  require(static_cast<std::size_t>(scene) < model.scenes.size(), source + ": scene", scene, "one of the file's");
  struct Visit {
    int node;
    glm::dmat4 to_world;
  };
  std::vector<Visit> waiting;
  std::vector<char> seen(model.nodes.size(), 0);
  const auto wait = [&](const std::vector<int>& nodes, const glm::dmat4& to_world) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) waiting.push_back({*node, to_world});
  };
  std::vector<PlacedMesh> meshes;
  wait(model.scenes[static_cast<std::size_t>(scene)].nodes, glm::dmat4(1.));
  while (!waiting.empty()) {
    const Visit visit = waiting.back();
    waiting.pop_back();
    require(visit.node >= 0 && static_cast<std::size_t>(visit.node) < model.nodes.size(), source + ": node", visit.node,
            "one of the file's");
    const auto index = static_cast<std::size_t>(visit.node);
    require(!seen[index], source + ": node", visit.node, "below one other node alone");
    seen[index] = 1;
    const tinygltf::Node& node = model.nodes[index];
    const glm::dmat4 to_world = visit.to_world * matrixOf(node, source);
    if (node.mesh >= 0) {
      require(static_cast<std::size_t>(node.mesh) < model.meshes.size(), source + ": mesh", node.mesh,
              "one of the file's");
      const std::vector<glm::dmat4> places = instancesOf(model, node, source);
      require(meshes.size() + places.size() <= kMostPlacements, source + ": number of instances",
              meshes.size() + places.size(), "at most 2000000");
      for (const glm::dmat4& place : places) meshes.push_back({node.mesh, visit.node, to_world * place});
    }
    wait(node.children, to_world);
  }
  return meshes;
}

}  // namespace sunfleck::detail
