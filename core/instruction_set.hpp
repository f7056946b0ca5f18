#pragma once

#include <cstddef>
#include <initializer_list>

namespace sunfleck {

// What a numerical kernel may be compiled for (sunfleck_kernel in cmake/module.cmake), from the oldest machine on.
enum class InstructionSet { baseline, avx2, avx512 };

// The best that this machine has; no better than the environment's SUNFLECK_SIMD (baseline or avx2) where that is set,
// to try what an older machine would do. Looked up anew with each call.
InstructionSet instructionSet();

// The one of a kernel's builds that suits the machine best.
//   builds  for the instruction sets from the oldest on: all, or the baseline alone
template <typename Kernel>
const Kernel& bestOf(std::initializer_list<const Kernel*> builds) {
  const auto best = static_cast<std::size_t>(instructionSet());
  return *builds.begin()[best < builds.size() ? best : builds.size() - 1];
}

}  // namespace sunfleck
