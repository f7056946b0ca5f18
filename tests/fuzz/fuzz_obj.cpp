#include "tests/fuzz/import_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sunfleck::fuzz::importBytes(data, size, ".obj");
  return 0;
}
