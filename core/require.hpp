#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace sunfleck {

// The user's input is wrong. The message is the one line the user sees; the program ends with status 2.
struct InvalidInput : std::invalid_argument {
  explicit InvalidInput(std::string message) : std::invalid_argument(withoutNul(std::move(message))) {}

 private:
  // A zero byte of a quoted file would end the message before its rule.
  static std::string withoutNul(std::string message) {
    std::replace(message.begin(), message.end(), '\0', '?');
    return message;
  }
};

// Throws InvalidInput("<what> = <value>: must be <rule>") unless ok. Written for boundaries: hot code assumes valid
// input.
template <typename T>
void require(bool ok, std::string_view what, const T& value, std::string_view rule) {
  if (ok) return;
  std::ostringstream message;
  message << what << " = ";
  if constexpr (std::is_floating_point_v<T>) {
    // Every digit that sets it apart: rounded, a value outside of the rule might read as one within.
    std::array<char, 64> digits;
    message << std::string_view(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
  } else {
    message << value;
  }
  message << ": must be " << rule;
  throw InvalidInput(message.str());
}

}  // namespace sunfleck
