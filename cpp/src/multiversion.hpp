// Functions compiled for several processors (any x86-64, AVX2 with FMA, AVX-512); the best version is selected when the
// program loads, so that one build is fast on every machine. Sanitizers do not support the resolver and use the plain
// version.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && __GNUC__ >= 12 && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define HEXDBB_MULTIVERSION __attribute__((target_clones("arch=x86-64-v3", "default")))
#define HEXDBB_MULTIVERSION_WIDE __attribute__((flatten, target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define HEXDBB_MULTIVERSION
#define HEXDBB_MULTIVERSION_WIDE
#endif
