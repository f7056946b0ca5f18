#include "render/reference/ray_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "core/require.hpp"
#include "render/reference/detail/primitives.hpp"
#include "render/reference/detail/scene_geometry.hpp"

namespace sunfleck {
using namespace detail;
namespace {

// Of the kinds together: 60 MB, and a second to make.
constexpr std::size_t kMostWalked = 1'000'000;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void keepFirstError(void* text, RTCError code, const char* message) {
  std::string& error = *static_cast<std::string*>(text);
  if (error.empty()) error = "Embree error " + std::to_string(code) + ": " + (message ? message : "");
}

// Takes back hits where a mask cuts the leaf away: the ray goes on.
void passCutLeaves(const RTCFilterFunctionNArguments* arguments) {
  const auto& images = *static_cast<const LeafImages*>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const std::uint32_t number = images.patch_of_triangle[RTCHitN_primID(arguments->hit, arguments->N, i)];
    if (number == TreeMesh::kNoPatch || images.patches[number].mask == LeafPatch::kNoMask) continue;
    const LeafPatch& patch = images.patches[number];
    const float u = RTCHitN_u(arguments->hit, arguments->N, i), v = RTCHitN_v(arguments->hit, arguments->N, i);
    if (!images.masks[patch.mask]->at(patch.corners, u, v)) arguments->valid[i] = 0;
  }
}

// `cuts`: none where the triangles are whole.
void attachPrimitives(RTCDevice device, RTCScene scene, unsigned number, const std::vector<glm::vec3>& vertices,
                      const Primitives& primitives, const glm::vec3& pivot, LeafImages* cuts = nullptr) {
  const std::size_t count = primitives.first_triangle.size();
  if (count == 0) return;
  RTCGeometry geometry =
      rtcNewGeometry(device, primitives.quads() ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
  void* points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                         vertices.size());
  void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                          primitives.quads() ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
                                          primitives.each * sizeof(unsigned), count);
  if (points && corners) {
    std::transform(vertices.begin(), vertices.end(), static_cast<glm::vec3*>(points),
                   [&](const glm::vec3& vertex) { return vertex - pivot; });
    std::ranges::copy(primitives.corners, static_cast<unsigned*>(corners));
    if (cuts) {
      rtcSetGeometryUserData(geometry, cuts);
      rtcSetGeometryIntersectFilterFunction(geometry, passCutLeaves);
      rtcSetGeometryOccludedFilterFunction(geometry, passCutLeaves);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
  }
  rtcReleaseGeometry(geometry);
}

void attachInstance(RTCDevice device, RTCScene scene, unsigned number, RTCScene of, const Copy& copy) {
  RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, of);
  rtcSetGeometryTimeStepCount(instance, 1);
  const glm::vec3& t = copy.translation;
  const float columns[12] = {copy.cosine, copy.sine, 0.f, -copy.sine, copy.cosine, 0.f, 0.f, 0.f, 1.f, t.x, t.y, t.z};
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(instance);
  rtcAttachGeometryByID(scene, instance, number);
  rtcReleaseGeometry(instance);
}

glm::vec4 planeOf(const TreeMesh& mesh, const glm::uvec3& triangle, const glm::vec3& pivot) {
  const glm::dvec3 a = mesh.vertices[triangle.x] - pivot;
  const glm::dvec3 b = mesh.vertices[triangle.y] - pivot;
  const glm::dvec3 c = mesh.vertices[triangle.z] - pivot;
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  return glm::vec4(glm::dvec4(normal, glm::dot(normal, (a + b + c) / 3.)));
}

RTCRayHit rayFrom(const glm::vec3& from, const glm::vec3& direction, float reach) {
  RTCRayHit ray;
  set(ray.ray, from, direction, reach);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

// Distance along one axis to the wall the ray heads for.
float toWall(float position, float direction, float low, float high) {
  if (direction == 0.f) return kInfinity;
  return std::max(0.f, ((direction > 0.f ? high : low) - position) / direction);
}

// Of all media; empty along the axes along which they have no end.
Bounds boxOf(const std::vector<TraceMedium>& media) {
  Bounds box;
  for (const TraceMedium& medium : media) {
    Bounds of_medium = occupied(medium);
    for (int axis = 0; axis < 2; ++axis)
      if (of_medium.high[axis] == kInfinity) std::swap(of_medium.low[axis], of_medium.high[axis]);
    box.include(of_medium);
  }
  return box;
}

float largestCoordinate(const Bounds& box) {
  const glm::vec3 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
  return std::max({largest.x, largest.y, largest.z});
}

}  // namespace

