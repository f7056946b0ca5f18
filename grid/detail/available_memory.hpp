#pragma once

namespace sunfleck {

// What grids may take [byte]: 8 GiB, or what the system can still give where that is less.
double availableMemory();

}  // namespace sunfleck
