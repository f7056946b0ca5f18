#pragma once

namespace sunfleck {

// What a numerical kernel may be compiled for (sunfleck_kernel in cmake/module.cmake), from the oldest machine on.
enum class InstructionSet { baseline, avx2, avx512 };

// The best that this machine has; no better than the environment's SUNFLECK_SIMD (baseline or avx2) where that is set,
// to try what an older machine would do. Looked up anew with each call.
InstructionSet instructionSet();

}  // namespace sunfleck
