#include "field/sunlit_ends.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace sunfleck {
namespace {

constexpr std::size_t kBlock = 1024;  // sides that are worth a task
constexpr std::uint32_t kDark = ~0u;

// A picture of a tree that is turned, in which places on the tree are looked up that is not.
class Lookup {
 public:
  Lookup(const FieldElements& elements, const PlaceCode& places, float rotation, const SunLines& lines,
         const TreePicture& picture)
      : elements_(elements), picture_(picture), shown_(elements.size()) {
    const double cosine = std::cos(double{rotation}), sine = std::sin(double{rotation});
    const auto back = [&](const glm::dvec3& v) {
      return glm::dvec3(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x, v.z);
    };
    along_ = back(glm::dvec3(lines.along));
    // Codes are even steps along each axis, so that what is told of them is too.
    const auto told = [&](const glm::u16vec3& code) {
      const glm::dvec3 place(places.place(code));
      return glm::dvec3(glm::dot(place, back(lines.right)) - picture.low.x,
                        glm::dot(place, back(lines.up)) - picture.low.y, glm::dot(place, back(lines.depth)));
    };
    constexpr std::uint16_t kFar = 1u << 15;
    const glm::dvec3 first = told({0, 0, 0});
    first_ = first;
    for (int axis = 0; axis < 3; ++axis) {
      glm::u16vec3 code(0);
      code[axis] = kFar;
      per_code_[axis] = (told(code) - first) / double{kFar};
    }
    for (std::size_t pixel = 0; pixel < picture.side.size(); ++pixel)
      if (!std::isinf(picture.depth[pixel])) shown_[picture.side[pixel] / 2] = true;
  }

  bool shows(std::uint32_t element) const { return shown_[element]; }

  // A place on an element and where it lies in the picture.
  struct Place {
    std::uint32_t from;  // the side that is seen there
    glm::ivec2 at;       // pixel
    float depth;         // [m]
  };
  // Calls for the pixel, which lies anywhere in memory.
  Place placeAt(std::uint32_t from, const glm::u16vec3& code) const {
    const glm::vec3 told = first_ + per_code_ * glm::vec3(code);
    const Place place{from, glm::clamp(glm::ivec2(glm::vec2(told)), glm::ivec2(0), picture_.size - 1), told.z};
    __builtin_prefetch(&picture_.side[numberOf(place.at)]);
    __builtin_prefetch(&picture_.depth[numberOf(place.at)]);
    return place;
  }

  // The side of the element that is lit at a place, kDark if none; and the pixel that tells whether the sun comes
  // there.
  std::uint32_t litSide(const Place& place, std::uint32_t& pixel) const {
    const std::uint32_t element = place.from / 2;
    pixel = numberOf(place.at);
    const bool something = !std::isinf(picture_.depth[pixel]);
    const std::uint32_t met = picture_.side[pixel];
    if (something && met / 2 == element) return met;
    const std::uint32_t side = 2 * element + (glm::dot(elements_.normal[element], along_) > 0.f ? 1 : 0);
    if (something && sameLeaf(met / 2, element)) return side;
    if (something && place.depth > picture_.depth[pixel]) return kDark;
    // The pixel's middle misses the leaf.
    for (const glm::ivec2 next : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
      const glm::ivec2 beside = glm::clamp(place.at + next, glm::ivec2(0), picture_.size - 1);
      const std::uint32_t number = numberOf(beside), other = picture_.side[number] / 2;
      if (std::isinf(picture_.depth[number]) || !(other == element || sameLeaf(other, element))) continue;
      pixel = number;
      return side;
    }
    return something ? side : kDark;
  }

 private:
  std::uint32_t numberOf(const glm::ivec2& pixel) const {
    return static_cast<std::uint32_t>(pixel.y) * static_cast<std::uint32_t>(picture_.size.x) +
           static_cast<std::uint32_t>(pixel.x);
  }
  bool sameLeaf(std::uint32_t a, std::uint32_t b) const {
    return elements_.leaf[a] == elements_.leaf[b] && elements_.leaf[a] != FieldElements::kWood;
  }

