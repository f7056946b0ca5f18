#include "plants/detail/gltf_materials.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/require.hpp"
#include "plants/detail/input_file.hpp"

namespace sunfleck::detail {
namespace {

// "my%20leaf.png" is "my leaf.png".
std::string decoded(const std::string& uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool coded = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    text += coded ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
    if (coded) i += 2;
  }
  return text;
}

// Image files tell their format by their first bytes, readers of images by the name.
std::string nameFor(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return "image.png";
  return bytes.starts_with("\xff\xd8") ? "image.jpg" : "";
}

class MaterialReader {
 public:
  MaterialReader(const tinygltf::Model& model, const std::filesystem::path& folder, const std::string& source)
      : model_(model), folder_(folder), source_(source) {}

  GltfMaterial read(const tinygltf::Material& material) const {
    GltfMaterial made;
    made.name = material.name;
    const std::vector<double>& base = material.pbrMetallicRoughness.baseColorFactor;
    const tinygltf::TextureInfo& texture = material.pbrMetallicRoughness.baseColorTexture;
    const bool has_colour = texture.index < 0 && base.size() >= 3;
    if (texture.index >= 0) {
      made.texture_coordinates = texture.texCoord;
      setTransform(made, texture);
    }
    if (has_colour) made.colour = glm::vec3(base[0], base[1], base[2]);
    if (has_colour) made.leaf = leafOf(material, *made.colour);
    if (material.alphaMode == "MASK" || material.alphaMode == "BLEND") {
      Opacity opacity{
          .factor = base.size() == 4 ? static_cast<float>(base[3]) : 1.f, .image = {}, .bytes = {}, .key = {}};
      if (material.alphaMode == "MASK") opacity.least = static_cast<float>(material.alphaCutoff);
      opacity.by_alpha = true;
      if (texture.index >= 0) {
        setImage(opacity, texture.index, material.name);
      }
      made.opacity = opacity;
    }
    return made;
  }

 private:
  // The share `factor` of what is not specular passes, in its own colour; the rest is reflected in the base colour.
  std::optional<FileLeafColours> leafOf(const tinygltf::Material& material, const glm::vec3& base) const {
    const auto found = material.extensions.find("KHR_materials_diffuse_transmission");
    if (found == material.extensions.end() || !found->second.IsObject()) return std::nullopt;
    const tinygltf::Value& extension = found->second;
    if (extension.Has("diffuseTransmissionTexture") || extension.Has("diffuseTransmissionColorTexture"))
      return std::nullopt;
    const auto share = static_cast<float>(extension.Has("diffuseTransmissionFactor")
                                              ? extension.Get("diffuseTransmissionFactor").GetNumberAsDouble()
                                              : 0.);
    require(share >= 0.f && share <= 1.f,
            source_ + ": material \"" + shown(material.name) + "\": diffuseTransmissionFactor", share, "in [0, 1]");
    glm::vec3 colour(1.f);
    if (const tinygltf::Value& list = extension.Get("diffuseTransmissionColorFactor");
        list.IsArray() && list.ArrayLen() == 3)
      for (int band = 0; band < 3; ++band) colour[band] = static_cast<float>(list.Get(band).GetNumberAsDouble());
    FileLeafColours leaf{.reflectance = (1.f - share) * base, .transmittance = share * colour};
    for (int band = 0; band < 3; ++band) {
      float &reflected = leaf.reflectance[band], &passed = leaf.transmittance[band];
      if (!(reflected >= 0.f && passed >= 0.f && reflected <= 1e6f && passed <= 1e6f)) return std::nullopt;
      const float sum = std::max(reflected + passed, 1.f);  // a leaf gives no light
      reflected /= sum;
      passed /= sum;
    }
    return leaf;
  }

  void setImage(Opacity& opacity, int texture, const std::string& name) const {
    const std::string what = source_ + ": material \"" + shown(name) + "\": ";
    require(static_cast<std::size_t>(texture) < model_.textures.size(), what + "texture", texture, "one of the file's");
    const int index = model_.textures[static_cast<std::size_t>(texture)].source;
    require(index >= 0 && static_cast<std::size_t>(index) < model_.images.size(), what + "image", index,
            "one of the file's, PNG or JPEG");
    const tinygltf::Image& image = model_.images[static_cast<std::size_t>(index)];
    opacity.key = "image " + (image.name.empty() ? std::to_string(index) : "\"" + image.name + "\"");
    if (!image.uri.empty() && image.image.empty()) {
      opacity.image = folder_ / decoded(image.uri);
      return;
    }
    if (image.bufferView >= 0) {
      require(static_cast<std::size_t>(image.bufferView) < model_.bufferViews.size(), what + "bufferView",
              image.bufferView, "one of the file's");
      const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(image.bufferView)];
      require(view.buffer >= 0 && static_cast<std::size_t>(view.buffer) < model_.buffers.size(), what + "buffer",
              view.buffer, "one of the file's");
      const std::vector<unsigned char>& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
      require(view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset,
              what + "size of its image [byte]", view.byteLength, "within its buffer");
      opacity.bytes = {reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength};
    } else {
      opacity.bytes = {reinterpret_cast<const char*>(image.image.data()), image.image.size()};
    }
    opacity.image = nameFor(opacity.bytes);
    if (opacity.image.empty()) throw InvalidInput(what + "image " + std::to_string(index) + ": must be PNG or JPEG");
  }

  static void setTransform(GltfMaterial& made, const tinygltf::TextureInfo& texture) {
    const auto found = texture.extensions.find("KHR_texture_transform");
    if (found == texture.extensions.end() || !found->second.IsObject()) return;
    const tinygltf::Value& transform = found->second;
    const auto two = [&](const char* name, double fallback) {
      const tinygltf::Value& list = transform.Get(name);
      return list.IsArray() && list.ArrayLen() == 2
                 ? glm::dvec2(list.Get(0).GetNumberAsDouble(), list.Get(1).GetNumberAsDouble())
                 : glm::dvec2(fallback);
    };
    const glm::dvec2 offset = two("offset", 0.), scale = two("scale", 1.);
    const double angle = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0.;
    if (transform.Has("texCoord")) made.texture_coordinates = transform.Get("texCoord").GetNumberAsInt();
    made.to_image = {scale.x * std::cos(angle),
                     scale.x * std::sin(angle),
                     0.,
                     -scale.y * std::sin(angle),
                     scale.y * std::cos(angle),
                     0.,
                     offset.x,
                     offset.y,
                     1.};
  }

  const tinygltf::Model& model_;
  const std::filesystem::path& folder_;
  const std::string& source_;
};

}  // namespace

std::vector<GltfMaterial> gltfMaterials(const tinygltf::Model& model, const std::filesystem::path& folder,
                                        const std::string& source) {
  std::vector<GltfMaterial> materials;
  const MaterialReader reader(model, folder, source);
  for (const tinygltf::Material& material : model.materials) materials.push_back(reader.read(material));
  return materials;
}

}  // namespace sunfleck::detail
