// The RSSR loops on a scalar type T: double for one pose, lanes of doubles for several at once.
//
// Ball joint i: Q_i = C_i + U_i cos + W_i sin, with C_i the centre of the circle in which the spheres about the two
// slider joints meet, U_i its radius vector in the plane of the axis and the upward normal, W_i the one across,
// pointing inward. For the nominal machine this is thesis (2.9), (2.10), (2.23)-(2.25). No angle is ever formed: cosine
// and sine turn by a tangent, so that an iteration calls no trigonometric function.
#pragma once

#include <cmath>

#include "lanes.hpp"

namespace hexdbb::rssr {

template <class T>
struct Vec {
  T x, y, z;
};

template <class T>
inline Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
inline Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
inline Vec<T> operator*(const T& s, const Vec<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
inline T dot(const Vec<T>& a, const Vec<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
inline Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
struct Circle {
  Vec<T> centre, up, in;
  T radius_squared;  // not positive where the legs do not meet
  T span_squared;    // squared horizontal distance of the slider joints; zero where `up` is undefined
};

/// Intersect spheres of radii l1, l2 about b1, b2. With d = b2 - b1: centre b1 + t d, t = (d.d + l1^2 - l2^2) / (2
/// d.d).
template <class T>
inline Circle<T> meeting_circle(const Vec<T>& b1, const Vec<T>& b2, const T& l1, const T& l2) {
  const Vec<T> d = b2 - b1;
  const T span_squared = d.x * d.x + d.y * d.y;
  const T d_squared = span_squared + d.z * d.z;
  const T inverse = 1.0 / (d_squared * span_squared);  // the one division: serves 1/d.d and 1/span
  const T inverse_d_squared = inverse * span_squared;
  const T t = 0.5 + 0.5 * (l1 - l2) * (l1 + l2) * inverse_d_squared;
  const T radius_squared = l1 * l1 - t * t * d_squared;
  // d x z has length sqrt(span), z (d.d) - dz d has length sqrt(span d.d): both become radius vectors.
  const T in_scale = root(radius_squared * inverse * d_squared);
  const T up_scale = in_scale * root(inverse_d_squared);
  return {b1 + t * d,
          {-(up_scale * d.z) * d.x, -(up_scale * d.z) * d.y, up_scale * span_squared},
          {in_scale * d.y, -(in_scale * d.x), in_scale * T{}},
          radius_squared,
          span_squared};
}

/// The ball joints at given angles, and the closing errors of the three sides.
template <class T>
struct Loops {
  Vec<T> q[3];     // ball joints
  Vec<T> side[3];  // Q_i - Q_j, j = i + 1 cyclic
  T f[3];          // F_i = |Q_i - Q_j|^2 - side^2, mm^2 (2.11)-(2.16)
};

template <class T>
inline Loops<T> close_loops(const Circle<T> (&circle)[3], const T (&c)[3], const T (&s)[3],
                            const T (&side_squared)[3]) {
  Loops<T> out;
  for (int i = 0; i < 3; ++i) out.q[i] = circle[i].centre + c[i] * circle[i].up + s[i] * circle[i].in;
  for (int i = 0; i < 3; ++i) {
    out.side[i] = out.q[i] - out.q[i == 2 ? 0 : i + 1];
    out.f[i] = dot(out.side[i], out.side[i]) - side_squared[i];
  }
  return out;
}

/// The cyclic Jacobian of the loops (2.17).
template <class T>
struct LoopJacobian {
  T a[3];  // dF_i / d angle_i
  T b[3];  // dF_i / d angle_j, j = i + 1 cyclic
  T determinant;
};

template <class T>
inline LoopJacobian<T> loop_jacobian(const Circle<T> (&circle)[3], const T (&c)[3], const T (&s)[3],
                                     const Loops<T>& loops) {
  LoopJacobian<T> out;
  Vec<T> tangent[3];  // 2 dQ_i / d angle_i
  for (int i = 0; i < 3; ++i) tangent[i] = (c[i] + c[i]) * circle[i].in - (s[i] + s[i]) * circle[i].up;
  for (int i = 0; i < 3; ++i) {
    out.a[i] = dot(loops.side[i], tangent[i]);
    out.b[i] = -dot(loops.side[i], tangent[i == 2 ? 0 : i + 1]);
  }
  out.determinant = out.a[0] * out.a[1] * out.a[2] + out.b[0] * out.b[1] * out.b[2];
  return out;
}

/// Compute the Newton step by Cramer's rule, (2.18)-(2.20): the three formulas are cyclic shifts of each other.
template <class T>
inline void cramer_step(const Loops<T>& loops, const LoopJacobian<T>& jacobian, T (&step)[3]) {
  const T(&a)[3] = jacobian.a;
  const T(&b)[3] = jacobian.b;
  const T(&f)[3] = loops.f;
  const T inverse = 1.0 / jacobian.determinant;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = j == 2 ? 0 : j + 1;
    step[i] = inverse * (f[j] * b[i] * a[k] - f[i] * a[j] * a[k] - f[k] * b[i] * b[j]);
  }
}

constexpr double kNearOne = 4e-4;  // |e| below which the next function's error is below 2e-16

/// Compute 1 / sqrt(1 + e) by its series, without a root or a division.
template <class T>
inline T inverse_root_near_one(const T& e) {
  return 1.0 - e * (0.5 - e * (0.375 - e * (0.3125 - e * 0.2734375)));
}

/// Rotate an angle held as cosine and sine by atan(t), which is t to third order, and normalize it.
template <class T>
inline void turn_by(const T& t, const T& scale, T& c, T& s) {
  const T turned = scale * (c - s * t);
  s = scale * (s + c * t);
  c = turned;
}

inline void turn(double t, double& c, double& s) {
  const double stretch = (t * t + 1.0) * (c * c + s * s) - 1.0;
  turn_by(t, std::abs(stretch) < kNearOne ? inverse_root_near_one(stretch) : 1.0 / std::sqrt(1.0 + stretch), c, s);
}

}  // namespace hexdbb::rssr
