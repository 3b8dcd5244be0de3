// Functions compiled twice, for any x86-64 and for one with AVX2 and FMA; the processor chooses when the program loads, so that
// one wheel is fast on every machine. Sanitizers cannot follow the resolver and get the plain version.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define HEXDBB_MULTIVERSION __attribute__((target_clones("arch=haswell", "default")))
#else
#define HEXDBB_MULTIVERSION
#endif
