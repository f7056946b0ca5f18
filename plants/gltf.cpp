#include "plants/detail/gltf.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <map>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/leaf_or_wood.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kMostVertices = 100'000'000;
constexpr std::size_t kMostTriangles = 200'000'000;

// Values within values are read by recursion.
void checkNesting(std::string_view text, const std::string& source) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      require(++depth <= kDeepest, source + ": depth of its JSON", depth, "at most 64");
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

// The JSON of a .glb: its first chunk.
std::string_view jsonOf(const std::string& bytes, const std::string& source) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  constexpr std::uint32_t kJson = 0x4E4F534A;
  if (bytes.size() < 20 || word(4) != 2 || word(8) > bytes.size() || word(16) != kJson || word(12) > bytes.size() - 20)
    throw InvalidInput(source + ": is broken: its header is not that of a whole .glb of version 2");
  return std::string_view(bytes).substr(20, word(12));
}

tinygltf::Model parse(const std::filesystem::path& path, const std::string& bytes, const std::string& source) {
  const bool binary = bytes.starts_with("glTF");
  checkNesting(binary ? jsonOf(bytes, source) : std::string_view(bytes), source);
  require(bytes.size() < (std::size_t{1} << 31), source + ": size [byte]", bytes.size(), "below 2147483648");
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  loader.SetFsCallbacks({.FileExists = [](const std::string& file, void*) { return std::filesystem::exists(file); },
                         .ExpandFilePath = [](const std::string& file, void*) { return file; },
                         .ReadWholeFile =
                             [](std::vector<unsigned char>* out, std::string*, const std::string& file, void*) {
                               const std::string content = readWhole(file);
                               out->assign(content.begin(), content.end());
                               return true;
                             },
                         .WriteWholeFile = nullptr,
                         .user_data = nullptr});
  tinygltf::Model model;
  std::string error, warning;
  const std::string folder = path.parent_path().string();
  const auto size = static_cast<unsigned>(bytes.size());
  const bool done =
      binary ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                           reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
             : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  if (!done) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw InvalidInput(source + ": cannot be read as glTF: " + shown(error));
  }
  return model;
}

// The numbers of an accessor, of one type.
class Numbers {
 public:
  Numbers(const tinygltf::Model& model, int index, const std::string& what) : what_(what) {
    require(index >= 0 && static_cast<std::size_t>(index) < model.accessors.size(), what + ": accessor", index,
            "one of the file's");
    accessor_ = &model.accessors[static_cast<std::size_t>(index)];
    if (accessor_->sparse.isSparse) throw InvalidInput(what + ": is a sparse accessor, which is not read");
    const int view_index = accessor_->bufferView;
    require(view_index >= 0 && static_cast<std::size_t>(view_index) < model.bufferViews.size(), what + ": bufferView",
            view_index, "one of the file's");
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
    require(view.buffer >= 0 && static_cast<std::size_t>(view.buffer) < model.buffers.size(), what + ": buffer",
            view.buffer, "one of the file's");
    const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor_->componentType));
    const int each = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
    require(component > 0 && each > 0, what + ": type", accessor_->type, "one of glTF's");
    const std::size_t element = static_cast<std::size_t>(component) * static_cast<std::size_t>(each);
    stride_ = view.byteStride != 0 ? view.byteStride : element;
    const std::size_t count = accessor_->count;
    const bool fits = view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset &&
                      accessor_->byteOffset <= view.byteLength && stride_ >= element && stride_ <= 252 &&
                      (count == 0 || (element <= view.byteLength - accessor_->byteOffset &&
                                      (count - 1) <= (view.byteLength - accessor_->byteOffset - element) / stride_));
    require(fits, what + ": number of elements", count, "no more than its buffer holds");
    data_ = data.data() + view.byteOffset + accessor_->byteOffset;
  }

  std::size_t size() const { return accessor_->count; }

  void requireFloats(int type, const char* rule) const {
    require(accessor_->componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && accessor_->type == type, what_ + ": type",
            accessor_->componentType, rule);
  }

  float real(std::size_t element, std::size_t component) const {
    float value = 0.f;
    std::memcpy(&value, data_ + element * stride_ + component * sizeof value, sizeof value);
    return value;
  }

  std::uint32_t index(std::size_t element) const {
    const unsigned char* at = data_ + element * stride_;
    std::uint32_t wide = 0;
    std::uint16_t narrow = 0;
    switch (accessor_->componentType) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return *at;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        std::memcpy(&narrow, at, sizeof narrow);
        return narrow;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        std::memcpy(&wide, at, sizeof wide);
        return wide;
      default:
        require(false, what_ + ": type", accessor_->componentType, "of whole numbers, not negative");
        return 0;
    }
  }

 private:
  std::string what_;
  const tinygltf::Accessor* accessor_;
  const unsigned char* data_;
  std::size_t stride_;
};

