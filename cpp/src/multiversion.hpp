// Functions compiled for several processors (any x86-64, AVX2 with FMA, AVX-512); the best version is selected when the
// program loads, so that one build is fast on every machine. Sanitizers do not support the resolver and use the plain
// version.
//
// HEXDBB_BY_LANES(name, parameters, arguments) defines the function `name`, which calls name_in<L>, a template of the
// lanes L, compiled for each of these processors with as many lanes as its registers hold.
#pragma once

#include "lanes.hpp"

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define HEXDBB_MULTIVERSION __attribute__((target_clones("arch=x86-64-v3", "default")))
#define HEXDBB_MULTIVERSION_WIDE __attribute__((flatten, target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))

namespace hexdbb {

/// Return how many doubles the processor's registers hold.
inline int lanes_of_processor() noexcept {
  static const int lanes = __builtin_cpu_supports("x86-64-v4") ? 8 : __builtin_cpu_supports("x86-64-v3") ? 4 : 2;
  return lanes;
}

}  // namespace hexdbb

#define HEXDBB_BY_LANES(name, parameters, arguments)                                               \
  __attribute__((flatten, target("arch=x86-64-v4"))) static void name##_by_8 parameters noexcept { \
    name##_in<hexdbb::LanesOf<8>::Type> arguments;                                                 \
  }                                                                                                \
  __attribute__((flatten, target("arch=x86-64-v3"))) static void name##_by_4 parameters noexcept { \
    name##_in<hexdbb::LanesOf<4>::Type> arguments;                                                 \
  }                                                                                                \
  __attribute__((flatten)) static void name##_by_2 parameters noexcept {                           \
    name##_in<hexdbb::LanesOf<2>::Type> arguments;                                                 \
  }                                                                                                \
  void name parameters noexcept {                                                                  \
    const int lanes = hexdbb::lanes_of_processor();                                                \
    (lanes == 8 ? name##_by_8 : lanes == 4 ? name##_by_4 : name##_by_2) arguments;                 \
  }
#else
#define HEXDBB_MULTIVERSION
#define HEXDBB_MULTIVERSION_WIDE
#define HEXDBB_BY_LANES(name, parameters, arguments) \
  void name parameters noexcept { name##_in<hexdbb::LanesOf<2>::Type> arguments; }
#endif
