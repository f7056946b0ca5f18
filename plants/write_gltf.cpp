#include "plants/write_gltf.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "plants/detail/display_colours.hpp"
#include "plants/detail/textured_vertices.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 31;  // a .glb counts in 32 bits

tinygltf::Value list(const glm::vec3& v) {
  tinygltf::Value::Array numbers;
  for (int i = 0; i < 3; ++i) numbers.emplace_back(double{v[i]});
  return tinygltf::Value(numbers);
}

class GltfWriter {
 public:
  GltfWriter() {
    model_.asset.version = "2.0";
    model_.asset.generator = "sunfleck";
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
    addMaterials();
  }

  tinygltf::Model model(std::span<const TreeMesh* const> kinds, const Stand& stand) {
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      std::vector<Placement> trees;
      for (const Placement& tree : stand.trees)
        if (tree.kind == kind) trees.push_back(tree);
      if (!trees.empty()) addTrees(*kinds[kind], trees);
    }
    require(model_.buffers[0].data.size() <= kMostBytes, "glTF: size [byte]", model_.buffers[0].data.size(),
            "at most 2147483648");
    return std::move(model_);
  }

 private:
  // A leaf reflects (1 - t) base and passes t colour: t is chosen so that neither exceeds 1.
  void addMaterials() {
    using namespace detail;
    const auto mean = [](const glm::vec3& v) { return double{v.x + v.y + v.z} / 3.; };
    const double share = mean(kLeafTransmittance) / (mean(kLeafReflectance) + mean(kLeafTransmittance));
    tinygltf::Material leaf = material("leaf", kLeafReflectance / static_cast<float>(1. - share));
    leaf.doubleSided = true;
    tinygltf::Value::Object transmission;
    transmission["diffuseTransmissionFactor"] = tinygltf::Value(share);
    transmission["diffuseTransmissionColorFactor"] = list(kLeafTransmittance / static_cast<float>(share));
    leaf.extensions["KHR_materials_diffuse_transmission"] = tinygltf::Value(transmission);
    model_.extensionsUsed.emplace_back("KHR_materials_diffuse_transmission");
    model_.materials = {leaf, material("wood", kWoodReflectance)};
  }

  static tinygltf::Material material(const std::string& name, const glm::vec3& colour) {
    tinygltf::Material made;
    made.name = name;
    made.pbrMetallicRoughness.baseColorFactor = {double{colour.r}, double{colour.g}, double{colour.b}, 1.};
    made.pbrMetallicRoughness.metallicFactor = 0.;
    made.pbrMetallicRoughness.roughnessFactor = 1.;
    return made;
  }

  void addTrees(const TreeMesh& mesh, const std::vector<Placement>& trees) {
    tinygltf::Node node;
    node.name = "tree";
    node.mesh = addMesh(mesh);
    std::vector<float> places, turns;
    for (const Placement& tree : trees) {
      places.insert(places.end(), {tree.position.x, tree.position.z, -tree.position.y});
      turns.insert(turns.end(), {0.f, std::sin(0.5f * tree.rotation), 0.f, std::cos(0.5f * tree.rotation)});
    }
    const bool moved = trees.size() > 1 || trees[0].position != glm::vec3(0.f) || trees[0].rotation != 0.f;
    if (trees.size() > 1) {
      tinygltf::Value::Object attributes, instancing;
      attributes["TRANSLATION"] = tinygltf::Value(addAccessor(places, TINYGLTF_TYPE_VEC3, 3));
      attributes["ROTATION"] = tinygltf::Value(addAccessor(turns, TINYGLTF_TYPE_VEC4, 4));
      instancing["attributes"] = tinygltf::Value(attributes);
      node.extensions["EXT_mesh_gpu_instancing"] = tinygltf::Value(instancing);
      useExtension("EXT_mesh_gpu_instancing");
    } else if (moved) {
      node.translation.assign(places.begin(), places.end());
      node.rotation.assign(turns.begin(), turns.end());
    }
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(node);
  }

  void useExtension(const std::string& name) {
    for (auto* list : {&model_.extensionsUsed, &model_.extensionsRequired})
      if (std::find(list->begin(), list->end(), name) == list->end()) list->push_back(name);
  }

  int addMesh(const TreeMesh& mesh) {
    const detail::TexturedVertices corners = detail::texturedVertices(mesh);
    std::vector<float> positions;
    positions.reserve(3 * corners.vertices.size());
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& v : corners.vertices) {
      const glm::vec3 y_up(v.x, v.z, -v.y);
      positions.insert(positions.end(), {y_up.x, y_up.y, y_up.z});
      low = glm::min(low, y_up);
      high = glm::max(high, y_up);
    }
    const int accessor = addAccessor(positions, TINYGLTF_TYPE_VEC3, 3, TINYGLTF_TARGET_ARRAY_BUFFER);
    for (int axis = 0; axis < 3; ++axis) {
      model_.accessors.back().minValues.push_back(double{low[axis]});
      model_.accessors.back().maxValues.push_back(double{high[axis]});
    }
    int texture = -1;
    if (!corners.texture.empty()) {
      std::vector<float> places;
      places.reserve(2 * corners.texture.size());
      for (const glm::vec2& at : corners.texture) places.insert(places.end(), {at.x, 1.f - at.y});  // v down
      texture = addAccessor(places, TINYGLTF_TYPE_VEC2, 2, TINYGLTF_TARGET_ARRAY_BUFFER);
    }
    tinygltf::Mesh made;
    made.name = "tree";
    const auto addPart = [&](const std::vector<glm::uvec3>& triangles, int material) {
      if (triangles.empty()) return;
      tinygltf::Primitive part;
      part.attributes["POSITION"] = accessor;
      if (material == 0 && texture >= 0) part.attributes["TEXCOORD_0"] = texture;
      part.material = material;
      part.mode = TINYGLTF_MODE_TRIANGLES;
      part.indices =
          addBytes(triangles.data(), triangles.size() * sizeof(glm::uvec3), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
                   3 * triangles.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
      made.primitives.push_back(part);
    };
    addPart(corners.leaf_triangles, 0);
    addPart(mesh.wood_triangles, 1);
    model_.meshes.push_back(made);
    return static_cast<int>(model_.meshes.size()) - 1;
  }

  int addAccessor(const std::vector<float>& numbers, int type, std::size_t each, int target = 0) {
    return addBytes(numbers.data(), numbers.size() * sizeof(float), target, numbers.size() / each,
                    TINYGLTF_COMPONENT_TYPE_FLOAT, type);
  }

  // glTF is little-endian, as are all processors that this is built for.
  int addBytes(const void* bytes, std::size_t size, int target, std::size_t count, int component, int type) {
    static_assert(std::endian::native == std::endian::little && sizeof(glm::uvec3) == 12);
    std::vector<unsigned char>& data = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = size;
    view.target = target;
    data.resize(data.size() + size);
    std::memcpy(data.data() + view.byteOffset, bytes, size);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.count = count;
    accessor.componentType = component;
    accessor.type = type;
    model_.bufferViews.push_back(view);
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  tinygltf::Model model_;
};

}  // namespace

void writeGltf(const std::filesystem::path& path, std::span<const TreeMesh* const> kinds, const Stand& stand) {
  const bool binary = path.extension() == ".glb";
  require(binary || path.extension() == ".gltf", "output file", path.string(),
          "named with the extension .glb or .gltf");
  if (stand.period) throw InvalidInput(path.string() + ": a stand without end cannot be written as glTF");
  requireWritable(path);
  const tinygltf::Model model = GltfWriter().model(kinds, stand);
  writeWhole(path, [&](const std::filesystem::path& file) {
    if (!tinygltf::TinyGLTF().WriteGltfSceneToFile(&model, file.string(), false, true, false, binary))
      throw InvalidInput(path.string() + ": cannot be written");
  });
}

void writeGltf(const std::filesystem::path& path, const TreeMesh& mesh) {
  const TreeMesh* const kind = &mesh;
  writeGltf(path, {&kind, 1}, Stand{});
}

}  // namespace sunfleck