class GltfGatherer {
 public:
  GltfGatherer(const tinygltf::Model& model, const std::string& source) : model_(model), source_(source) {}

  std::vector<glm::vec3> vertices;
  std::vector<Part> parts;
  std::vector<std::vector<glm::uvec3>> triangles;  // of each part
  std::vector<int> material_of;                    // of each part, -1 for none
  std::size_t skipped = 0;                         // primitives of points and lines

  void read() {
    checkExtensions();
    seen_.assign(model_.nodes.size(), 0);
    const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
    if (model_.scenes.empty()) throw InvalidInput(source_ + ": has no scene, so no leaves");
    require(static_cast<std::size_t>(scene) < model_.scenes.size(), source_ + ": scene", scene, "one of the file's");
    struct Visit {
      int node;
      glm::dmat4 to_world;
    };
    std::vector<Visit> waiting;
    const auto wait = [&](const std::vector<int>& nodes, const glm::dmat4& to_world) {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) waiting.push_back({*node, to_world});
    };
    wait(model_.scenes[static_cast<std::size_t>(scene)].nodes, glm::dmat4(1.));
    while (!waiting.empty()) {
      const Visit visit = waiting.back();
      waiting.pop_back();
      require(visit.node >= 0 && static_cast<std::size_t>(visit.node) < model_.nodes.size(), source_ + ": node",
              visit.node, "one of the file's");
      const auto index = static_cast<std::size_t>(visit.node);
      require(!seen_[index], source_ + ": node", visit.node, "below one other node alone");
      seen_[index] = 1;
      const tinygltf::Node& node = model_.nodes[index];
      const glm::dmat4 to_world = visit.to_world * matrixOf(node);
      if (node.mesh >= 0) readNode(node, to_world);
      wait(node.children, to_world);
    }
  }

 private:
  void checkExtensions() const {
    for (const std::string& name : model_.extensionsRequired) {
      const bool known = name == "EXT_mesh_gpu_instancing" || name == "KHR_texture_transform" ||
                         name.starts_with("KHR_materials_") || name.starts_with("KHR_lights");
      require(known, source_ + ": required extension", shown(name), "one that is read: EXT_mesh_gpu_instancing alone");
    }
  }

  static glm::dmat4 placed(const glm::dvec3& move, const glm::dquat& turn, const glm::dvec3& scale) {
    glm::dmat4 matrix = glm::mat4_cast(turn);
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
    matrix[3] = glm::dvec4(move, 1.);
    return matrix;
  }

  static glm::dmat4 matrixOf(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
      glm::dmat4 matrix;
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
      return matrix;
    }
    const auto three = [](const std::vector<double>& v, double fallback) {
      return v.size() == 3 ? glm::dvec3(v[0], v[1], v[2]) : glm::dvec3(fallback);
    };
    const std::vector<double>& r = node.rotation;
    const glm::dquat turn = r.size() == 4 ? glm::dquat(r[3], r[0], r[1], r[2]) : glm::dquat(1., 0., 0., 0.);
    return placed(three(node.translation, 0.), turn, three(node.scale, 1.));
  }

  // Where a node's mesh stands, in its own coordinates: once, or as often as EXT_mesh_gpu_instancing says.
  std::vector<glm::dmat4> instancesOf(const tinygltf::Node& node) const {
    const auto found = node.extensions.find("EXT_mesh_gpu_instancing");
    if (found == node.extensions.end()) return {glm::dmat4(1.)};
    const tinygltf::Value& attributes = found->second.Get("attributes");
    std::optional<Numbers> move, turn, scale;
    const auto take = [&](const char* name, std::optional<Numbers>& numbers, int type, const char* rule) {
      if (!attributes.IsObject() || !attributes.Has(name)) return;
      numbers.emplace(model_, attributes.Get(name).GetNumberAsInt(), source_ + ": instances' " + name);
      numbers->requireFloats(type, rule);
    };
    take("TRANSLATION", move, TINYGLTF_TYPE_VEC3, "three floats");
    take("ROTATION", turn, TINYGLTF_TYPE_VEC4, "four floats");
    take("SCALE", scale, TINYGLTF_TYPE_VEC3, "three floats");
    std::optional<std::size_t> count;
    for (const auto* numbers : {&move, &turn, &scale})
      if (*numbers) {
        require(!count || *count == (*numbers)->size(), source_ + ": number of instances", (*numbers)->size(),
                "the same in all attributes");
        count = (*numbers)->size();
      }
    std::vector<glm::dmat4> places;
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
      const auto three = [&](const std::optional<Numbers>& n, double fallback) {
        return n ? glm::dvec3(n->real(i, 0), n->real(i, 1), n->real(i, 2)) : glm::dvec3(fallback);
      };
      const glm::dquat rotation =
          turn ? glm::dquat(turn->real(i, 3), turn->real(i, 0), turn->real(i, 1), turn->real(i, 2))
               : glm::dquat(1., 0., 0., 0.);
      places.push_back(placed(three(move, 0.), rotation, three(scale, 1.)));
    }
    return places;
  }

  void readNode(const tinygltf::Node& node, const glm::dmat4& to_world) {
    require(static_cast<std::size_t>(node.mesh) < model_.meshes.size(), source_ + ": mesh", node.mesh,
            "one of the file's");
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    for (const glm::dmat4& place : instancesOf(node)) {
      std::map<int, std::uint32_t> first_of;  // accessors of positions that were read
      for (const tinygltf::Primitive& primitive : mesh.primitives)
        readPrimitive(primitive, mesh, node, to_world * place, first_of);
    }
  }

  std::uint32_t readPositions(int accessor, const glm::dmat4& to_world) {
    const Numbers positions(model_, accessor, source_ + ": POSITION");
    positions.requireFloats(TINYGLTF_TYPE_VEC3, "three floats");
    require(positions.size() <= kMostVertices - vertices.size(), source_ + ": number of vertices",
            vertices.size() + positions.size(), "at most 100000000");
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const bool plain = to_world == glm::dmat4(1.);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const glm::vec3 v(positions.real(i, 0), positions.real(i, 1), positions.real(i, 2));
      vertices.push_back(plain ? v : glm::vec3(glm::dvec3(to_world * glm::dvec4(v, 1.))));
    }
    return first;
  }

  void readPrimitive(const tinygltf::Primitive& primitive, const tinygltf::Mesh& mesh, const tinygltf::Node& node,
                     const glm::dmat4& to_world, std::map<int, std::uint32_t>& first_of) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    const auto position = primitive.attributes.find("POSITION");
    if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN || position == primitive.attributes.end()) {
      ++skipped;
      return;
    }
    for (const auto& [name, value] : primitive.extensions)
      require(!name.ends_with("_compression"), source_ + ": extension", shown(name), "none that compresses");
    const auto [known, is_new] = first_of.try_emplace(position->second, 0u);
    if (is_new) known->second = readPositions(position->second, to_world);
    const std::uint32_t first = known->second;
    const std::size_t count = Numbers(model_, position->second, source_ + ": POSITION").size();
    std::vector<std::uint32_t> corners;
    if (primitive.indices >= 0) {
      const Numbers indices(model_, primitive.indices, source_ + ": indices");
      corners.reserve(indices.size());
      for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint32_t index = indices.index(i);
        if (index >= count)
          require(false, source_ + ": vertex index", index, "below the number of vertices, " + std::to_string(count));
        corners.push_back(first + index);
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) corners.push_back(first + static_cast<std::uint32_t>(i));
    }
    addTriangles(corners, mode, partOf(primitive, mesh, node));
  }

  void addTriangles(const std::vector<std::uint32_t>& corners, int mode, std::size_t part) {
    if (mode == TINYGLTF_MODE_TRIANGLES)
      require(corners.size() % 3 == 0, source_ + ": number of triangles' corners", corners.size(), "a multiple of 3");
    std::vector<glm::uvec3>& to = triangles[part];
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    triangle_count_ += corners.size() / step;
    require(triangle_count_ <= kMostTriangles, source_ + ": number of triangles", triangle_count_, "at most 200000000");
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        to.push_back({corners[0], corners[i + 1], corners[i + 2]});
      else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1)
        to.push_back({corners[i + 1], corners[i], corners[i + 2]});
      else
        to.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
  }

  std::size_t partOf(const tinygltf::Primitive& primitive, const tinygltf::Mesh& mesh, const tinygltf::Node& node) {
    const bool has_material =
        primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < model_.materials.size();
    const auto key = std::tuple(has_material ? primitive.material : -1, mesh.name, node.name);
    const auto [known, is_new] = part_of_.try_emplace(key, parts.size());
    if (is_new) {
      Part part{.material = {}, .object = node.name, .groups = {mesh.name}, .colour = {}};
      if (has_material) {
        const tinygltf::Material& material = model_.materials[static_cast<std::size_t>(primitive.material)];
        part.material = material.name;
        const std::vector<double>& c = material.pbrMetallicRoughness.baseColorFactor;
        if (material.pbrMetallicRoughness.baseColorTexture.index < 0 && c.size() >= 3)
          part.colour = glm::vec3(c[0], c[1], c[2]);
      }
      parts.push_back(part);
      triangles.emplace_back();
      material_of.push_back(std::get<0>(key));
    }
    return known->second;
  }

  const tinygltf::Model& model_;
  const std::string& source_;
  std::vector<char> seen_;
  std::map<std::tuple<int, std::string, std::string>, std::size_t> part_of_;
  std::size_t triangle_count_ = 0;
};

