// Several doubles side by side in GCC's vector extension. Kernels written for a scalar type T accept lanes as they accept
// double.
//
// GCC 12 takes lanes that are wider than the processor's registers apart at comparisons, shuffles and copies: eight of
// them took two to five times as long with AVX2 as twice four. Work on blocks is therefore written for any number of lanes and
// compiled for the number that each processor's registers hold (multiversion.hpp).
#pragma once

#include <cmath>
#include <cstring>

namespace hexdbb {

template <int Count>
struct LanesOf {
  typedef double Type __attribute__((vector_size(Count * sizeof(double))));
};

constexpr int kLanes = 8;  // those of AVX-512, the most
typedef LanesOf<kLanes>::Type Lanes;

template <class L>
constexpr int kLanesIn = static_cast<int>(sizeof(L) / sizeof(double));

template <class L = Lanes>
inline L lanes_of(double value) {
  return L{} + value;
}

template <class L = Lanes>
inline L load(const double* from) {
  L out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

template <class L>
inline void store(const L& value, double* to) {
  std::memcpy(to, &value, sizeof value);
}

inline double root(double value) { return std::sqrt(value); }

template <class L>
inline L root(const L& value) {
  L out;
  for (int lane = 0; lane < kLanesIn<L>; ++lane) out[lane] = std::sqrt(value[lane]);
  return out;
}

template <class L>
inline double sum_of(const L& lanes) {
  double sum = 0.0;
  for (int lane = 0; lane < kLanesIn<L>; ++lane) sum += lanes[lane];
  return sum;
}

}  // namespace hexdbb
