// One sample from joints to reading and sensitivity, on a scalar type T: double, or eight samples in lanes. The steps
// are described in kinematics.hpp and ball_bar.hpp; both the single-pose functions and the batch consist of them.
#pragma once

#include "rssr_kernel.hpp"

namespace hexdbb::rssr {

/// Slider joints, leg lengths and the three shared platform joints of a sample.
template <class T>
struct Joints {
  Vec<T> base[6];
  T length[6];
  Vec<T> platform[3];
};

/// Platform frame of three ball joints: the inverse of the columns x = q2-q1, y = q3-q1, n = x * y, as three rows.
template <class T>
struct TriangleFrame {
  Vec<T> row[3];
  T side_squared[3];
};

template <class T>
inline TriangleFrame<T> triangle_frame(const Vec<T> (&q)[3]) {
  const Vec<T> x = q[1] - q[0], y = q[2] - q[0], n = cross(x, y), xy = y - x;
  const T inverse = 1.0 / dot(n, n);
  return {{inverse * cross(y, n), inverse * cross(n, x), inverse * n}, {dot(x, x), dot(xy, xy), dot(y, y)}};
}

/// Position and orientation; `column` are the columns of R.
template <class T>
struct PlacedPlatform {
  Vec<T> position;
  Vec<T> column[3];

  Vec<T> turned(const Vec<T>& v) const { return v.x * column[0] + v.y * column[1] + v.z * column[2]; }
  Vec<T> turned_back(const Vec<T>& v) const { return {dot(column[0], v), dot(column[1], v), dot(column[2], v)}; }
};

/// Compute the pose from three ball joints: R maps q2-q1, q3-q1 and their cross product. The reference point lies below
/// the joint plane along the platform's own normal, not along base z as in thesis (2.26).
template <class T>
inline PlacedPlatform<T> align(const Vec<T> (&joint)[3], const TriangleFrame<T>& frame, const Vec<T>& first) {
  const Vec<T> x = joint[1] - joint[0], y = joint[2] - joint[0], n = cross(x, y);
  PlacedPlatform<T> out;
  out.column[0] = frame.row[0].x * x + frame.row[1].x * y + frame.row[2].x * n;
  out.column[1] = frame.row[0].y * x + frame.row[1].y * y + frame.row[2].y * n;
  out.column[2] = frame.row[0].z * x + frame.row[1].z * y + frame.row[2].z * n;
  out.position = joint[0] - out.turned(first);
  return out;
}

/// Forces in equilibrium with a unit force along the bar; see reading_sensitivity in ball_bar.hpp.
template <class T>
struct LegForces {
  Vec<T> leg[6];  // from slider joint to ball joint, mm
  T share[6];     // share[k] * leg[k] is the force in leg k
  T determinant;  // of the cyclic system, and
  T scale;        // the square of its largest possible size: singular where determinant^2 is far below
};

// The bar's unit force n at ball = Q1 + alpha x + beta y + gamma x*y (x = Q2-Q1, y = Q3-Q1) is equivalent to forces h_i
// at the three ball joints, and remains so when forces m along the sides are added. They are chosen such that no joint
// force has a component along t_i, the normal of the plane of its two legs: a cyclic 3 x 3 system, the transpose of
// that of the loops (2.17).
template <class T>
inline LegForces<T> leg_forces(const Joints<T>& joints, const TriangleFrame<T>& frame,
                               const PlacedPlatform<T>& platform, const Vec<T>& ball, const Vec<T>& n) {
  LegForces<T> out;
  Vec<T> q[3], normal[3];
  for (int i = 0; i < 3; ++i) {
    q[i] = platform.position + platform.turned(joints.platform[i]);
    out.leg[2 * i] = q[i] - joints.base[2 * i];
    out.leg[2 * i + 1] = q[i] - joints.base[2 * i + 1];
    normal[i] = cross(out.leg[2 * i], out.leg[2 * i + 1]);
  }
  const Vec<T> x = q[1] - q[0], y = q[2] - q[0], from_first = ball - joints.platform[0];
  const T place[3] = {dot(frame.row[0], from_first), dot(frame.row[1], from_first), dot(frame.row[2], from_first)};
  Vec<T> force[3];
  force[1] = place[0] * n + place[2] * cross(y, n);
  force[2] = place[1] * n + place[2] * cross(n, x);
  force[0] = n - force[1] - force[2];

  const Vec<T> side[3] = {q[0] - q[1], q[1] - q[2], q[2] - q[0]};
  T a[3], d[3], g[3];
  for (int i = 0; i < 3; ++i) {
    a[i] = dot(side[i], normal[i]);
    d[i] = dot(side[i == 0 ? 2 : i - 1], normal[i]);
    g[i] = -dot(force[i], normal[i]);
  }
  T normal_squared[3];
  for (int i = 0; i < 3; ++i) normal_squared[i] = dot(normal[i], normal[i]);
  out.determinant = a[0] * a[1] * a[2] - d[0] * d[1] * d[2];
  out.scale = normal_squared[0] * normal_squared[1] * normal_squared[2] * frame.side_squared[0] *
              frame.side_squared[1] * frame.side_squared[2];
  const T inverse = 1.0 / out.determinant;
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1;
    const int k = j == 2 ? 0 : j + 1;
    const T m = inverse * (g[i] * a[j] * a[k] + d[i] * (g[k] * a[j] + d[k] * g[j]));
    force[i] = force[i] + m * side[i];
    force[j] = force[j] - m * side[i];
  }
  for (int i = 0; i < 3; ++i) {
    const T inverse_normal = 1.0 / normal_squared[i];
    out.share[2 * i] = inverse_normal * dot(cross(force[i], out.leg[2 * i + 1]), normal[i]);
    out.share[2 * i + 1] = inverse_normal * dot(cross(out.leg[2 * i], force[i]), normal[i]);
  }
  return out;
}

}  // namespace hexdbb::rssr
