#include "render/detail/image_codec.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace sunfleck::detail {

// The library stays loaded: what OpenImageIO has begun cannot be undone.
const ImageCodec& imageCodec() {
  static const ImageCodec* const codec = [] {
    void* const library = dlopen(SUNFLECK_IMAGE_CODEC, RTLD_NOW | RTLD_LOCAL);
    void* const make = library ? dlsym(library, "sunfleckImageCodec") : nullptr;
    if (!make) throw std::runtime_error(std::string("images cannot be read or written: ") + dlerror());
    return reinterpret_cast<const ImageCodec* (*)()>(make)();
  }();
  return *codec;
}

}  // namespace sunfleck::detail