RayScene::Geometry::Geometry(std::span<const TreeMesh* const> kinds, const Stand& stand, bool with_wood,
                             const std::vector<TraceMedium>& of_media) {
  for (const TraceMedium& medium : of_media) validate(medium, stand.period);
  StandCopies placed = standCopies(kinds, stand, with_wood, boxOf(of_media));
  origin = placed.origin;
  copies = std::move(placed.copies);
  period = stand.period;
  box = placed.box;
  stand_box = {.low = box.low + origin, .high = box.high + origin};
  // A periodic stand's trees may be larger than its period, and their vertices are as exact as their size allows.
  Bounds coordinates = box;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const Bounds of_kind = bounds(*kinds[kind]);
    coordinates.include({.low = of_kind.low - placed.pivots[kind], .high = of_kind.high - placed.pivots[kind]});
  }
  lift = 8.f * std::numeric_limits<float>::epsilon() * largestCoordinate(coordinates);
  low = box.low.z - 4.f * lift;
  high = box.high.z + 4.f * lift;
  for (const TraceMedium& medium : of_media) media.emplace_back(medium, origin, period);
  media_hash = mediaHash(of_media);

  device.reset(rtcNewDevice(nullptr));
  if (!device) throw std::runtime_error("Embree error " + std::to_string(rtcGetDeviceError(nullptr)));
  rtcSetDeviceErrorFunction(device.get(), keepFirstError, &embree_error);

  std::vector<double> trees(kinds.size());
  for (const Placement& tree : stand.trees) trees[tree.kind] += 1.;
  std::vector<EmbreeScene> made;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const TreeMesh& mesh = *kinds[kind];
    EmbreeScene& scene = made.emplace_back(rtcNewScene(device.get()));
    Prototype& prototype = prototypes.emplace_back();
    const glm::vec3& pivot = placed.pivots[kind];
    if (!mesh.patch_of_triangle.empty())
      prototype.images.reset(new LeafImages{.masks = mesh.masks,
                                            .patches = mesh.patches,
                                            .patch_of_triangle = mesh.patch_of_triangle,
                                            .triangles = mesh.leaf_triangles});
    const auto attach = [&](unsigned number, const std::vector<glm::uvec3>& triangles, const Primitives& primitives) {
      attachPrimitives(device.get(), scene.get(), number, mesh.vertices, primitives, pivot,
                       number == kLeaves && prototype.cut() ? prototype.images.get() : nullptr);
      for (std::size_t i = 0; i < primitives.first_triangle.size(); ++i) {
        const std::uint32_t first = primitives.first_triangle[i];
        const std::size_t before = number == kWood ? mesh.leaf_triangles.size() : 0;
        prototype.first_triangle.push_back(first + static_cast<std::uint32_t>(before));
        const glm::vec4 plane = planeOf(mesh, triangles[first], pivot);
        prototype.planes.push_back({plane, primitives.pair(i) ? planeOf(mesh, triangles[first + 1], pivot) : plane});
      }
    };
    const Primitives leaves =
        prototype.cut() ? alone(mesh.leaf_triangles) : paired(mesh.leaf_triangles, mesh.leaf_of_triangle);
    prototype.leaf_quads = leaves.quads();
    attach(kLeaves, mesh.leaf_triangles, leaves);
    if (prototype.images) prototype.images->vertices = verticesOf(scene.get(), kLeaves);
    const Primitives wood = with_wood ? paired(mesh.wood_triangles, {}) : Primitives{};
    prototype.wood_quads = wood.quads();
    attach(kWood, mesh.wood_triangles, wood);
    for (const std::uint32_t first : leaves.first_triangle)
      prototype.leaf_of_primitive.push_back(static_cast<std::uint32_t>(leaf_area.size()) +
                                            mesh.leaf_of_triangle[first]);
    for (const double area : leafAreas(mesh)) leaf_area.push_back(area * trees[kind]);
  }
  surfaces = std::any_of(prototypes.begin(), prototypes.end(), [](const auto& of) { return !of.planes.empty(); });
  checkEmbree();
  scenes = commit(std::move(made), RTC_SCENE_FLAG_NONE);
  std::size_t primitives = 0;
  for (const Prototype& prototype : prototypes) primitives += prototype.planes.size();
  walks_ = RayTrees::suitMachine() && !masked() && primitives <= kMostWalked;
}

void RayScene::Geometry::checkEmbree() const {
  if (!embree_error.empty()) throw std::runtime_error(embree_error);
}

