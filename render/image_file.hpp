#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/image.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck {

// Writes a picture by the file's extension, whole or not at all: .exr keeps linear radiances as 32-bit floats; .png
// shows them as the display says, 8 bits: channels R, G and B, or else the first channel as grey. Throws InvalidInput
// on another extension or a place that cannot be written.
void writeImage(const std::filesystem::path& file, const Image& image, const Display& display);

// Writes a .png of 8-bit colours as they stand, red, green and blue, rows from the top; whole or not at all. Throws
// InvalidInput on another extension or a place that cannot be written.
void writePng(const std::filesystem::path& file, int width, int height, std::span<const std::uint8_t> colours);

// Writes values as they stand: .exr as 32-bit floats, .png as whole numbers of 16 bits, cut to 0 .. 1; whole or not at
// all. Channels "R", "G", "B" or "Y", with "A" after them or without. Throws as writeImage() does.
void writeValues(const std::filesystem::path& file, const Image& image);

// Throws InvalidInput unless a picture could be written at `file`: to be asked before long work.
void requirePictureName(const std::filesystem::path& file);

// Reads linear radiances: an .exr or .hdr picture of at most 8192 x 4096 pixels. Throws InvalidInput on anything else.
Image readRadiances(const std::filesystem::path& file);

// Reads an image by any format that OpenImageIO knows (PNG, TGA, JPEG, EXR ...), at most kLargestImage pixels wide and
// high: the first subimage, rows from the top. Values of whole numbers are 0 .. 1 as they stand; with `linear`, colours
// but not alpha are taken from sRGB to linear light unless the file holds floating-point numbers. Channels are named
// "R", "G", "B", "A" or "Y". Throws InvalidInput on what cannot be read or holds a value that is not finite.
inline constexpr int kLargestImage = 8192;
enum class ImageValues { as_they_stand, linear };
Image readImage(const std::filesystem::path& file, ImageValues values);

// The same of an image that tells how much of a leaf there is, as it stands: `bytes` of a PNG or JPEG, where they are
// not empty, else those of the file. At most kLargestOpacity pixels wide and high and 400 times as many values as
// bytes, which files that are made to fill the memory exceed.
inline constexpr int kLargestOpacity = 4096;
Image readOpacity(const std::filesystem::path& file, std::string_view bytes);

// The same PNG as bytes, for embedding in a report.
std::string pngBytes(const Image& image, const Display& display);

}  // namespace sunfleck
