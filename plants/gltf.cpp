#include "plants/detail/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "core/require.hpp"
#include "plants/detail/assemble.hpp"
#include "plants/detail/gltf_faces.hpp"
#include "plants/detail/gltf_parse.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

constexpr std::size_t kMostKinds = 1000;

// One mesh and how it is turned and scaled, wherever it stands by a move and a turn about the vertical.
struct Posture {
  int mesh, node;
  glm::dmat3 linear;               // of the model in the file's axes
  std::optional<glm::dmat3> back;  // from z up to the model; none where it is flat
  std::vector<Placement> trees;
};

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules,
             const ImageReader& read_image)
      : source_(shown(path.string())),
        rules_(rules),
        read_image_(read_image),
        model_(parseGltf(path, bytes, source_)),
        materials_(gltfMaterials(model_, path.parent_path(), source_)),
        placed_(placedMeshes(model_, source_)),
        most_(std::max<std::size_t>(20'000'000, bytes.size())) {}

  ImportedTree tree() const {
    GltfFaces all(model_, materials_, most_, source_);
    for (const PlacedMesh& placed : placed_) all.add(placed);
    requireParts(all.faces.parts);
    const Verdict verdict = tellApart(all.faces.parts, rules_, source_, "");
    return finished(std::move(all), verdict);
  }

  std::optional<ImportedStand> stand() const {
    const std::optional<std::vector<Posture>> postures = posturesOfInstances();
    if (!postures) return std::nullopt;
    // Meshes that always stand together, such as leaves and wood of a tree, are one kind.
    std::vector<std::vector<const Posture*>> kinds;
    for (const Posture& posture : *postures) {
      const auto same = std::ranges::find_if(kinds, [&](const auto& kind) {
        return kind[0]->trees == posture.trees && kind[0]->linear == posture.linear;
      });
      if (same != kinds.end())
        same->push_back(&posture);
      else
        kinds.push_back({&posture});
    }
    if (kinds.size() > kMostKinds) return std::nullopt;
    ImportedStand stand;
    stand.stand.trees.clear();
    std::vector<GltfFaces> faces;
    std::size_t left = most_;
    for (const auto& kind : kinds) {
      faces.emplace_back(model_, materials_, left, source_);
      for (const Posture* posture : kind) faces.back().add({posture->mesh, posture->node, glm::dmat4(posture->linear)});
      left -= std::max(faces.back().faces.vertices.size(), faces.back().faces.triangles.size());
    }
    faces.emplace_back(model_, materials_, left, source_);
    std::set<int> standing;  // meshes that are in a kind
    for (const Posture& posture : *postures) standing.insert(posture.mesh);
    for (const PlacedMesh& placed : placed_)
      if (!standing.contains(placed.mesh)) faces.back().add(placed);
    if (faces.back().faces.triangles.empty()) faces.pop_back();

    std::vector<Part> parts;
    for (const GltfFaces& of_kind : faces)
      parts.insert(parts.end(), of_kind.faces.parts.begin(), of_kind.faces.parts.end());
    requireParts(parts);
    const Verdict verdict = tellApart(parts, rules_, source_, "");
    auto next = verdict.kinds.begin();
    std::vector<Verdict> verdicts;
    for (const GltfFaces& of_kind : faces) {
      const auto end = next + static_cast<std::ptrdiff_t>(of_kind.faces.parts.size());
      verdicts.push_back({{next, end}, verdict.how});
      if (std::find(next, end, Kind::leaf) == end) return std::nullopt;
      next = end;
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const std::string& of_mesh =
          i < kinds.size() ? model_.meshes[static_cast<std::size_t>(kinds[i][0]->mesh)].name : "rest";
      const std::string name = of_mesh.empty() ? "tree" : shown(of_mesh);
      std::string unique = name;
      for (int number = 2; !names.insert(unique).second; ++number) unique = name + " " + std::to_string(number);
      stand.kinds.push_back({unique, finished(std::move(faces[i]), verdicts[i])});
      std::vector<Placement> trees = i < kinds.size() ? kinds[i][0]->trees : std::vector<Placement>{Placement{}};
      for (Placement& tree : trees) tree.kind = static_cast<std::uint32_t>(i);
      stand.stand.trees.insert(stand.stand.trees.end(), trees.begin(), trees.end());
    }
    return stand;
  }

 private:
  void requireParts(const std::vector<Part>& parts) const {
    if (parts.empty()) throw InvalidInput(source_ + ": has no faces, so no leaves");
  }

  ImportedTree finished(GltfFaces all, const Verdict& verdict) const {
    const std::optional<FileLeafColours> colours = leafColours(all, verdict);
    ImportedTree tree = assemble(std::move(all.faces), verdict, rules_, read_image_, source_);
    tree.colours = colours;
    if (all.skipped > 0) tree.how += "; left out " + std::to_string(all.skipped) + " parts without triangles";
    complete(tree, rules_, true, source_);
    return tree;
  }

  // The mean over the area of leaves whose material tells it.
  std::optional<FileLeafColours> leafColours(const GltfFaces& all, const Verdict& verdict) const {
    if (std::ranges::none_of(materials_, [](const GltfMaterial& m) { return m.leaf.has_value(); })) return std::nullopt;
    glm::dvec3 reflected(0.), passed(0.);
    double area = 0.;
    for (std::size_t i = 0; i < all.faces.triangles.size(); ++i) {
      const std::uint32_t part = all.faces.part_of_triangle[i];
      const int material = all.material_of_part[part];
      if (verdict.kinds[part] == Kind::wood || material < 0) continue;
      const std::optional<FileLeafColours>& leaf = materials_[static_cast<std::size_t>(material)].leaf;
      if (!leaf) continue;
      const glm::uvec3& t = all.faces.triangles[i];
      const glm::dvec3 a = all.faces.vertices[t.x], b = all.faces.vertices[t.y], c = all.faces.vertices[t.z];
      const double share = glm::length(glm::cross(b - a, c - a));
      if (!std::isfinite(share)) continue;
      reflected += share * glm::dvec3(leaf->reflectance);
      passed += share * glm::dvec3(leaf->transmittance);
      area += share;
    }
    if (!(area > 0.)) return std::nullopt;
    return FileLeafColours{.reflectance = glm::vec3(reflected / area), .transmittance = glm::vec3(passed / area)};
  }

  // From the file's axes to z up.
  glm::dmat3 zUp() const {
    using Up = ImportRules::Up;
    switch (rules_.up) {
      case Up::z:
        return glm::dmat3(1.);
      case Up::x:
        return {{0., 0., 1.}, {1., 0., 0.}, {0., 1., 0.}};
      default:
        return {{1., 0., 0.}, {0., 0., 1.}, {0., -1., 0.}};
    }
  }

  static std::optional<glm::dmat3> inverseOf(const glm::dmat3& linear) {
    if (!(std::abs(glm::determinant(linear)) > 1e-30)) return std::nullopt;
    return glm::inverse(linear);
  }

  // The turn about the vertical [rad] that a transform is, z up.
  static std::optional<double> turnOf(const glm::dmat3& between) {
    constexpr double kSame = 1e-5;
    const double angle = std::atan2(between[0].y, between[0].x);
    const glm::dmat3 turn{
        {std::cos(angle), std::sin(angle), 0.}, {-std::sin(angle), std::cos(angle), 0.}, {0., 0., 1.}};
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row)
        if (!(std::abs(between[column][row] - turn[column][row]) <= kSame)) return std::nullopt;
    return angle;
  }

  // Of meshes that stand in several places; nothing if there are none, or they stand in too many ways.
  std::optional<std::vector<Posture>> posturesOfInstances() const {
    std::map<int, std::size_t> count;
    for (const PlacedMesh& placed : placed_) ++count[placed.mesh];
    if (std::ranges::none_of(count, [](const auto& of) { return of.second > 1; })) return std::nullopt;
    const glm::dmat3 z_up = zUp(), back = glm::transpose(z_up);
    std::vector<Posture> postures;
    std::map<int, std::vector<std::size_t>> of_mesh;
    for (const PlacedMesh& placed : placed_) {
      if (count[placed.mesh] < 2) continue;
      const glm::dmat3 linear = z_up * glm::dmat3(placed.to_world) * back;
      const glm::dvec3 position = double{rules_.scale} * (z_up * glm::dvec3(placed.to_world[3]));
      std::vector<std::size_t>& known = of_mesh[placed.mesh];
      std::optional<double> turn;
      auto posture = std::ranges::find_if(known, [&](std::size_t i) {
        if (postures[i].back) turn = turnOf(linear * *postures[i].back);
        return turn.has_value();
      });
      if (posture == known.end()) {
        turn = turnOf(linear);
        known.push_back(postures.size());
        posture = known.end() - 1;
        const glm::dmat3 of_model = turn ? glm::dmat3(1.) : glm::dmat3(placed.to_world);
        postures.push_back({placed.mesh, placed.node, of_model, inverseOf(z_up * of_model * back), {}});
        if (known.size() > std::max<std::size_t>(1, count[placed.mesh] / 2)) return std::nullopt;
        if (postures.size() > kMostKinds) return std::nullopt;
      }
      if (!std::isfinite(position.x + position.y + position.z)) return std::nullopt;
      postures[*posture].trees.push_back(
          {.position = glm::vec3(position), .rotation = static_cast<float>(turn.value_or(0.))});
    }
    return postures;
  }

  const std::string source_;
  const ImportRules& rules_;
  const ImageReader& read_image_;
  const tinygltf::Model model_;
  const std::vector<GltfMaterial> materials_;
  const std::vector<PlacedMesh> placed_;
  const std::size_t most_;
};

}  // namespace

ImportedTree readGltf(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules,
                      const ImageReader& read_image) {
  const GltfReader reader(path, bytes, rules, read_image);
  if (rules.mesh.empty()) return reader.tree();
  std::optional<ImportedStand> stand = reader.stand();
  if (!stand)
    throw InvalidInput(shown(path.string()) + ": mesh \"" + shown(rules.mesh) +
                       "\": must be of a glTF file that is a stand of instances");
  std::string names;
  for (ImportedStand::Kind& kind : stand->kinds) {
    if (kind.name == rules.mesh) return std::move(kind.tree);
    if (names.size() < 200) names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw InvalidInput(shown(path.string()) + ": mesh \"" + shown(rules.mesh) + "\": must be one of " + names);
}

ImportedStand readGltfStand(const std::filesystem::path& path, const std::string& bytes, const ImportRules& rules,
                            const ImageReader& read_image) {
  const GltfReader reader(path, bytes, rules, read_image);
  if (std::optional<ImportedStand> stand = reader.stand()) return *std::move(stand);
  ImportedStand single;
  single.kinds.push_back({path.stem().string(), reader.tree()});
  return single;
}

}  // namespace sunfleck::detail
