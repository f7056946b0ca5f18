#pragma once

#include <cstdint>
#include <string>

namespace sunfleck::apps {

// Which of several equal parts of a run this is, numbered from 0.
struct RunPart {
  std::uint64_t number = 0, of = 1;
};

// "K/N", as --part is typed: the K-th of N parts, counted from 1. Throws InvalidInput on any other text.
RunPart partNamed(const std::string& text);

}  // namespace sunfleck::apps