  const FieldElements& elements_;
  const TreePicture& picture_;
  Direction along_{};
  // Column and row of the pixel, and depth [m], of a place by its code: the first, and per code of each axis.
  glm::vec3 first_{};
  glm::mat3 per_code_{};
  std::vector<char> shown_;  // whether the picture shows each element
};

}  // namespace

// (F6)
SunlitEnds::SunlitEnds(const FieldElements& elements, const LineExchange& exchange, float rotation,
                       const SunLines& lines, const TreePicture& picture)
    : elements_(elements), exchange_(exchange), blocks_((exchange.sides() + kBlock - 1) / kBlock) {
  const Lookup lookup(elements, exchange.places, rotation, lines, picture);
  tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t number) {
    Block& block = blocks_[number];
    std::vector<Lookup::Place> places;
    // Calls found(one, from) for each end that is lit of those that were put into `places`.
    const auto look = [&](std::vector<End>& ends, const auto& found) {
      for (const Lookup::Place& place : places) {
        End one{};
        one.side = lookup.litSide(place, one.pixel);
        if (one.side == kDark) continue;
        ends.push_back(one);
        found(one.side != place.from);
      }
      places.clear();
    };
    const std::size_t end = std::min(exchange.sides(), (number + 1) * kBlock);
    for (std::size_t side = number * kBlock; side < end; ++side) {
      for (std::uint64_t i = exchange.first[side]; i < exchange.first[side + 1]; ++i)
        if (lookup.shows(exchange.sees[i] / 2))
          places.push_back(lookup.placeAt(exchange.sees[i], exchange.crossed_at[exchange.seen_at[i]]));
      look(block.seen,
           [&](bool through) { block.by.push_back(static_cast<std::uint32_t>(side) | (through ? kThrough : 0)); });
      const auto from = static_cast<std::uint32_t>(side);
      for (std::uint64_t i = exchange.first_outside[side]; i < exchange.first_outside[side + 1]; ++i)
        if (lookup.shows(from / 2)) places.push_back(lookup.placeAt(from, exchange.crossed_at[exchange.open_at[i]]));
      look(block.open, [](bool) {});
    }
  });
}

std::vector<glm::vec3> SunlitEnds::scatteredOnce(std::span<const float> irradiance, const LitPixels& lit) const {
  const std::size_t sides = exchange_.sides();
  std::vector<std::uint32_t> ends(sides);
  for (const Block& block : blocks_)
    for (const std::vector<End>* of_block : {&block.seen, &block.open})
      for (const End& one : *of_block) ends[one.side] += lit.lit(one.pixel);
  // Where it falls it is as much as lets its lines carry away all that comes to the side.
  std::vector<float> where_lit(sides);
  std::vector<glm::vec3> brought(sides, glm::vec3(0.f));
  const auto isWood = [&](std::size_t side) { return side / 2 >= elements_.leaf_elements; };
  for (std::size_t side = 0; side < sides; ++side) {
    if (irradiance[side] == 0.f) continue;
    if (ends[side] > 0) {
      where_lit[side] =
          irradiance[side] * 2.f * static_cast<float>(exchange_.lines[side / 2]) / static_cast<float>(ends[side]);
      continue;
    }
    // No line ends where it falls: it is spread over the side. Who sees a side is seen by it.
    for (std::uint64_t i = exchange_.first[side]; i < exchange_.first[side + 1]; ++i)
      brought[exchange_.sees[i]][isWood(side) ? 2 : 0] += irradiance[side];
    for (std::uint64_t i = exchange_.first[side ^ 1]; i < exchange_.first[(side ^ 1) + 1] && !isWood(side); ++i)
      brought[exchange_.sees[i]].y += irradiance[side];
  }
  for (const Block& block : blocks_)
    for (std::size_t i = 0; i < block.seen.size(); ++i) {
      const End& one = block.seen[i];
      if (!lit.lit(one.pixel)) continue;
      const bool through = (block.by[i] & kThrough) != 0, wood = isWood(one.side);
      if (wood && through) continue;
      brought[block.by[i] & ~kThrough][wood ? 2 : through ? 1 : 0] += where_lit[one.side];
    }
  return brought;
}

}  // namespace sunfleck
