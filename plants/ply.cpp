#include "plants/detail/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/shared_patches.hpp"
#include "plants/detail/triangulate.hpp"

namespace sunfleck::detail {
namespace {

using Type = PlyHeader::Type;
constexpr double kMostCorners = 1000;  // cutting a polygon's ears takes the square of it

// The values of the body, one after the other, text or binary.
class PlyValues {
 public:
  PlyValues(std::string_view text, const PlyHeader& header, const std::string& source)
      : left_(text.substr(header.body)), format_(header.format), line_(header.line), source_(source) {}

  std::size_t bytesLeft() const { return left_.size(); }

  // Smallest size of a value in the body [byte]: a digit and the blank after it, or its binary form.
  std::size_t leastSize(Type type) const { return format_ == PlyHeader::Format::ascii ? 2 : sizeOf(type); }

  double next(Type type, const std::string& element, std::size_t index) {
    return format_ == PlyHeader::Format::ascii ? nextWord(element, index) : nextBinary(type, element, index);
  }

  // "<file> line 7: vertex 3" in text; "<file>: vertex 3" in binary.
  std::string where(const std::string& element, std::size_t index) const {
    const std::string line = format_ == PlyHeader::Format::ascii ? " line " + std::to_string(line_) : "";
    return source_ + line + ": " + element + " " + std::to_string(index + 1);
  }

 private:
  [[noreturn]] void tooShort(const std::string& element, std::size_t index) const {
    throw InvalidInput(where(element, index) + ": the file ends before it is complete");
  }

  double nextWord(const std::string& element, std::size_t index) {
    while (!left_.empty() && std::strchr(" \t\r\n", left_.front()) != nullptr) {
      line_ += left_.front() == '\n';
      left_.remove_prefix(1);
    }
    if (left_.empty()) tooShort(element, index);
    std::string_view word = left_.substr(0, left_.find_first_of(" \t\r\n"));
    left_.remove_prefix(word.size());
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size())
      require(false, where(element, index), shown(word), "a number");
    return value;
  }

  template <typename Value, typename Bits>
  double decode(Bits bits) {
    if ((format_ == PlyHeader::Format::big_endian) != (std::endian::native == std::endian::big)) {
      Bits reversed = 0;
      for (std::size_t i = 0; i < sizeof(Bits); ++i)
        reversed = static_cast<Bits>(reversed | static_cast<Bits>(((bits >> (8 * i)) & 0xffu))
                                                    << (8 * (sizeof(Bits) - 1 - i)));
      bits = reversed;
    }
    return static_cast<double>(std::bit_cast<Value>(bits));
  }

  template <typename Value, typename Bits>
  double take() {
    Bits bits;
    std::memcpy(&bits, left_.data(), sizeof(Bits));
    left_.remove_prefix(sizeof(Bits));
    return decode<Value>(bits);
  }

  double nextBinary(Type type, const std::string& element, std::size_t index) {
    if (left_.size() < sizeOf(type)) tooShort(element, index);
    switch (type) {
      case Type::int8:
        return take<std::int8_t, std::uint8_t>();
      case Type::uint8:
        return take<std::uint8_t, std::uint8_t>();
      case Type::int16:
        return take<std::int16_t, std::uint16_t>();
      case Type::uint16:
        return take<std::uint16_t, std::uint16_t>();
      case Type::int32:
        return take<std::int32_t, std::uint32_t>();
      case Type::uint32:
        return take<std::uint32_t, std::uint32_t>();
      case Type::float32:
        return take<float, std::uint32_t>();
      case Type::float64:
        return take<double, std::uint64_t>();
    }
    return 0.;
  }