Scenes RayScene::Geometry::commit(std::vector<EmbreeScene> of_kinds, RTCSceneFlags flags) const {
  Scenes made{.prototypes = std::move(of_kinds), .instances = nullptr};
  for (const EmbreeScene& prototype : made.prototypes) {
    rtcSetSceneFlags(prototype.get(), flags);
    rtcCommitScene(prototype.get());
  }
  if (!standsAsItIs(copies)) {
    made.instances.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(made.instances.get(), flags);
    for (std::size_t i = 0; i < copies.size(); ++i)
      attachInstance(device.get(), made.instances.get(), static_cast<unsigned>(i),
                     made.prototypes[copies[i].kind].get(), copies[i]);
    rtcCommitScene(made.instances.get());
  }
  checkEmbree();
  return made;
}

RTCScene RayScene::Geometry::countingScene() const {
  std::call_once(counting_made, [&] {
    std::vector<EmbreeScene> leaves;
    for (std::size_t kind = 0; kind < prototypes.size(); ++kind) {
      RTCScene scene = leaves.emplace_back(rtcNewScene(device.get())).get();
      if (!prototypes[kind].leaf_of_primitive.empty())
        rtcAttachGeometryByID(scene, rtcGetGeometry(scenes.prototypes[kind].get(), kLeaves), kLeaves);
    }
    counting = commit(std::move(leaves), RTC_SCENE_FLAG_ROBUST | kFilterPerCall);
  });
  return counting.root();
}

// The point is put back on its triangle's plane, as travel along a long ray rounds more than a plane does.
Hit RayScene::Geometry::describe(const Met& met, const glm::vec3& from, const glm::vec3& direction) const {
  const glm::vec3 travelled = from + met.distance * direction;
  const Copy& copy = copies[met.copy];
  const Prototype& prototype = prototypes[copy.kind];
  glm::vec3 normal(met.plane);
  float distance = met.plane.w;
  if (scenes.instances) {
    normal = copy.rotated(normal);
    distance += glm::dot(normal, copy.translation);
  }
  const bool front = glm::dot(normal, direction) <= 0.f;
  return {.surface = met.leaf ? Surface::leaf : Surface::wood,
          .kind = copy.kind,
          .leaf = met.leaf ? prototype.leaf_of_primitive[met.primitive] : 0,
          .position = travelled - (glm::dot(normal, travelled) - distance) * normal,
          .front = front,
          .normal = front ? normal : -normal,
          .copy = met.copy,
          .primitive = met.primitive};
}

Met RayScene::Geometry::metBy(const RTCHit& hit, float distance) const {
  const std::uint32_t copy = hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? 0 : hit.instID[0];
  const bool leaf = hit.geomID == kLeaves;
  const Prototype& prototype = prototypes[copies[copy].kind];
  // Embree's second triangle of a quad turns u and v about.
  const glm::vec4& plane =
      prototype.planes[hit.primID + (leaf ? 0 : prototype.leaf_of_primitive.size())][hit.u + hit.v > 1.f];
  return {.copy = copy, .primitive = hit.primID, .leaf = leaf, .plane = plane, .distance = distance};
}

const RayTrees* RayScene::Geometry::walked() const {
  if (!walks_) return nullptr;
  if (const RayTrees* made = walked_.load(std::memory_order_acquire)) return made;
  std::call_once(trees_made_, [&] {
    std::vector<std::vector<Facet>> of_kinds;
    for (std::uint32_t kind = 0; kind < prototypes.size(); ++kind) of_kinds.push_back(facets(kind));
    trees_ = std::make_unique<const RayTrees>(of_kinds, copies);
    walked_.store(trees_.get(), std::memory_order_release);
  });
  return trees_.get();
}

std::optional<Met> RayScene::Geometry::first(const glm::vec3& from, const glm::vec3& direction, Coherence coherence,
                                             float reach) const {
  if (const RayTrees* trees = walked()) {
    FacetMet met;
    if (!trees->closest(from, direction, reach, met)) return std::nullopt;
    return Met{.copy = met.copy,
               .primitive = met.facet & FacetLeaf::kNumber,
               .leaf = !(met.facet & FacetLeaf::kWood),
               .plane = {met.plane[0], met.plane[1], met.plane[2], met.plane[3]},
               .distance = met.distance};
  }
  RTCRayHit ray = rayFrom(from, direction, reach);
  closestHit(scenes.root(), ray, coherence);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return metBy(ray.hit, ray.ray.tfar);
}

