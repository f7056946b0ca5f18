#include "grid/detail/vdb_layout.hpp"

#include <openvdb/io/Compression.h>
#include <openvdb/openvdb.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "core/require.hpp"

namespace sunfleck {
namespace {

static_assert(std::endian::native == std::endian::little, "the .vdb format is that of little-endian machines");

constexpr std::uint64_t kMagic = 0x56444220;  // "VDB " in 8 bytes
constexpr std::uint32_t kOldest = 222, kNewest = 224;
constexpr std::size_t kUuid = 36;  // [byte]
enum Compression : std::uint32_t { kZip = 1, kActiveMask = 2, kBlosc = 4, kAllFlags = 7 };

[[noreturn]] void corrupt(std::size_t at, const std::string& why) {
  throw InvalidInput("is cut short or corrupt: " + why + " at byte " + std::to_string(at));
}

// Reads on through the bytes and never past their end.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}

  std::size_t at() const { return at_; }

  std::string_view take(std::uint64_t size, const char* what) {
    if (size > bytes_.size() - at_) corrupt(at_, std::string(what) + " past the end of the file");
    const std::string_view taken = bytes_.substr(at_, size);
    at_ += size;
    return taken;
  }
  template <typename T>
  T number(const char* what) {
    T value;
    std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
    return value;
  }
  std::string_view text(const char* what) { return take(number<std::uint32_t>(what), what); }

 private:
  std::string_view bytes_;
  std::size_t at_;
};

// Skips named values; tells whether one asks for 16-bit floats.
bool skipMetadata(Cursor& in) {
  bool half = false;
  for (auto count = in.number<std::uint32_t>("metadata"); count > 0; --count) {
    const std::string_view name = in.text("metadata name");
    const std::string_view type = in.text("metadata type");
    const std::string_view value = in.text("metadata value");
    if (name == "is_saved_as_half_float" && type == "bool" && value.size() == 1 && value[0] != 0) half = true;
  }
  return half;
}

void readTransform(Cursor& in, VdbFloatGrid& grid) {
  const std::string_view type = in.text("transform");
  const auto vector = [&] {
    glm::dvec3 v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = in.number<double>("transform");
    return v;
  };
  constexpr std::size_t derived = 4 * 3 * sizeof(double);  // four vectors that follow from the scale
  if (type == "TranslationMap") {
    grid.translation = vector();
  } else if (type == "UniformScaleMap" || type == "ScaleMap") {
    grid.scale = vector();
    in.take(derived, "transform");
  } else if (type == "UniformScaleTranslateMap" || type == "ScaleTranslateMap") {
    grid.translation = vector();
    grid.scale = vector();
    in.take(derived, "transform");
  } else if (type == "AffineMap") {
    std::array<std::array<double, 4>, 4> m;  // rows; points are rows and multiply from the left
    for (auto& row : m)
      for (double& entry : row) entry = in.number<double>("transform");
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 4; ++column)
        if (row != column && m[row][column] != 0.) throw InvalidInput("has a grid that is turned or sheared");
    grid.scale = {m[0][0], m[1][1], m[2][2]};
    grid.translation = {m[3][0], m[3][1], m[3][2]};
  } else {
    throw InvalidInput("has a grid whose transform is not a scale and a translation");
  }
}

// Walks OpenVDB's tree of 32^3 nodes of 16^3 nodes of blocks of 8^3 values.
class TreeWalk {
 public:
  TreeWalk(Cursor& in, VdbFloatGrid& grid) : in_(in), grid_(grid) {}

  void topology() {
    if (const auto buffers = in_.number<std::int32_t>("tree"); buffers != 1) corrupt(in_.at(), "number of buffers");
    in_.take(sizeof(float), "background");
    const auto tiles = in_.number<std::uint32_t>("number of tiles");
    const auto children = in_.number<std::uint32_t>("number of nodes");
    std::set<std::array<std::int32_t, 3>> origins;
    const auto origin = [&] {
      const auto at = in_.number<std::array<std::int32_t, 3>>("origin of a node");
      for (std::int32_t x : at)
        if (x % kRootSide != 0) corrupt(in_.at(), "origin of a node");
      if (!origins.insert(at).second) corrupt(in_.at(), "origin of a node given twice");
    };
    for (std::uint32_t i = 0; i < tiles; ++i) {
      origin();
      grid_.memory += kRootEntry;
      in_.take(sizeof(float), "tile");
      if (in_.number<std::uint8_t>("tile") > 1) corrupt(in_.at(), "tile");
    }
    for (std::uint32_t i = 0; i < children; ++i) {
      origin();
      grid_.memory += kRootEntry;
      node<32>();
    }
  }

