// A platform on six legs with separate joints, on a scalar type T: Newton on its six coordinates, and the forces that
// hold it. Both are linear systems in the same matrix W, whose column k is the wrench of a unit force in leg k about
// the reference point: W' step = length errors of the legs, W force = wrench of the load. W = Q R by modified
// Gram-Schmidt, which needs no choice of pivots, so that lanes stay together.
#pragma once

#include "sample_kernel.hpp"

namespace hexdbb::rssr {

constexpr double kLever_mm = 100.0;  // moments are divided by it: all six coordinates are then lengths of one size

/// Three coordinates of translation (or force) and three of rotation (or moment).
template <class T>
struct Six {
  Vec<T> force, moment;
};

template <class T>
inline Six<T> operator+(const Six<T>& a, const Six<T>& b) {
  return {a.force + b.force, a.moment + b.moment};
}
template <class T>
inline Six<T> operator-(const Six<T>& a, const Six<T>& b) {
  return {a.force - b.force, a.moment - b.moment};
}
template <class T>
inline Six<T> operator*(const T& s, const Six<T>& a) {
  return {s * a.force, s * a.moment};
}
template <class T>
inline T dot(const Six<T>& a, const Six<T>& b) {
  return dot(a.force, b.force) + dot(a.moment, b.moment);
}

/// Return the wrench of a unit force along `direction` at `arm` from the reference point.
template <class T>
inline Six<T> wrench(const Vec<T>& direction, const Vec<T>& arm) {
  return {direction, (T{} + 1.0 / kLever_mm) * cross(arm, direction)};
}

/// W = Q R.
template <class T>
struct Wrenches {
  Six<T> q[6];
  T r[6][6];        // above the diagonal
  T inverse[6];     // of the diagonal
  T least_squared;  // smallest element of the diagonal, squared; 0 where the legs do not hold the platform

  /// Solve W x = b.
  void forces(const Six<T>& b, T (&x)[6]) const {
    for (int i = 5; i >= 0; --i) {
      x[i] = dot(q[i], b);
      for (int j = i + 1; j < 6; ++j) x[i] = x[i] - r[i][j] * x[j];
      x[i] = x[i] * inverse[i];
    }
  }

  /// Solve W' x = b.
  Six<T> movement(const T (&b)[6]) const {
    Six<T> out = {};
    T y[6];
    for (int i = 0; i < 6; ++i) {
      y[i] = b[i];
      for (int j = 0; j < i; ++j) y[i] = y[i] - r[j][i] * y[j];
      y[i] = y[i] * inverse[i];
      out = out + y[i] * q[i];
    }
    return out;
  }
};

template <class T>
inline Wrenches<T> factor(const Six<T> (&column)[6]) {
  Wrenches<T> out;
  for (int j = 0; j < 6; ++j) out.q[j] = column[j];
  out.least_squared = dot(out.q[0], out.q[0]);
  for (int i = 0; i < 6; ++i) {
    const T squared = dot(out.q[i], out.q[i]);
    out.least_squared = squared < out.least_squared ? squared : out.least_squared;
    out.inverse[i] = 1.0 / root(squared);
    out.q[i] = out.inverse[i] * out.q[i];
    for (int j = i + 1; j < 6; ++j) {
      out.r[i][j] = dot(out.q[i], out.q[j]);
      out.q[j] = out.q[j] - out.r[i][j] * out.q[i];
    }
  }
  return out;
}

/// The legs of a placed platform.
template <class T>
struct SixLegs {
  Vec<T> leg[6];     // from slider joint to platform joint
  T inverse[6];      // of its length
  T too_long[6];     // actual minus required length
  Six<T> column[6];  // of W
};

template <class T>
inline SixLegs<T> six_legs(const Vec<T> (&base)[6], const T (&length)[6], const Vec<T> (&joint)[6],
                           const PlacedPlatform<T>& platform) {
  SixLegs<T> out;
  for (int k = 0; k < 6; ++k) {
    const Vec<T> arm = platform.turned(joint[k]);
    out.leg[k] = platform.position + arm - base[k];
    const T now = root(dot(out.leg[k], out.leg[k]));
    out.inverse[k] = 1.0 / now;
    out.too_long[k] = now - length[k];
    out.column[k] = wrench(out.inverse[k] * out.leg[k], arm);
  }
  return out;
}

/// Move a platform back by `by`; the rotation is Cayley's: orthogonal to rounding, its angle exact to third order.
template <class T>
inline void move_back(const Six<T>& by, PlacedPlatform<T>& platform) {
  platform.position = platform.position - by.force;
  const Vec<T> half = (T{} - 0.5 / kLever_mm) * by.moment;
  const T scale = 2.0 / (1.0 + dot(half, half));
  for (int j = 0; j < 3; ++j) {
    const Vec<T> across = cross(half, platform.column[j]);
    platform.column[j] = platform.column[j] + scale * (across + cross(half, across));
  }
}

}  // namespace hexdbb::rssr
