#pragma once

#include <cstddef>
#include <cstdint>

namespace sunfleck::fuzz {

// Imports these bytes as a file with that extension, as it stands and as a stand. Whatever they are, that must end with
// a mesh on which all may rely or with InvalidInput of one line; anything else ends the program by abort().
void importBytes(const std::uint8_t* data, std::size_t size, const char* extension);

}  // namespace sunfleck::fuzz