// Leaves whose outline an image holds: taken whole they would be too large.
bool isCutOut(const tinygltf::Material& material) {
  return material.alphaMode != "OPAQUE" && material.pbrMetallicRoughness.baseColorTexture.index >= 0;
}

}  // namespace

ImportedTree readGltf(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules) {
  const std::string source = shown(path.string());
  const tinygltf::Model model = parse(path, bytes, source);
  GltfGatherer gathered(model, source);
  gathered.read();
  if (gathered.parts.empty()) throw InvalidInput(source + ": has no faces, so no leaves");
  const Verdict verdict = tellApart(gathered.parts, rules, source, "");
  ImportedTree tree{.mesh = {}, .dropped = {}, .how = verdict.how};
  tree.mesh.vertices = std::move(gathered.vertices);
  for (std::size_t i = 0; i < verdict.kinds.size(); ++i) {
    const bool wood = verdict.kinds[i] == Kind::wood;
    const int material = gathered.material_of[i];
    if (!wood && material >= 0 && isCutOut(model.materials[static_cast<std::size_t>(material)]))
      throw InvalidInput(source + ": material \"" + shown(gathered.parts[i].material) +
                         "\": has leaves that an image's alpha cuts out, which is read from an OBJ's map_d alone");
    std::vector<glm::uvec3>& to = wood ? tree.mesh.wood_triangles : tree.mesh.leaf_triangles;
    to.insert(to.end(), gathered.triangles[i].begin(), gathered.triangles[i].end());
  }
  if (gathered.skipped > 0) tree.how += "; left out " + std::to_string(gathered.skipped) + " parts without triangles";
  return tree;
}

}  // namespace sunfleck::detail
