#include "apps/run_part.hpp"

#include <charconv>

#include "core/require.hpp"

namespace sunfleck::apps {

RunPart partNamed(const std::string& text) {
  RunPart part;
  const char* const last = text.data() + text.size();
  const auto number = std::from_chars(text.data(), last, part.number);
  const bool slash = number.ec == std::errc() && number.ptr != last && *number.ptr == '/';
  const auto parts = std::from_chars(slash ? number.ptr + 1 : last, last, part.of);
  if (!slash || parts.ec != std::errc() || parts.ptr != last || part.number < 1 || part.number > part.of)
    throw InvalidInput("--part " + text + ": must be K/N, the K-th of N parts");
  --part.number;
  return part;
}

}  // namespace sunfleck::apps
