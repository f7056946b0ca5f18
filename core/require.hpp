#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sunfleck {

// The user's input is wrong. The message is the one line the user sees; the program ends with status 2.
struct InvalidInput : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

// Throws InvalidInput("<what> = <value>: must be <rule>") unless ok. Written for boundaries: hot code assumes valid
// input.
template <typename T>
void require(bool ok, std::string_view what, const T& value, std::string_view rule) {
  if (ok) return;
  std::ostringstream message;
  message << what << " = " << value << ": must be " << rule;
  throw InvalidInput(message.str());
}

}  // namespace sunfleck