  // The values of the blocks that the topology named.
  void values() {
    for (; blocks_ > 0; --blocks_) compressedValues(mask(512), 512);
  }

 private:
  using Block = openvdb::FloatTree::LeafNodeType;
  template <std::size_t Side>
  using Node = std::conditional_t<Side == 32, openvdb::FloatTree::RootNodeType::ChildNodeType,
                                  openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType>;
  static constexpr std::int32_t kRootSide = 32 * 16 * 8;
  static constexpr double kRootEntry = 96.;  // a node of a std::map [byte]

  std::string_view mask(std::size_t bits) { return in_.take(bits / 8, "mask"); }

  static std::size_t countOn(std::string_view mask) {
    std::size_t on = 0;
    for (char byte : mask) on += static_cast<std::size_t>(std::popcount(static_cast<unsigned char>(byte)));
    return on;
  }

  template <std::size_t Side>
  void node() {
    constexpr std::size_t size = Side * Side * Side;
    grid_.memory += static_cast<double>(sizeof(Node<Side>));
    const std::string_view child_mask = mask(size);
    const std::string_view value_mask = mask(size);
    for (std::size_t i = 0; i < child_mask.size(); ++i)
      if ((child_mask[i] & value_mask[i]) != 0) corrupt(in_.at(), "mask");
    compressedValues(value_mask, size);
    for (std::size_t child = countOn(child_mask); child > 0; --child)
      if constexpr (Side == 32) {
        node<16>();
      } else {
        mask(512);
        grid_.memory += static_cast<double>(sizeof(Block) + Block::SIZE * sizeof(float));
        ++blocks_;
      }
  }

  void compressedValues(std::string_view value_mask, std::size_t size) {
    // How inactive values are told: 0 .. 6 as OpenVDB numbers them.
    const auto kind = in_.number<std::uint8_t>("values");
    if (kind > 6) corrupt(in_.at(), "kind of values");
    constexpr std::array<std::size_t, 7> inactive_values = {0, 0, 1, 0, 1, 2, 0};
    in_.take(inactive_values[kind] * sizeof(float), "values");
    if (kind >= 3 && kind <= 5) mask(size);
    const bool only_active = (grid_.compression & kActiveMask) != 0 && kind != 6;
    chunk(only_active ? countOn(value_mask) : size);
  }

  void chunk(std::size_t count) {
    const std::size_t size = count * (grid_.half ? 2 : sizeof(float));
    if (grid_.half && count == 0) return;
    if ((grid_.compression & (kZip | kBlosc)) == 0) {
      in_.take(size, "values");
      return;
    }
    const auto packed = in_.number<std::int64_t>("size of values");
    if (packed <= 0) {  // not compressed
      if (std::uint64_t{0} - static_cast<std::uint64_t>(packed) != size) corrupt(in_.at(), "size of values");
      in_.take(size, "values");
      return;
    }
    const std::size_t start = in_.at();
    const std::string_view content = in_.take(static_cast<std::uint64_t>(packed), "values");
    unpacked_.resize(size + 1);  // never without memory
    if ((grid_.compression & kBlosc) != 0 ? !unpackBlosc(content, size) : !unpackZip(content, size))
      corrupt(start, "compressed values");
  }

  // OpenVDB does not heed zip's checksum, and leaks what it has read when a node cannot be unpacked: it is tried here.
  bool unpackZip(std::string_view content, std::size_t size) {
    uLongf unpacked = size;
    return uncompress(reinterpret_cast<Bytef*>(unpacked_.data()), &unpacked,
                      reinterpret_cast<const Bytef*>(content.data()), content.size()) == Z_OK &&
           unpacked == size;
  }

