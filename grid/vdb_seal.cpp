#include "grid/detail/vdb_seal.hpp"

#include <zlib.h>

#include <cstdio>

#include "core/require.hpp"

namespace sunfleck {
namespace {

constexpr std::size_t kAt = 21, kLength = 36;                       // of the identifier [byte]
constexpr std::string_view kOurs = "53756e66-6c65-8000-8000-0000";  // "Sunfle", as a UUID of the free version 8
static_assert(kAt + kLength == kVdbHeader && kOurs.size() + 8 == kLength);

std::string identifier(std::string_view bytes) {
  const auto crc = [](uLong before, std::string_view part) {
    return crc32_z(before, reinterpret_cast<const Bytef*>(part.data()), part.size());
  };
  char hexadecimal[9];
  std::snprintf(hexadecimal, sizeof hexadecimal, "%08x",
                static_cast<unsigned>(crc(crc(0, bytes.substr(0, kAt)), bytes.substr(kVdbHeader))));
  return std::string(kOurs) + hexadecimal;
}

}  // namespace

void seal(std::string& bytes) {
  bytes.replace(kAt, kLength, identifier(bytes));
}

void checkSeal(std::string_view bytes) {
  if (bytes.size() < kVdbHeader || bytes.substr(kAt, kOurs.size()) != kOurs) return;
  if (bytes.substr(kAt, kLength) != identifier(bytes))
    throw InvalidInput("is cut short or corrupt: its bytes do not match the checksum that Sunfleck wrote");
}

}  // namespace sunfleck
