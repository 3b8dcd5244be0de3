// Cosine and sine of an angle given in turns, to 2e-15. The turn is reduced exactly, without a call, a branch or a
// table, so that loops over samples are vectorized.
//
// x in [-1/4, 1/4] turns from the nearest half turn, then Taylor's series of sin and cos of 2 pi x.
#pragma once

namespace hexdbb {

template <class T>
struct CosSin {
  T cosine, sine;
};

/// Compute cosine and sine of 2 pi turns, for |turns| below 2^50; T is double or lanes of doubles.
template <class T>
inline CosSin<T> cos_sin_of_turns(const T& turns) {
  // Adding and subtracting 1.5 * 2^52 rounds to a whole number (round-to-nearest mode, as everywhere here).
  constexpr double kRound = 6755399441055744.0;
  const T half_turns = (2.0 * turns + kRound) - kRound;
  const T odd = half_turns - 2.0 * ((0.5 * half_turns + kRound) - kRound);  // -1, 0 or 1
  const T sign = 1.0 - 2.0 * odd * odd;
  const T angle = 6.283185307179586476925 * (turns - 0.5 * half_turns), u = angle * angle;
  const T s =
      1.0 + u * (-1.0 / 6.0 +
                 u * (1.0 / 120.0 +
                      u * (-1.0 / 5040.0 +
                           u * (1.0 / 362880.0 +
                                u * (-1.0 / 39916800.0 +
                                     u * (1.0 / 6227020800.0 +
                                          u * (-1.0 / 1307674368000.0 +
                                               u * (1.0 / 355687428096000.0 + u * (-1.0 / 121645100408832000.0)))))))));
  const T c =
      1.0 + u * (-1.0 / 2.0 +
                 u * (1.0 / 24.0 +
                      u * (-1.0 / 720.0 +
                           u * (1.0 / 40320.0 +
                                u * (-1.0 / 3628800.0 +
                                     u * (1.0 / 479001600.0 + u * (-1.0 / 87178291200.0 +
                                                                   u * (1.0 / 20922789888000.0 +
                                                                        u * (-1.0 / 6402373705728000.0 +
                                                                             u * (1.0 / 2432902008176640000.0))))))))));
  return {sign * c, sign * angle * s};
}

}  // namespace hexdbb
