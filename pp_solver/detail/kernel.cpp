#include "pp_solver/detail/kernel.hpp"

#include <cstdlib>
#include <string_view>

namespace sunfleck::pp {

#ifdef SUNFLECK_X86
namespace avx512 {
extern const detail::Kernel the_kernel;
}
namespace avx2 {
extern const detail::Kernel the_kernel;
}
#endif
namespace baseline {
extern const detail::Kernel the_kernel;
}

namespace detail {
namespace {

const Kernel& choose() {
#ifdef SUNFLECK_X86
  // SUNFLECK_SIMD=baseline or avx2 tries what an older machine would do.
  const char* wanted = std::getenv("SUNFLECK_SIMD");
  const std::string_view limit = wanted == nullptr ? "" : wanted;
  if (limit != "baseline") {
    if (limit != "avx2" && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
      return avx512::the_kernel;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return avx2::the_kernel;
  }
#endif
  return baseline::the_kernel;
}

}  // namespace

const Kernel& kernel() {
  static const Kernel& chosen = choose();
  return chosen;
}

}  // namespace detail
}  // namespace sunfleck::pp
