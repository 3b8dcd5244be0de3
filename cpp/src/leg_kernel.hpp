// Inverse kinematics of the six legs side by side, and what folded effects push at them.
#pragma once

#include "hexdbb/leg_ports.hpp"
#include "hexdbb/slider_polynomials.hpp"
#include "hexdbb/slider_waves.hpp"
#include "sample_kernel.hpp"
#include "turns.hpp"

namespace hexdbb::rssr {

static_assert(kLegLanes == kLanes);

inline Lanes load(const LegRow& row) { return hexdbb::load(row.of); }
inline Vec<Lanes> load3(const LegRow (&rows)[3]) { return {load(rows[0]), load(rows[1]), load(rows[2])}; }
inline void store3(const Vec<Lanes>& v, LegRow (&rows)[3]) {
  store(v.x, rows[0].of);
  store(v.y, rows[1].of);
  store(v.z, rows[2].of);
}

inline Lanes magnitude(const Lanes& v) { return v < 0.0 ? -v : v; }
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

/// Return the largest magnitude. A NaN may be left out: callers have excluded it.
inline double largest_magnitude(const Lanes& v) {
  typedef long long Order __attribute__((vector_size(sizeof(Lanes))));
  Lanes out = magnitude(v);
  out = larger(out, __builtin_shuffle(out, Order{4, 5, 6, 7, 0, 1, 2, 3}));
  out = larger(out, __builtin_shuffle(out, Order{2, 3, 0, 1, 6, 7, 4, 5}));
  out = larger(out, __builtin_shuffle(out, Order{1, 0, 3, 2, 5, 4, 7, 6}));
  return out[0];
}

/// Turn vectors of the platform into the base frame.
template <class T>
inline Vec<T> turned(const Matrix3& r, const Vec<T>& v) {
  return {r(0, 0) * v.x + r(0, 1) * v.y + r(0, 2) * v.z, r(1, 0) * v.x + r(1, 1) * v.y + r(1, 2) * v.z,
          r(2, 0) * v.x + r(2, 1) * v.y + r(2, 2) * v.z};
}

/// Return the vector from a guideway's vertex to a ball joint of the platform.
template <class T>
inline Vec<T> reach_of(const Pose& pose, const Vec<T>& joint, const Vec<T>& vertex) {
  const Vec<T> at = turned(pose.rotation, joint);
  return {at.x + (pose.position.x() - vertex.x), at.y + (pose.position.y() - vertex.y),
          at.z + (pose.position.z() - vertex.z)};
}

/// Slider coordinate; `half_span_squared` is not positive where the leg is too short.
template <class T>
struct LegSolution {
  T slider_mm, half_span_squared;
};

/// Solve (2.6)-(2.8): s = f -/+ sqrt(l^2 - r^2), `side` the sign.
template <class T>
inline LegSolution<T> solve_leg(const Vec<T>& reach, const Vec<T>& direction, const T& length, const T& side) {
  const T foot = dot(reach, direction);
  const T half_span_squared = length * length - (dot(reach, reach) - foot * foot);
  return {foot + side * root(half_span_squared), half_span_squared};
}

/// Return the first leg that is too short, or -1.
inline int too_short(const LegSolution<Lanes>& found) {
  const Lanes is_short = found.half_span_squared > 0.0 ? Lanes{} : lanes_of(1.0);  // of NaN too
  if (largest_magnitude(is_short) == 0.0) return -1;
  int leg = 0;
  while (is_short[leg] == 0.0) ++leg;
  return leg;
}

/// Solve the nominal legs at a pose's reach.
inline LegSolution<Lanes> solve_nominal(const NominalLegs& legs, const Vec<Lanes>& reach) {
  return solve_leg(reach, load3(legs.direction), load(legs.length), load(legs.side));
}

/// Solve the legs under pushes at their ports.
inline LegSolution<Lanes> solve_pushed(const NominalLegs& legs, const Matrix3& rotation, const Vec<Lanes>& reach,
                                       const LegPorts& push) {
  const auto row = [&](int quantity) { return hexdbb::load(push.row(quantity)); };
  const auto row3 = [&](int first) { return Vec<Lanes>{row(first), row(first + 1), row(first + 2)}; };
  const Vec<Lanes> from = reach + turned(rotation, row3(LegPorts::kPlatformJoint)) - row3(LegPorts::kSliderJoint);
  LegSolution<Lanes> out =
      solve_leg(from, load3(legs.direction), load(legs.length) + row(LegPorts::kLeg), load(legs.side));
  out.slider_mm -= row(LegPorts::kSlider);
  return out;
}

/// Compute the push of polynomials and waves with the sliders at these coordinates.
inline void push_folded(const SliderPolynomials& polynomials, const SliderWaves& waves, const Lanes& sliders_mm,
                        LegPorts& out) {
  const Lanes u = (sliders_mm - load(polynomials.middle_mm())) * load(polynomials.per_half());
  const auto& settled = polynomials.settled();
  for (int quantity = 0; quantity < LegPorts::kQuantities; ++quantity) {
    const auto c = [&](int power) { return hexdbb::load(settled[power].row(quantity)); };
    store(c(0) + u * (c(1) + u * c(2)), out.row(quantity));
  }
  if (waves.waves().empty()) return;
  const auto [c, s] = cos_sin_of_turns(Lanes(waves.turns_per_mm() * sliders_mm));
  const Lanes c2 = c * c - s * s, s2 = 2.0 * c * s;
  for (const SliderWave& wave : waves.waves()) {
    double* const row = out.row(wave.quantity);
    const Lanes once = load(wave.cosine[0]) * c + load(wave.sine[0]) * s;
    store(hexdbb::load(row) + once + load(wave.cosine[1]) * c2 + load(wave.sine[1]) * s2, row);
  }
}

}  // namespace hexdbb::rssr
