#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sunfleck {

// OpenVDB stamps each .vdb file with a random identifier and keeps no checksum. Sunfleck's files carry one in its
// place: an identifier of Sunfleck with the CRC-32 of all other bytes. So equal grids make equal files, and damage is
// found; and a program that changes a grid and writes it anew leaves its own identifier, which is not held against the
// file.
constexpr std::size_t kVdbHeader = 57;  // [byte] up to the end of the identifier

void seal(std::string& bytes);           // puts the identifier in; `bytes` are at least a header
void checkSeal(std::string_view bytes);  // throws InvalidInput("is corrupt: ...") when Sunfleck's identifier is wrong

}  // namespace sunfleck
