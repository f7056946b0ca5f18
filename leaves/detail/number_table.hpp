#pragma once

#include <string_view>
#include <vector>

namespace sunfleck::detail {

// The numbers of a table of the program's own, row by row: lines of numbers with spaces between; one that starts with #
// is a comment.
std::vector<double> numberTable(std::string_view text);

}  // namespace sunfleck::detail
