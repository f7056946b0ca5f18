#include "plants/detail/gltf_parse.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

// Of the JSON. A node of three bytes there takes half a kilobyte in memory.
constexpr int kDeepest = 64;
constexpr std::size_t kMostObjects = 200'000, kMostValues = 3'000'000;

// Values within values are read by recursion.
void checkJson(std::string_view text, const std::string& source) {
  int depth = 0;
  bool quoted = false;
  std::size_t objects = 0, values = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest) require(false, source + ": depth of its JSON", depth, "at most 64");
      objects += c == '{';
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',') {
      ++values;
    }
  }
  require(objects <= kMostObjects, source + ": number of objects in its JSON", objects, "at most 200000");
  require(values <= kMostValues, source + ": number of values in its JSON", values, "at most 3000000");
}

// Goes through the JSON for what the library would take in silence: values of another type where numbers must be, which
// count as absent to it. What is not glTF's own, below "extras", may be anything.
class NumberCheck : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit NumberCheck(const std::string& source) : source_(source) {}

  bool null() override { return other("null"); }
  bool boolean(bool value) override { return other(value ? "true" : "false"); }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string& value) override { return other('"' + shown(value) + '"'); }
  bool binary(nlohmann::json::binary_t&) override { return true; }
  bool start_object(std::size_t) override {
    other("{ ... }");
    return start(false);
  }
  bool key(std::string& name) override {
    key_ = name;
    return true;
  }
  bool end_object() override { return end(); }
  bool start_array(std::size_t) override { return start(true); }
  bool end_array() override { return end(); }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception&) override {
    require(false, source_ + ": first byte of its JSON that is out of place", position, "none: it is not glTF");
    return false;
  }

 private:
  struct Level {
    std::string key;
    bool is_array, is_free;
  };

  const std::string& name() const { return !levels_.empty() && levels_.back().is_array ? levels_.back().key : key_; }
  bool isFree() const { return !levels_.empty() && levels_.back().is_free; }

  bool other(const std::string& value) const {
    constexpr std::array numbers{"scale",
                                 "translation",
                                 "rotation",
                                 "matrix",
                                 "baseColorFactor",
                                 "alphaCutoff",
                                 "diffuseTransmissionFactor",
                                 "diffuseTransmissionColorFactor"};
    if (!isFree() && std::ranges::find(numbers, name()) != numbers.end())
      require(false, source_ + ": " + name(), value, "of numbers");
    return true;
  }
  bool start(bool is_array) {
    const bool is_free = isFree() || name() == "extras";
    levels_.push_back({is_array ? name() : "", is_array, is_free});
    key_.clear();
    return true;
  }
  bool end() {
    levels_.pop_back();
    key_.clear();
    return true;
  }

  const std::string& source_;
  std::vector<Level> levels_;
  std::string key_;
};

// Of the files beside a .gltf, images are read when they are asked for.
bool isBuffer(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array images{".png", ".jpg", ".jpeg", ".webp", ".ktx2", ".dds", ".tga", ".bmp"};
  std::error_code failure;
  return std::ranges::find(images, extension) == images.end() && std::filesystem::exists(file, failure);
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

}  // namespace

tinygltf::Model parseGltf(const std::filesystem::path& path, const std::string& bytes, const std::string& source) {
  const bool binary = bytes.starts_with("glTF");
  const std::string_view json = binary ? jsonOf(bytes, source) : std::string_view(bytes);
  checkJson(json, source);
  NumberCheck numbers(source);
  nlohmann::json::sax_parse(json, &numbers);
  require(bytes.size() < (std::size_t{1} << 31), source + ": size [byte]", bytes.size(), "below 2147483648");
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(
      [](tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* data, int size,
         void*) {
        if (image->bufferView < 0) image->image.assign(data, data + size);
        return true;
      },
      nullptr);
  loader.SetFsCallbacks({.FileExists = [](const std::string& file, void*) { return isBuffer(file); },
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
  bool done = false;
  try {
    done = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                                reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                  : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
  } catch (const InvalidInput&) {
    throw;
  } catch (const std::exception&) {  // of the JSON library
    throw InvalidInput(source + ": has a value of another type than glTF's: must be glTF 2.0");
  }
  if (!done) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw InvalidInput(source + ": cannot be read as glTF: " + shown(error));
  }
  require(model.asset.version.starts_with("2."), source + ": asset's version", shown(model.asset.version), "2.0");
  return model;
}

}  // namespace sunfleck::detail
