// The RSSR loops on a scalar type T: double for one pose, a pack of doubles for many side by side.
//
// Ball joint i: Q_i = C_i + U_i cos + W_i sin, with C_i the centre of the circle in which the spheres about the two slider
// joints meet, U_i its radius vector in the plane of the axis and the upward normal, W_i the one across, pointing inward.
// For the nominal machine this is thesis (2.9), (2.10), (2.23)-(2.25). No angle is ever formed: cosine and sine turn by
// a tangent, so that an iteration calls no trigonometric function.
#pragma once

#include <cmath>

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
  T span_squared;    // squared horizontal distance of the slider joints; zero where up is undefined
};

/// Where spheres of radii l1, l2 about b1, b2 meet. With d = b2 - b1: centre b1 + t d, t = (d.d + l1^2 - l2^2) / (2 d.d).
template <class T>
inline Circle<T> meeting_circle(const Vec<T>& b1, const Vec<T>& b2, const T& l1, const T& l2) {
  using std::sqrt;
  const Vec<T> d = b2 - b1;
  const T d_squared = dot(d, d);
  const T t = (d_squared + (l1 - l2) * (l1 + l2)) / (d_squared + d_squared);
  const T radius_squared = l1 * l1 - t * t * d_squared;
  const T span_squared = d.x * d.x + d.y * d.y;
  // d x z has length sqrt(span), z (d.d) - dz d has length sqrt(span d.d): both become radius vectors.
  const T in_scale = sqrt(radius_squared / span_squared);
  const T up_scale = in_scale / sqrt(d_squared);
  return {b1 + t * d,
          {-(up_scale * d.z) * d.x, -(up_scale * d.z) * d.y, up_scale * span_squared},
          {in_scale * d.y, -(in_scale * d.x), in_scale * T{}},
          radius_squared,
          span_squared};
}

template <class T>
struct Loops {
  Vec<T> q[3];        // ball joints
  Vec<T> tangent[3];  // dQ_i / d angle_i
  T f[3];             // F_i = |Q_i - Q_j|^2 - side^2, j = i + 1 cyclic, mm^2 (2.11)-(2.16)
  T a[3];             // dF_i / d angle_i
  T b[3];             // dF_i / d angle_j
  T determinant;      // of the cyclic Jacobian (2.17)
};

template <class T>
inline Loops<T> close_loops(const Circle<T> (&circle)[3], const T (&c)[3], const T (&s)[3], const T (&side_squared)[3]) {
  Loops<T> out;
  for (int i = 0; i < 3; ++i) {
    out.q[i] = circle[i].centre + c[i] * circle[i].up + s[i] * circle[i].in;
    out.tangent[i] = c[i] * circle[i].in - s[i] * circle[i].up;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const Vec<T> side = out.q[i] - out.q[j];
    const T along_i = dot(side, out.tangent[i]);
    const T along_j = dot(side, out.tangent[j]);
    out.f[i] = dot(side, side) - side_squared[i];
    out.a[i] = along_i + along_i;
    out.b[i] = -(along_j + along_j);
  }
  out.determinant = out.a[0] * out.a[1] * out.a[2] + out.b[0] * out.b[1] * out.b[2];
  return out;
}

/// Newton step by Cramer's rule, (2.18)-(2.20): the three formulas are one another's cyclic shift.
template <class T>
inline void cramer_step(const Loops<T>& loops, T (&step)[3]) {
  const T(&a)[3] = loops.a;
  const T(&b)[3] = loops.b;
  const T(&f)[3] = loops.f;
  const T inverse = T{} + 1.0 / loops.determinant;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = j == 2 ? 0 : j + 1;
    step[i] = inverse * (f[j] * b[i] * a[k] - f[i] * a[j] * a[k] - f[k] * b[i] * b[j]);
  }
}

/// Turn an angle held as cosine and sine by atan(t), which is t to third order, and put it back on the unit circle.
template <class T>
inline void turn(const T& t, T& c, T& s) {
  using std::sqrt;
  const T scale = 1.0 / sqrt((t * t + 1.0) * (c * c + s * s));
  const T turned = scale * (c - s * t);
  s = scale * (s + c * t);
  c = turned;
}

}  // namespace hexdbb::rssr
