#include "render/gl/stand_data.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "render/gl/light_grid.hpp"

namespace sunfleck::gl {
namespace {

using namespace detail;

constexpr float kGroundRadii = 3.f;   // of the widest crown, from a tree's axis to the rim of the ground
constexpr float kEmptyGround = 10.f;  // radius of the ground where nothing stands [m]

bool anyAbove(const glm::vec3& values, float bound) {
  return values.x > bound || values.y > bound || values.z > bound;
}

Bounds moved(const Bounds& box, const glm::vec3& by) {
  return {box.low + by, box.high + by};
}

LightBox united(const LightBox& a, const LightBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

// A map's rectangle, and the half pixel more that interpolation reaches.
LightBox rectangleOf(const LightMap& map, const glm::vec3& position) {
  const glm::vec2 low = map.corner - glm::vec2(map.origin) + glm::vec2(alongAxes(map.axes, position));
  return {low - map.pixel_size, low + map.pixel_size * (glm::vec2(map.size) + 1.f)};
}

}  // namespace

StandData::StandData()
    : sky_(RadianceTexture::Read::cells, "a sky"),
      ground_sky_(RadianceTexture::Read::interpolated, "a ground"),
      triangles_(BufferTexture::Texel::rgba32ui, "the trees' triangles take"),
      light_cells_(BufferTexture::Texel::rg32ui, "the lists of trees in the light take"),
      light_casters_(BufferTexture::Texel::rgba32ui, "the lists of trees in the light take"),
      trees_(BufferTexture::Texel::rgba32ui, "the trees take"),
      drawn_(BufferTexture::Texel::rgba32ui, "the trees take"),
      kind_frames_(Buffer::writable(kMostKinds * sizeof(KindFrame))) {}

Sent StandData::update(const DrawnStand& stand) {
  Sent sent;
  lights_ = stand.lights;
  sent.meshes = updateMeshes(stand);
  sent.leaves = updateLeaves(stand);
  sendKindFrames(stand);
  sent.maps = maps_.update(stand);
  sent.cells = cells_.update(stand);
  sent.sky = updateSky(stand);
  std::vector<const TreeLevels*> levels;
  for (const Kind& kind : kinds_) levels.push_back(kind.levels.get());
  sent.field = field_.update(stand, levels);
  sent.trees = updateTrees(stand);
  placeGround(stand);
  sent.trees += sendGrids(stand);

  lit_by_sky_ = stand.sky ||
                std::ranges::any_of(stand.trees, [](const DrawnTree& tree) { return !tree.sky_light.values.empty(); });
  frame_.counts = {static_cast<std::uint32_t>(lights_.size()), 0u, 0u, 0u};
  frame_.counts.w = field_.ground();
  frame_.sky_azimuth = glm::vec4(0.f, glm::vec2(stand.ground_sky.grid.size), 0.f);
  frame_.cell_part = glm::vec4(1.f / glm::vec3(cells_.size()), 0.f);
  if (stand.sky) {
    frame_.counts.y = static_cast<std::uint32_t>(stand.sky->rows());
    frame_.counts.z = static_cast<std::uint32_t>(stand.sky->columns());
    frame_.sky_azimuth.x = stand.sky->firstAzimuth();
  }
  return sent;
}

std::size_t StandData::updateMeshes(const DrawnStand& stand) {
  std::size_t sent = 0;
  tree_kinds_.clear();
  for (const DrawnKind& kind : stand.kinds) tree_kinds_.push_back(kind.tree);
  bool changed = kinds_.size() != stand.kinds.size();
  kinds_.resize(stand.kinds.size());
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    const std::shared_ptr<const TreeMesh>& mesh = stand.kinds[i].tree.mesh;
    if (kinds_[i].mesh == mesh) continue;
    changed = true;
    kinds_[i].mesh = nullptr;  // until its triangles are sent
    kinds_[i].levels = stand.kinds[i].levels;
    if (!kinds_[i].levels)
      kinds_[i].levels = std::make_shared<const TreeLevels>(mesh ? treeLevels(*mesh) : TreeLevels{});
    const TreeLevels& levels = *kinds_[i].levels;
    kinds_[i].buffers.emplace(levels);
    sent += levels.vertices.size() * sizeof(glm::vec3) + levels.indices.size() * sizeof(std::uint32_t);
  }
  if (changed) {
    first_triangle_.clear();
    std::size_t count = 0;
    for (const Kind& kind : kinds_) {
      first_triangle_.push_back(static_cast<std::uint32_t>(count));
      count += kind.levels->triangles.size();
    }
    static_assert(sizeof(TriangleData) == 2 * sizeof(glm::vec4));
    triangles_.resize(2 * count);
    for (std::size_t i = 0; i < kinds_.size(); ++i)
      triangles_.write(2 * first_triangle_[i], std::span<const TriangleData>(kinds_[i].levels->triangles));
    for (std::size_t i = 0; i < kinds_.size(); ++i) kinds_[i].mesh = stand.kinds[i].tree.mesh;
    sent += count * sizeof(TriangleData);
  }
  return sent;
}

// Of leaf maps: what they say, and where the triangles lie in them.
std::size_t StandData::updateLeaves(const DrawnStand& stand) {
  leaf_tables_ = shading::leafTables(tree_kinds_, leaf_tables_);
  std::vector<std::shared_ptr<const TreeLevels>> levels;
  for (const Kind& kind : kinds_) levels.push_back(kind.levels);
  return leaf_places_.update(*leaf_tables_) + image_maps_.update(stand, levels);
}

void StandData::sendKindFrames(const DrawnStand& stand) {
  std::vector<KindFrame> frames(std::max<std::size_t>(kinds_.size(), 1));
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    const DrawnCells& cells = stand.kinds[i].cells;
    frames[i] = {.cell_low = glm::vec4(cells.low, 1.f / cells.cell_size),
                 .cell_count = glm::uvec4(glm::uvec3(glm::max(cells.size, glm::ivec3(1))), first_triangle_[i]),
                 .images = {image_maps_.first(i), 0u, 0u, 0u}};
  }
  kind_frames_.write(0, std::as_bytes(std::span(frames)));
}

