#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/leaf_mask.hpp"
#include "plants/import.hpp"

namespace sunfleck::detail {

// How much of a material is there [1].
struct Opacity {
  float factor = 1.f;           // of all of it
  float least = 0.5f;           // of what is there
  std::filesystem::path image;  // of each place; none if empty
  std::string_view bytes;       // of the image, where it lies within the file
  std::string key;              // what the file calls it, for messages: "map_d leaf.png"
  bool moved = false;           // whether the image is to be moved or scaled on the face
  bool by_alpha = false;        // whether only an alpha channel tells: without one all of it is there
};

// The mask that such a material cuts leaves out by; nothing where all is there. Throws InvalidInput("<source>: ...") on
// an image that cannot be read, and without a reader.
std::shared_ptr<const LeafMask> maskOf(const Opacity& opacity, const ImageReader& read_image,
                                       const std::string& source);

}  // namespace sunfleck::detail
