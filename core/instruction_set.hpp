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

// Declares a kernel's builds, constants `name` of type `Kernel` in namespaces named after the instruction sets, and
// bestBuild(), which gives the one that suits the machine. Once in a file, in the namespace that holds these.
#ifdef SUNFLECK_X86
#define SUNFLECK_BUILDS(Kernel, name)                                                            \
  namespace baseline {                                                                           \
  extern const Kernel name;                                                                      \
  }                                                                                              \
  namespace avx2 {                                                                               \
  extern const Kernel name;                                                                      \
  }                                                                                              \
  namespace avx512 {                                                                             \
  extern const Kernel name;                                                                      \
  }                                                                                              \
  static const Kernel& bestBuild() {                                                             \
    static const Kernel& best = sunfleck::bestOf({&baseline::name, &avx2::name, &avx512::name}); \
    return best;                                                                                 \
  }
#else
#define SUNFLECK_BUILDS(Kernel, name) \
  namespace baseline {                \
  extern const Kernel name;           \
  }                                   \
  static const Kernel& bestBuild() {  \
    return baseline::name;            \
  }
#endif
