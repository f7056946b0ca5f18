#include "field/sunlit_ends.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace sunfleck {
namespace {

constexpr std::size_t kBlock = 512;  // elements that are worth a task
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

  // The side of an element that is lit at a place, kDark if none; and the pixel that tells whether the sun comes there.
  std::uint32_t litSide(std::uint32_t element, const glm::u16vec3& code, std::uint32_t& pixel) const {
    const glm::vec3 told = first_ + per_code_ * glm::vec3(code);
    const glm::ivec2 at = glm::clamp(glm::ivec2(glm::vec2(told)), glm::ivec2(0), picture_.size - 1);
    pixel = numberOf(at);
    const bool something = !std::isinf(picture_.depth[pixel]);
    const std::uint32_t met = picture_.side[pixel];
    if (something && met / 2 == element) return met;
    const std::uint32_t side = 2 * element + (glm::dot(elements_.normal[element], along_) > 0.f ? 1 : 0);
    if (something && sameLeaf(met / 2, element)) return side;
    if (something && told.z > picture_.depth[pixel]) return kDark;
    // The pixel's middle misses the leaf.
    for (const glm::ivec2 next : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
      const glm::ivec2 beside = glm::clamp(at + next, glm::ivec2(0), picture_.size - 1);
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
    : elements_(elements), exchange_(exchange), blocks_((elements.size() + kBlock - 1) / kBlock) {
  const Lookup lookup(elements, exchange.places, rotation, lines, picture);
  // Of each crossing twice the pixel, and 1 more where the back is lit.
  std::vector<std::uint32_t> of_crossings(exchange.crossed_at.size(), kDark);
  const auto overBlocks = [&](const auto& of_element) {
    tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t block) {
      for (std::size_t i = block * kBlock; i < std::min(elements.size(), (block + 1) * kBlock); ++i)
        of_element(blocks_[block], static_cast<std::uint32_t>(i));
    });
  };
  overBlocks([&](Block& block, std::uint32_t element) {
    if (!lookup.shows(element)) return;
    for (std::uint32_t c = exchange.first_crossing[element]; c < exchange.first_crossing[element + 1]; ++c) {
      Lit lit{};
      lit.side = lookup.litSide(element, exchange.crossed_at[c], lit.pixel);
      if (lit.side == kDark) continue;
      of_crossings[c] = 2 * lit.pixel + lit.side % 2;
      block.crossings.push_back(lit);
    }
  });
  overBlocks([&](Block& block, std::uint32_t element) {
    for (std::uint32_t side = 2 * element; side < 2 * element + 2; ++side)
      for (std::uint64_t i = exchange.first[side]; i < exchange.first[side + 1]; ++i) {
        const std::uint32_t of_crossing = of_crossings[exchange.seen_at[i]], from = exchange.sees[i];
        if (of_crossing == kDark) continue;
        block.seen.push_back({from - from % 2 + of_crossing % 2, of_crossing / 2});
        block.by.push_back(side | (from % 2 == of_crossing % 2 ? 0 : kThrough));
      }
  });
}

std::vector<glm::vec3> SunlitEnds::scatteredOnce(std::span<const float> irradiance, const LitPixels& lit) const {
  const std::size_t sides = exchange_.sides();
  std::vector<std::uint32_t> crossings(sides);
  for (const Block& block : blocks_)
    for (const Lit& one : block.crossings) crossings[one.side] += lit.lit(one.pixel);
  // Where it falls it is as much as lets its lines carry away all that comes to the side.
  std::vector<float> where_lit(sides);
  std::vector<glm::vec3> brought(sides, glm::vec3(0.f));
  const auto isWood = [&](std::size_t side) { return side / 2 >= elements_.leaf_elements; };
  for (std::size_t side = 0; side < sides; ++side) {
    if (irradiance[side] == 0.f) continue;
    if (crossings[side] > 0) {
      where_lit[side] =
          irradiance[side] * static_cast<float>(exchange_.lines[side / 2]) / static_cast<float>(crossings[side]);
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
      const Lit& one = block.seen[i];
      if (!lit.lit(one.pixel)) continue;
      const bool through = (block.by[i] & kThrough) != 0, wood = isWood(one.side);
      if (wood && through) continue;
      brought[block.by[i] & ~kThrough][wood ? 2 : through ? 1 : 0] += where_lit[one.side];
    }
  return brought;
}

}  // namespace sunfleck
