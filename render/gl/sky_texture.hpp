#pragma once

#include <memory>

#include "render/gl/object_name.hpp"
#include "sky/sky_map.hpp"

namespace sunfleck::gl {

// The sky's radiance, a texel for each of its cells: rows from the zenith down, columns by azimuth.
class SkyTexture {
 public:
  SkyTexture();
  // Sends the sky if it is another; gives the bytes sent. Throws TooLarge with the figure.
  std::size_t update(const std::shared_ptr<const SkyMap>& sky);
  void bind(unsigned unit) const;

 private:
  static void destroy(unsigned name);
  std::shared_ptr<const SkyMap> sky_;
  ObjectName<&SkyTexture::destroy> name_;
};

}  // namespace sunfleck::gl