std::size_t StandData::updateSky(const DrawnStand& stand) {
  std::size_t sent = 0;
  if (stand.sky != sent_sky_ && stand.sky) {
    const auto cells = static_cast<std::size_t>(stand.sky->rows()) * static_cast<std::size_t>(stand.sky->columns());
    std::vector<glm::vec3> radiance;
    radiance.reserve(cells);
    for (std::size_t cell = 0; cell < cells; ++cell) radiance.push_back(stand.sky->radiance(cell));
    sky_.assign({stand.sky->columns(), stand.sky->rows()}, radiance);
    sent += cells * sizeof radiance[0];
  }
  sent_sky_ = stand.sky;
  const GroundSky& ground = stand.ground_sky;
  if (ground.revision != sent_ground_sky_ && !ground.irradiance.empty()) {
    ground_sky_.assign(ground.grid.size, ground.irradiance);
    sent += ground.irradiance.size_bytes();
  }
  sent_ground_sky_ = ground.revision;
  frame_.ground_cells =
      glm::vec4(ground.grid.low, 1.f / (ground.grid.cell_size * glm::vec2(glm::max(ground.grid.size, 1))));
  frame_.ground_open = glm::vec4(ground.open, ground.irradiance.empty() ? 0.f : 1.f);
  return sent;
}

std::size_t StandData::updateTrees(const DrawnStand& stand) {
  std::vector<TreeData> trees;
  for (std::size_t tree = 0; tree < stand.trees.size(); ++tree)
    trees.push_back(
        {.position = stand.trees[tree].position,
         .kind = stand.trees[tree].kind,
         .cells = glm::uvec3(cells_.corner(tree)),
         .told = (cells_.has(tree) ? 1u : 0u) | (stand.trees[tree].far ? 2u : 0u) | field_.place(tree) << 2});
  std::vector<Standing> drawn;
  for (Kind& kind : kinds_) kind.drawn.clear();
  box_ = {};
  seen_.clear();
  for (const glm::vec3& shift : copies(stand, glm::ivec2(kDrawnAround)))
    for (std::uint32_t number = 0; number < stand.trees.size(); ++number) {
      const DrawnTree& tree = stand.trees[number];
      seen_.push_back({.tree = number, .kind = tree.kind, .position = tree.position + shift});
      kinds_[tree.kind].drawn.push_back(
          {.position = tree.position + shift, .number = static_cast<std::uint32_t>(drawn.size())});
      drawn.push_back({.position = tree.position + shift, .tree = number});
      if (!kinds_[tree.kind].levels->box.empty())
        box_.include(moved(kinds_[tree.kind].levels->box, drawn.back().position));
    }
  trees_.assign(std::span<const TreeData>(trees));
  drawn_.assign(std::span<const Standing>(drawn));
  return trees.size() * sizeof trees[0] + drawn.size() * sizeof drawn[0];
}

