#include "pp_solver/slab_table_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "pp_solver/detail/slab_table_data.hpp"

namespace sunfleck::pp {
namespace {

namespace fs = std::filesystem;
using detail::FirstScattering;
using detail::SlabTableData;

static_assert(std::endian::native == std::endian::little && sizeof(float) == 4);

constexpr std::string_view kMagic = "SUNFSLAB";
constexpr std::uint32_t kVersion = 1, kByteOrder = 0x01020304;
constexpr std::size_t kHeader = 24, kSeal = 4;                   // [byte]
constexpr std::size_t kFixed = 4 + 8 + 4 + 16 + 4 + 4 + 40 + 4;  // of the body, without the text and the values
constexpr std::uintmax_t kLongest = std::uintmax_t{5} << 30;
constexpr std::size_t kLongestText = 1000;
constexpr float kLargest = 1e12f;  // no radiance of a beam of irradiance 1 comes near it

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <typename Value>
void put(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& bytes, const std::vector<float>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

// The bytes of one file, taken from the front.
class Reader {
 public:
  Reader(const fs::path& path, std::string_view bytes) : path_(path), rest_(bytes) {}

  [[noreturn]] void fail(const std::string& why) const { throw InvalidInput(path_.string() + ": " + why); }

  template <typename Value>
  Value take() {
    Value value;
    need(sizeof value);
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  std::string takeText(std::size_t length) {
    need(length);
    const std::string text(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return text;
  }
  std::vector<float> takeValues(std::size_t count, const char* what) {
    need(count * sizeof(float));
    std::vector<float> values(count);
    if (count > 0) std::memcpy(values.data(), rest_.data(), count * sizeof(float));
    rest_.remove_prefix(count * sizeof(float));
    for (const float value : values) check(std::abs(value) <= kLargest, what, value, "finite and at most 1e12 in size");
    return values;
  }
  std::size_t left() const { return rest_.size(); }

  template <typename Value>
  void check(bool ok, const char* what, Value value, const char* rule) const {
    if (!ok) require(false, path_.string() + ": " + what, value, rule);
  }

 private:
  void need(std::size_t count) const {
    if (rest_.size() < count) fail("is damaged: it ends before its contents do");
  }

  const fs::path& path_;
  std::string_view rest_;
};

// The file's bytes without header and checksum, once those are found right.
std::string checkedBody(const fs::path& path) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure))
    throw InvalidInput(path.string() + ": cannot be read: it is no regular file");
  const std::uintmax_t size = fs::file_size(path, failure);
  std::ifstream in(path, std::ios::binary);
  if (failure || !in) throw InvalidInput(path.string() + ": cannot be read");

  std::string header(kHeader, '\0');
  in.read(header.data(), kHeader);
  header.resize(static_cast<std::size_t>(in.gcount()));
  Reader reader(path, header);
  if (!header.starts_with(kMagic)) reader.fail("is no table of slabs: it does not begin with SUNFSLAB");
  if (header.size() < kHeader) reader.fail("is cut short: it ends within its header");
  reader.takeText(kMagic.size());
  const auto version = reader.take<std::uint32_t>();
  reader.check(version == kVersion, "version", version, "1");
  const auto order = reader.take<std::uint32_t>();
  reader.check(order == kByteOrder, "byte order", order, "16909060, that of little-endian machines");
  const auto length = reader.take<std::uint64_t>();
  if (length != size)
    reader.fail("is " + std::string(size < length ? "cut short" : "damaged") + ": it holds " + std::to_string(size) +
                " bytes, and says that it has " + std::to_string(length));
  reader.check(size >= kHeader + kFixed + kSeal && size <= kLongest, "length", size, "that of a table, up to 5 GiB");

  std::string body(static_cast<std::size_t>(size) - kHeader, '\0');
  in.read(body.data(), static_cast<std::streamsize>(body.size()));
  if (static_cast<std::size_t>(in.gcount()) != body.size()) reader.fail("is cut short, or cannot be read");
  std::uint32_t seal;
  std::memcpy(&seal, body.data() + body.size() - kSeal, kSeal);
  body.resize(body.size() - kSeal);
  uLong found = crc32_z(0, reinterpret_cast<const Bytef*>(header.data()), header.size());
  found = crc32_z(found, reinterpret_cast<const Bytef*>(body.data()), body.size());
  if (found != seal) reader.fail("is damaged: its bytes do not match its checksum");
  return body;
}

bool inUnit(double v) {
  return v >= 0. && v <= 1.;
}

}  // namespace

void writeSlabTable(const fs::path& path, const SlabTable& table) {
  const SlabTableData& data = table.data();
  std::string bytes(kMagic);
  put(bytes, kVersion);
  put(bytes, kByteOrder);
  put(bytes, std::uint64_t{0});
  put(bytes, static_cast<std::int32_t>(data.first.kind));
  put(bytes, data.first.albedo);
  put(bytes, data.first.asymmetry);
  put(bytes, static_cast<std::int32_t>(data.streams));
  for (const int count : data.nodes) put(bytes, static_cast<std::int32_t>(count));
  put(bytes, static_cast<std::int32_t>(data.modes));
  put(bytes, static_cast<std::int32_t>(data.errors.places));
  for (const double value : {data.max_thickness, data.errors.radiance_max, data.errors.power_max,
                             data.errors.radiance_rms, data.errors.power_rms})
    put(bytes, value);
  put(bytes, static_cast<std::uint32_t>(data.about.size()));
  bytes += data.about;
  for (const auto* values : {&data.first.phase, &data.first.kernel, &data.first.projection, &data.power, &data.source})
    put(bytes, *values);
  const std::uint64_t length = bytes.size() + kSeal;
  std::memcpy(bytes.data() + kHeader - sizeof length, &length, sizeof length);
  put(bytes, checksum(bytes));
  writeWhole(path, bytes);
}

SlabTable readSlabTable(const fs::path& path) {
  const std::string body = checkedBody(path);
  Reader reader(path, body);
  auto data = std::make_shared<SlabTableData>();
  FirstScattering& first = data->first;
  const auto kind = reader.take<std::int32_t>();
  reader.check(kind >= 0 && kind <= 2, "kind of medium", kind, "0, 1 or 2");
  first.kind = static_cast<FirstScattering::Kind>(kind);
  first.albedo = reader.take<float>();
  reader.check(inUnit(first.albedo), "albedo", first.albedo, "in [0, 1]");
  first.asymmetry = reader.take<float>();
  reader.check(std::abs(first.asymmetry) < 1.f, "g", first.asymmetry, "in (-1, 1)");
  data->streams = reader.take<std::int32_t>();
  reader.check(data->streams >= 2 && data->streams <= 256, "streams", data->streams, "2 to 256");
  for (int& count : data->nodes) {
    count = reader.take<std::int32_t>();
    reader.check(count >= SlabTableData::kFewestNodes && count <= SlabTableData::kMostNodes, "nodes of an axis", count,
                 "5 to 512");
  }
  data->modes = reader.take<std::int32_t>();
  reader.check(data->modes >= 1 && data->modes <= SlabTableData::kMostModes, "azimuth modes", data->modes, "1 to 32");
  data->errors.places = reader.take<std::int32_t>();
  reader.check(data->errors.places >= 0, "places", data->errors.places, "no less than 0");
  data->max_thickness = reader.take<double>();
  reader.check(data->max_thickness >= 0.01 && data->max_thickness <= 1000., "max_thickness", data->max_thickness,
               "in [0.01, 1000]");
  for (double* error :
       {&data->errors.radiance_max, &data->errors.power_max, &data->errors.radiance_rms, &data->errors.power_rms}) {
    *error = reader.take<double>();
    reader.check(std::isfinite(*error) && *error >= 0., "error", *error, "finite and no less than 0");
  }
  const auto text = reader.take<std::uint32_t>();
  reader.check(text <= kLongestText, "length of the description", text, "at most 1000");
  data->about = reader.takeText(text);
  if (!std::all_of(data->about.begin(), data->about.end(), [](char c) { return c >= ' ' && c <= '~'; }))
    reader.fail("is damaged: its description is not printable");

  using Kind = FirstScattering::Kind;
  constexpr std::size_t directions = FirstScattering::kDirections + 2;
  const std::size_t phase = first.kind == Kind::angle ? FirstScattering::kAngles + 2 : 0;
  const std::size_t kernel = first.kind == Kind::leaves ? 2 * directions * directions * FirstScattering::kModes : 0;
  const std::size_t projection = first.kind == Kind::leaves ? FirstScattering::kProjections + 2 : 0;
  const std::size_t values = phase + kernel + projection + data->powerSize() + data->sourceSize();
  if (reader.left() != values * sizeof(float))
    reader.fail("is damaged: its sizes ask for " + std::to_string(values * sizeof(float)) + " bytes of values, and " +
                std::to_string(reader.left()) + " are there");
  first.phase = reader.takeValues(phase, "value of the phase function");
  first.kernel = reader.takeValues(kernel, "value of the leaves' scattering");
  first.projection = reader.takeValues(projection, "value of the leaves' projection");
  data->power = reader.takeValues(data->powerSize(), "value of the powers");
  data->source = reader.takeValues(data->sourceSize(), "value of the radiance");
  return SlabTable(std::move(data));
}

}  // namespace sunfleck::pp