  std::string_view left_;
  PlyHeader::Format format_;
  std::size_t line_;
  const std::string& source_;
};

class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& source)
      : source_(source), header_(readPlyHeader(text, source)), values_(text, header_, source) {}

  TreeMesh read() {
    for (const PlyHeader::Element& element : header_.elements) {
      requireRoom(element);
      if (element.name == "vertex")
        readVertices(element);
      else if (element.name == "face")
        readFaces(element);
      else
        skip(element);
    }
    if (mesh_.leaf_triangles.empty() && mesh_.wood_triangles.empty())
      throw InvalidInput(source_ + ": has no faces, so no leaves");
    if (!texture_.empty()) addPatches();
    return std::move(mesh_);
  }

 private:
  void requireRoom(const PlyHeader::Element& element) const {
    std::size_t least = 0;
    for (const auto& property : element.properties)
      least += values_.leastSize(property.count_type.value_or(property.type));
    if (least == 0 && element.count > 0)
      throw InvalidInput(source_ + ": element " + shown(element.name) + " has no properties");
    // + 1: the last number of a text may have no blank after it.
    if (element.count > 0 && element.count > (values_.bytesLeft() + 1) / least)
      require(false, source_ + ": number of " + shown(element.name) + " elements", element.count,
              "no more than the rest of the file can hold, " + std::to_string(values_.bytesLeft()) + " bytes");
  }

  void readVertices(const PlyHeader::Element& element) {
    std::array<bool, 3> found{};
    for (const auto& property : element.properties)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (property.name == std::string(1, "xyz"[axis]) && !property.count_type) found[axis] = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      require(found[axis], source_ + ": property " + "xyz"[axis] + " of the vertices", "(missing)",
              "a number of each vertex");
    const std::array<std::size_t, 2> of_texture = textureProperties(element);
    const bool textured = of_texture[0] < element.properties.size();
    mesh_.vertices.reserve(mesh_.vertices.size() + element.count);
    if (textured) texture_.resize(mesh_.vertices.size(), glm::vec2(std::numeric_limits<float>::quiet_NaN()));
    for (std::size_t i = 0; i < element.count; ++i) {
      glm::vec3 position(0.f);
      glm::vec2 in_image(std::numeric_limits<float>::quiet_NaN());
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const auto& property = element.properties[k];
        if (property.count_type) {
          skipList(property, element.name, i);
          continue;
        }
        const double value = values_.next(property.type, element.name, i);
        for (int axis = 0; axis < 3; ++axis)
          if (property.name == std::string(1, "xyz"[axis])) {
            if (!(std::abs(value) <= double{std::numeric_limits<float>::max()}))
              require(false, values_.where(element.name, i) + " " + property.name, value, "a finite number");
            position[axis] = static_cast<float>(value);
          }
        for (int axis = 0; axis < 2; ++axis)
          if (k == of_texture[static_cast<std::size_t>(axis)] && std::abs(value) <= double{kMostImageRepeats})
            in_image[axis] = static_cast<float>(value);
      }
      mesh_.vertices.push_back(position);
      if (textured) texture_.push_back(in_image);
    }
  }

  // Those that tell where a vertex lies in its image; beyond the last where there are none.
  static std::array<std::size_t, 2> textureProperties(const PlyHeader::Element& element) {
    const auto placeOf = [&](const char* name) {
      return static_cast<std::size_t>(std::ranges::find_if(element.properties,
                                                           [&](const PlyHeader::Property& property) {
                                                             return property.name == name && !property.count_type;
                                                           }) -
                                      element.properties.begin());
    };
    constexpr std::array<std::array<const char*, 2>, 3> kNames{{{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
    for (const auto& [first, second] : kNames) {
      const std::array<std::size_t, 2> found{placeOf(first), placeOf(second)};
      if (std::max(found[0], found[1]) < element.properties.size()) return found;
    }
    return {element.properties.size(), element.properties.size()};
  }

  void addPatches() {
    texture_.resize(mesh_.vertices.size(), glm::vec2(std::numeric_limits<float>::quiet_NaN()));
    while (mesh_.patch_of_triangle.size() < mesh_.leaf_triangles.size()) {
      const glm::uvec3& t = mesh_.leaf_triangles[mesh_.patch_of_triangle.size()];
      const ImageCorners corners{texture_[t.x], texture_[t.y], texture_[t.z]};
      mesh_.patch_of_triangle.push_back(isUsable(corners) ? patches_.numberOf({.corners = corners})
                                                          : TreeMesh::kNoPatch);
    }
  }

  static bool isCorners(const PlyHeader::Property& property) {
    return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  void readFaces(const PlyHeader::Element& element) {
    if (std::count_if(element.properties.begin(), element.properties.end(), isCorners) != 1)
      throw InvalidInput(source_ + ": the faces of a PLY need one list property vertex_indices");
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < element.count; ++i) {
      bool wood = false;
      for (const auto& property : element.properties) {
        if (isCorners(property)) {
          readCorners(property, i, corners);
        } else if (property.count_type) {
          skipList(property, element.name, i);
        } else {
          const double value = values_.next(property.type, element.name, i);
          wood = wood || (property.name == "wood" && value != 0.);
        }
      }
      triangulate(mesh_.vertices, corners, wood ? mesh_.wood_triangles : mesh_.leaf_triangles);
    }
  }

  void readCorners(const PlyHeader::Property& property, std::size_t face, std::vector<std::uint32_t>& corners) {
    const double count = values_.next(*property.count_type, "face", face);
    if (!(count >= 3. && count <= kMostCorners && count == std::floor(count)))
      require(false, values_.where("face", face) + " number of corners", count, "from 3 to 1000");
    corners.clear();
    for (int corner = 0; corner < static_cast<int>(count); ++corner) {
      const double index = values_.next(property.type, "face", face);
      if (!(index >= 0. && index < static_cast<double>(mesh_.vertices.size()) && index == std::floor(index)))
        require(false, values_.where("face", face) + " vertex index", index,
                "a whole number below the number of vertices before it, " + std::to_string(mesh_.vertices.size()));
      corners.push_back(static_cast<std::uint32_t>(index));
    }
  }

  void skipList(const PlyHeader::Property& property, const std::string& element, std::size_t index) {
    const double count = values_.next(*property.count_type, element, index);
    if (!(count >= 0. && count == std::floor(count)))
      require(false, values_.where(element, index) + " length of list", count, "a whole number, 0 or more");
    for (double i = 0.; i < count; ++i) values_.next(property.type, element, index);
  }

  void skip(const PlyHeader::Element& element) {
    for (std::size_t i = 0; i < element.count; ++i)
      for (const auto& property : element.properties) {
        if (property.count_type)
          skipList(property, element.name, i);
        else
          values_.next(property.type, element.name, i);
      }
  }

  const std::string& source_;
  PlyHeader header_;
  PlyValues values_;
  TreeMesh mesh_;
  std::vector<glm::vec2> texture_;  // of each vertex, in its image; empty where none has any
  SharedPatches patches_{mesh_.patches};
};

}  // namespace

TreeMesh readPly(std::string_view text, const std::string& source) {
  return PlyReader(text, source).read();
}

}  // namespace sunfleck::detail