bool RayScene::Geometry::any(const glm::vec3& from, const glm::vec3& direction, float reach) const {
  if (const RayTrees* trees = walked()) return trees->blocked(from, direction, reach);
  RTCRay ray;
  set(ray, from, direction, reach);
  anyHit(scenes.root(), ray);
  return ray.tfar < 0.f;
}

Hit RayScene::Geometry::closest(const glm::vec3& from, const glm::vec3& direction, Coherence coherence,
                                float reach) const {
  if (period) return closestInPeriods(from, direction, coherence, media.empty() ? kInfinity : reach);
  const std::optional<Met> met = first(from, direction, coherence, reach);
  return met ? describe(*met, from, direction) : Hit{};
}

bool RayScene::Geometry::blocked(const glm::vec3& from, const glm::vec3& direction) const {
  return period ? blockedInPeriods(from, direction) : any(from, direction, kInfinity);
}

void RayScene::Geometry::closest(std::span<const glm::vec3> from, std::span<const Direction> directions,
                                 std::span<const float> reach, std::span<Hit> hits) const {
  if (from.empty()) return;  // see blocked
  if (period || walksAlone()) {
    for (std::size_t i = 0; i < from.size(); ++i)
      hits[i] = closest(from[i], directions[i], Coherence::coherent, reach[i]);
    return;
  }
  alignas(64) std::array<int, kPacket> valid{};
  RTCRayHit16 rays{};
  for (std::size_t i = 0; i < from.size(); ++i) {
    valid[i] = -1;
    set(rays.ray, i, from[i], directions[i], reach[i]);
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  closestHits(valid.data(), scenes.root(), rays);
  for (std::size_t i = 0; i < from.size(); ++i) {
    hits[i] = {};
    if (rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    RTCHit hit;
    hit.geomID = rays.hit.geomID[i];
    hit.primID = rays.hit.primID[i];
    hit.instID[0] = rays.hit.instID[0][i];
    hit.u = rays.hit.u[i];
    hit.v = rays.hit.v[i];
    hits[i] = describe(metBy(hit, rays.ray.tfar[i]), from[i], directions[i]);
  }
}

void RayScene::Geometry::blocked(std::span<const glm::vec3> from, const glm::vec3& direction,
                                 std::span<bool> is_blocked) const {
  if (period || walksAlone()) {
    for (std::size_t i = 0; i < from.size(); ++i)
      if (!is_blocked[i]) is_blocked[i] = blocked(from[i], direction);
    return;
  }
  alignas(64) std::array<int, kPacket> valid{};
  RTCRay16 rays{};
  bool asked = false;
  for (std::size_t i = 0; i < from.size(); ++i) {
    valid[i] = is_blocked[i] ? 0 : -1;
    asked = asked || !is_blocked[i];
    set(rays, i, from[i], direction, kInfinity);
  }
  if (!asked) return;  // Embree 3.13 may never come back from a packet of which no ray counts
  anyHits(valid.data(), scenes.root(), rays);
  for (std::size_t i = 0; i < from.size(); ++i) is_blocked[i] = is_blocked[i] || rays.tfar[i] < 0.f;
}

glm::vec3 RayScene::Geometry::wrapped(glm::vec3 point) const {
  for (int axis = 0; axis < 2; ++axis) {
    const float side = (*period)[axis];
    point[axis] -= side * std::floor((point[axis] - box.low[axis]) / side);
  }
  return point;
}

// Moves a point above or below the layer to where its ray enters it, and its reach with it; false if it never does.
bool RayScene::Geometry::enterLayer(glm::vec3& point, const glm::vec3& direction, float& reach) const {
  if (point.z > high || point.z < low) {
    const float face = point.z > high ? high : low;
    const float distance = (face - point.z) / direction.z;
    if (!(distance >= 0.f && distance < kInfinity)) return false;
    reach -= distance;
    point += distance * direction;
    point.z = face;
  }
  point = wrapped(point);
  return true;
}

namespace {

// Follows a ray through the periods: `segment(point, length)` for each stretch inside one, until it answers true.
template <typename Segment>
void throughPeriods(const RayScene::Geometry& scene, glm::vec3 point, const glm::vec3& direction,
                    const Segment& segment) {
  for (int passed = 0; passed < kMostPeriods; ++passed) {
    const float x = toWall(point.x, direction.x, scene.box.low.x, scene.box.high.x);
    const float y = toWall(point.y, direction.y, scene.box.low.y, scene.box.high.y);
    const float z = toWall(point.z, direction.z, scene.low, scene.high);
    const float wall = std::min(x, y);
    if (segment(point, std::min(wall, z)) || z <= wall) return;
    point += wall * direction;
    const int axis = x <= y ? 0 : 1;
    point[axis] = direction[axis] > 0.f ? scene.box.low[axis] : scene.box.high[axis];
  }
}

}  // namespace

Hit RayScene::Geometry::closestInPeriods(glm::vec3 point, const glm::vec3& direction, Coherence coherence,
                                         float reach) const {
  Hit hit;
  if (!surfaces || !enterLayer(point, direction, reach)) return hit;
  throughPeriods(*this, point, direction, [&](const glm::vec3& from, float length) {
    if (reach <= 0.f) return true;
    const std::optional<Met> met = first(from, direction, coherence, std::min(length, reach));
    reach -= length;
    if (met) hit = describe(*met, from, direction);
    return met.has_value();
  });
  return hit;
}

bool RayScene::Geometry::blockedInPeriods(glm::vec3 point, const glm::vec3& direction) const {
  bool found = false;
  float reach = kInfinity;
  if (!surfaces || !enterLayer(point, direction, reach)) return found;
  throughPeriods(*this, point, direction,
                 [&](const glm::vec3& from, float length) { return found = any(from, direction, length); });
  return found;
}

namespace {

struct LeafCrossing {
  float distance;
  std::uint32_t copy, leaf;
};

struct Counting {
  EmbreeContext context;  // first, so that the filter finds the rest from it
  const RayScene::Geometry* scene;
  std::vector<LeafCrossing>* crossings;
};

void noteAndReject(const RTCFilterFunctionNArguments* arguments) {
  const Counting& counting = *reinterpret_cast<const Counting*>(arguments->context);
  const unsigned primitive = RTCHitN_primID(arguments->hit, arguments->N, 0);
  const unsigned instance = RTCHitN_instID(arguments->hit, arguments->N, 0, 0);
  const Copy& copy = counting.scene->copies[instance == RTC_INVALID_GEOMETRY_ID ? 0 : instance];
  counting.crossings->push_back({RTCRayN_tfar(arguments->ray, arguments->N, 0), instance,
                                 counting.scene->prototypes[copy.kind].leaf_of_primitive[primitive]});
  arguments->valid[0] = 0;
}

}  // namespace

RayScene::RayScene(std::span<const TreeMesh* const> kinds, const Stand& stand, bool with_wood,
                   const std::vector<TraceMedium>& media)
    : geometry_(std::make_unique<Geometry>(kinds, stand, with_wood, media)) {}

RayScene::RayScene(const TreeMesh& mesh, const Stand& stand, bool with_wood)
    : RayScene(std::array{&mesh}, stand, with_wood) {}

RayScene::RayScene(const std::vector<TraceMedium>& media, const std::optional<glm::vec2>& period) {
  const TreeMesh nothing;
  geometry_ =
      std::make_unique<Geometry>(std::array<const TreeMesh*, 1>{&nothing}, Stand{.period = period}, false, media);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const Bounds& RayScene::box() const {
  return geometry_->stand_box;
}

int RayScene::crossings(glm::vec3 from, glm::vec3 direction, std::uint32_t own) const {
  if (geometry_->period) throw InvalidInput("leaf crossings on a line: the stand must not be periodic");
  std::vector<LeafCrossing> crossings;
  Counting counting{.context = {}, .scene = geometry_.get(), .crossings = &crossings};
  initialise(counting.context);
  const glm::vec3 unit = glm::normalize(direction);
  RTCRayHit ray = rayFrom(from - geometry_->origin, unit, kInfinity);
  filterHits(geometry_->countingScene(), ray, counting.context, noteAndReject);
  std::erase_if(crossings, [&](const LeafCrossing& crossing) { return crossing.leaf == own; });

  // Watertight tracing finds a line that meets a shared edge at least once, perhaps in both triangles: at the same
  // distance but for rounding, which the lift bounds.
  std::sort(crossings.begin(), crossings.end(), [](const LeafCrossing& a, const LeafCrossing& b) {
    return std::tie(a.copy, a.leaf, a.distance) < std::tie(b.copy, b.leaf, b.distance);
  });
  const auto same = [&](const LeafCrossing& a, const LeafCrossing& b) {
    return a.copy == b.copy && a.leaf == b.leaf && b.distance - a.distance <= geometry_->lift;
  };
  return static_cast<int>(std::unique(crossings.begin(), crossings.end(), same) - crossings.begin());
}

}  // namespace sunfleck