  // Blosc's header: versions and flags, then the sizes unpacked, of a block, and packed. OpenVDB does not tell Blosc
  // how many bytes there are.
  bool unpackBlosc(std::string_view content, std::size_t size) {
    Cursor header(content);
    header.take(4, "values");
    const auto unpacked = header.number<std::uint32_t>("values");
    header.take(4, "values");
    const auto packed = header.number<std::uint32_t>("values");
    if (unpacked != size || packed != content.size()) return false;
    const auto length = static_cast<std::int64_t>(content.size());
    std::string chunk(reinterpret_cast<const char*>(&length), sizeof length);
    std::istringstream in(chunk.append(content));
    try {
      openvdb::io::bloscFromStream(in, unpacked_.data(), size);
    } catch (const openvdb::Exception&) {
      return false;
    }
    return true;
  }

  Cursor& in_;
  VdbFloatGrid& grid_;
  std::size_t blocks_ = 0;
  std::vector<char> unpacked_;
};

struct Descriptor {
  std::string_view type, parent;
  std::uint64_t grid, values, end;  // [byte]
};

// The file's header, and the descriptor of the grid called `name` if there is one. Those of grids lie between the
// grids.
std::optional<Descriptor> findDescriptor(std::string_view bytes, std::string_view name, VdbFloatGrid& grid) {
  Cursor in(bytes);
  if (bytes.size() < sizeof kMagic || in.number<std::uint64_t>("") != kMagic) throw InvalidInput("is not a .vdb file");
  grid.file_version = in.number<std::uint32_t>("version");
  if (grid.file_version < kOldest || grid.file_version > kNewest)
    throw InvalidInput("has version " + std::to_string(grid.file_version) + " of the .vdb format: must be 222 to 224");
  grid.library_major = in.number<std::uint32_t>("version");
  grid.library_minor = in.number<std::uint32_t>("version");
  if (in.number<std::uint8_t>("header") != 1)
    throw InvalidInput("was written as a stream, without the places of its grids");
  in.take(kUuid, "header");
  skipMetadata(in);

  std::optional<Descriptor> found;
  const auto grids = in.number<std::int32_t>("number of grids");
  if (grids < 0) corrupt(in.at(), "number of grids");
  for (std::int32_t i = 0; i < grids; ++i) {
    std::string_view unique = in.text("grid name");
    unique = unique.substr(0, unique.find('\x1e'));  // OpenVDB tells grids of one name apart by a number after this
    Descriptor descriptor;
    descriptor.type = in.text("grid type");
    descriptor.parent = in.text("grid");
    descriptor.grid = in.number<std::uint64_t>("grid");
    descriptor.values = in.number<std::uint64_t>("grid");
    descriptor.end = in.number<std::uint64_t>("grid");
    if (descriptor.grid < in.at() || descriptor.values < descriptor.grid || descriptor.end < descriptor.values ||
        descriptor.end > bytes.size())
      corrupt(in.at(), "place of a grid");
    if (unique == name) {
      if (found) throw InvalidInput("holds more than one grid named \"" + std::string(name) + "\"");
      found = descriptor;
    }
    in = Cursor(bytes, descriptor.end);
  }
  return found;
}

}  // namespace

std::optional<VdbFloatGrid> findFloatGrid(std::string_view bytes, std::string_view name) {
  VdbFloatGrid grid;
  const std::optional<Descriptor> found = findDescriptor(bytes, name, grid);
  if (!found) return {};
  const Descriptor& descriptor = *found;
  constexpr std::string_view type = "Tree_float_5_4_3", half = "_HalfFloat";
  if (!descriptor.type.starts_with(type) ||
      (descriptor.type.size() > type.size() && descriptor.type.substr(type.size()) != half))
    throw InvalidInput("holds a grid \"" + std::string(name) + "\" that is not of floats");
  if (!descriptor.parent.empty())
    throw InvalidInput("holds a grid \"" + std::string(name) + "\" that shares the values of another");

  Cursor in(bytes.substr(0, descriptor.end), descriptor.grid);
  grid.compression = in.number<std::uint32_t>("compression");
  if ((grid.compression & ~std::uint32_t{kAllFlags}) != 0) corrupt(in.at(), "compression");
  grid.half = skipMetadata(in) || descriptor.type.size() > type.size();
  readTransform(in, grid);
  grid.topology = in.at();
  TreeWalk walk(in, grid);
  walk.topology();
  grid.values = in.at();
  if (grid.values != descriptor.values) corrupt(in.at(), "place of the values");
  walk.values();
  if (in.at() != descriptor.end) corrupt(in.at(), "end of the grid");
  return grid;
}

}  // namespace sunfleck
