// Eight doubles in GCC's vector extension: two registers with AVX2, one with AVX-512, four without either. Kernels
// written for a scalar type T accept it as they accept double.
#pragma once

#include <cmath>
#include <cstring>

namespace hexdbb {

constexpr int kLanes = 8;
typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double))));

inline Lanes lanes_of(double value) { return Lanes{} + value; }

inline Lanes load(const double* from) {
  Lanes out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

inline void store(const Lanes& value, double* to) { std::memcpy(to, &value, sizeof value); }

inline double root(double value) { return std::sqrt(value); }

inline Lanes root(const Lanes& value) {
  Lanes out;
  for (int lane = 0; lane < kLanes; ++lane) out[lane] = std::sqrt(value[lane]);
  return out;
}

}  // namespace hexdbb
