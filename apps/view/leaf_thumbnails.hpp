#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/leaf_maps.hpp"
#include "leaves/leaf_textures.hpp"

namespace sunfleck::view {

// A small picture for people.
struct Thumbnail {
  int width = 1, height = 1;         // [pixel]
  std::vector<glm::u8vec4> colours;  // sRGB and 255, rows from top to bottom
};

// What of a leaf's images, or of what its places do to light, is shown.
enum class LeafImagePart { colour, alpha };
enum class LeafMapPart { upper_reflectance, lower_reflectance, transmittance };

// At most `longest` pixels a side, each the mean of 16 places or fewer of those that it stands for; values above 1 are
// shown as 1. Colours are shown as light, an alpha as grey in proportion to it (1 where the image has none).
Thumbnail thumbnailOf(const LeafTexture& texture, LeafImagePart part, int longest);
Thumbnail thumbnailOf(const LeafMaps& maps, LeafMapPart part, int longest);

// Thumbnails on the graphics card, each made once as long as what it shows exists.
class LeafThumbnails {
 public:
  struct Uploaded {
    unsigned name = 0;
    int width = 1, height = 1;  // [pixel]
  };
  using Upload = std::function<std::shared_ptr<const Uploaded>(const Thumbnail&)>;

  explicit LeafThumbnails(Upload upload, int longest = 96) : upload_(std::move(upload)), longest_(longest) {}

  const Uploaded& of(const std::shared_ptr<const LeafTexture>& texture, LeafImagePart part) {
    return of<LeafTexture>(texture, part);
  }
  const Uploaded& of(const std::shared_ptr<const LeafMaps>& maps, LeafMapPart part) { return of<LeafMaps>(maps, part); }
  std::size_t made() const { return made_; }  // so far

 private:
  struct Entry {
    std::weak_ptr<const void> of;
    int part = 0;
    std::shared_ptr<const Uploaded> uploaded;
  };
  template <typename Images, typename Part>
  const Uploaded& of(const std::shared_ptr<const Images>& images, Part part);

  Upload upload_;
  int longest_;
  std::vector<Entry> entries_;
  std::size_t made_ = 0;
};

// To the current OpenGL context, which must be there until the last one is gone.
std::shared_ptr<const LeafThumbnails::Uploaded> uploadedThumbnail(const Thumbnail& thumbnail);

}  // namespace sunfleck::view
