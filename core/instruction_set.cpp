#include "core/instruction_set.hpp"

#include <cstdlib>
#include <string_view>

namespace sunfleck {

InstructionSet instructionSet() {
#if defined(__x86_64__)
  const char* wanted = std::getenv("SUNFLECK_SIMD");
  const std::string_view limit = wanted == nullptr ? "" : wanted;
  if (limit == "baseline") return InstructionSet::baseline;
  if (limit != "avx2" && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return InstructionSet::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

}  // namespace sunfleck