// At the lowest point of the stand, three crown radii beyond its middle and as far again as the stand is wide.
void StandData::placeGround(const DrawnStand& stand) {
  Bounds all;
  float crown_radius = 0.f;
  for (const DrawnTree& tree : stand.trees) {
    const Bounds box = bounds(*kinds_[tree.kind].mesh);
    if (box.empty()) continue;
    all.include(moved(box, tree.position));
    crown_radius = std::max({crown_radius, 0.5f * box.size().x, 0.5f * box.size().y});
  }
  ground_ = {.centre = glm::vec3(0.f), .radius = kEmptyGround};
  if (!all.empty())
    ground_ = {.centre = {all.centre().x, all.centre().y, all.low.z},
               .radius = 0.5f * std::max(all.size().x, all.size().y) + (kGroundRadii - 1.f) * crown_radius};
  frame_.ground = glm::vec4(ground_.centre, ground_.radius);
  frame_.ground_albedo = glm::vec4(stand.ground_albedo, anyAbove(stand.ground_albedo, 0.f) ? 1.f : 0.f);
  frame_.period = glm::vec4(0.f);
  if (stand.period)
    frame_.period = glm::vec4(*stand.period, stand.ground_sky.irradiance.empty() && stand.ground_field.values.empty()
                                                 ? glm::vec2(ground_.centre) - 0.5f * *stand.period
                                                 : stand.ground_sky.grid.low);
}

std::size_t StandData::sendGrids(const DrawnStand& stand) {
  // Places that are lit: of the trees of the stand itself, and of the ground, in one period.
  std::vector<Bounds> lit_boxes;
  for (const DrawnTree& tree : stand.trees)
    if (!kinds_[tree.kind].levels->box.empty())
      lit_boxes.push_back(moved(kinds_[tree.kind].levels->box, tree.position));
  const glm::vec3 half(ground_.radius, ground_.radius, 0.f);
  const glm::vec3 start(frame_.period.z, frame_.period.w, ground_.centre.z);
  if (stand.period)
    lit_boxes.push_back({start, start + glm::vec3(*stand.period, 0.f)});
  else
    lit_boxes.push_back({ground_.centre - half, ground_.centre + half});

  std::vector<glm::uvec2> cells;  // first and end of the casters of each
  std::vector<Standing> casters;
  const std::vector<glm::vec3> shifts = copies(stand, stand.periods_around);
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    const Axes axes = axesAlong(lights_[light].along);
    LightBox lit = across(axes, lit_boxes.front());
    for (const Bounds& box : lit_boxes) lit = united(lit, across(axes, box));
    lit = {lit.low - 1e-3f, lit.high + 1e-3f};
    std::vector<LightBox> rectangles;
    for (const glm::vec3& shift : shifts)
      for (const DrawnTree& tree : stand.trees)
        rectangles.push_back(rectangleOf(stand.kinds[tree.kind].maps[light], tree.position + shift));
    const LightGrid grid = lightGrid(rectangles, lit);
    frame_.lights[light] = {.right = glm::vec4(axes.right, grid.low.x),
                            .up = glm::vec4(axes.up, grid.low.y),
                            .travel = glm::vec4(axes.along, 1.f / grid.cell_size),
                            .grid = {static_cast<std::uint32_t>(grid.size.x), static_cast<std::uint32_t>(grid.size.y),
                                     static_cast<std::uint32_t>(cells.size()), 0u}};
    const auto before = static_cast<std::uint32_t>(casters.size());
    for (std::size_t cell = 0; cell + 1 < grid.first.size(); ++cell)
      cells.push_back(before + glm::uvec2(grid.first[cell], grid.first[cell + 1]));
    for (const std::uint32_t caster : grid.casters) {
      const std::size_t tree = caster % stand.trees.size();
      casters.push_back({.position = stand.trees[tree].position + shifts[caster / stand.trees.size()],
                         .tree = static_cast<std::uint32_t>(tree)});
    }
  }
  light_cells_.assign(std::span<const glm::uvec2>(cells));
  light_casters_.assign(std::span<const Standing>(casters));
  return cells.size() * sizeof cells[0] + casters.size() * sizeof casters[0];
}

void StandData::bind() const {
  kind_frames_.bindUniform(2);
  maps_.bind(0, 1, 3);
  light_cells_.bind(2);
  light_casters_.bind(3);
  cells_.bind(4, 5);
  triangles_.bind(7);
  sky_.bind(8);
  ground_sky_.bind(9);
  trees_.bind(12);
  drawn_.bind(13);
  field_.bind(14, 15);
  if (!leaf_tables_->mapped()) return;
  leaf_places_.bind(16);
  image_maps_.bind(17);
}

}  // namespace sunfleck::gl
