#pragma once

#include <string>

namespace sunfleck {

// The processor and how many threads it runs, to stand beside times measured on it.
std::string machineName();

}  // namespace sunfleck
