#pragma once

#include <filesystem>

#include "leaves/leaf_textures.hpp"

namespace sunfleck {

// Reads an image of a leaf, by any format that OpenImageIO knows: values as they stand, one grey for all bands or three
// colours, with an alpha or without. Throws InvalidInput that names the file, on what cannot be read, more than 4096
// pixels a side, an image far larger than its file (readOpacity), colours outside 0 .. `most_colour`, and an alpha
// outside 0 .. 1.
std::shared_ptr<const LeafTexture> readLeafTexture(const std::filesystem::path& file, float most_colour);

// Writes it: .png with 16 bits, values from 0 to 1; .exr with 32-bit floats; whole or not at all. Throws InvalidInput
// on another extension or a place that cannot be written.
void writeLeafTexture(const std::filesystem::path& file, const LeafTexture& texture);

}  // namespace sunfleck
