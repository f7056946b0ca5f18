#pragma once

#include <stdexcept>
#include <string>

namespace sunfleck::gl {

// Something is more than this OpenGL holds or lets a shader read.
struct TooLarge : std::runtime_error {
  enum class What { light_map, other };  // a light's opacity map, which is made as large as people ask for
  TooLarge(What of, const std::string& why) : std::runtime_error(why), what_is(of) {}
  explicit TooLarge(const std::string& why) : TooLarge(What::other, why) {}
  What what_is;
};

}  // namespace sunfleck::gl
