#include "affine_chain.hpp"

#include "lanes.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

template <class L>
struct LanesAt {
  using Number = L;
  static constexpr Eigen::Index kRows = kLanesIn<L>;
  static Number of(const double* from) { return load<L>(from); }
  static void put(const Number& value, double* to) { store(value, to); }
};

struct OneAt {
  using Number = double;
  static constexpr Eigen::Index kRows = 1;
  static Number of(const double* from) { return *from; }
  static void put(const Number& value, double* to) { *to = value; }
};

/// Set the derivative by one value, of rates [first, last), in `Count` rows or rows of lanes, side by side.
template <class At, int Count>
inline void set_rows(const AffineRate* first, const AffineRate* last, Eigen::Index row,
                     Columns<const double> sliders_mm, Columns<const double> sensitivity, double* derivative) {
  typename At::Number sum[Count] = {};
  for (const AffineRate* rate = first; rate != last; ++rate) {
    const double* const sensitive = sensitivity.column(rate->port) + row;
    if (rate->slope == 0.0) {
      for (int i = 0; i < Count; ++i) sum[i] += rate->constant * At::of(sensitive + i * At::kRows);
      continue;
    }
    const double* const slider_mm = sliders_mm.column(leg_of(rate->port)) + row;
    for (int i = 0; i < Count; ++i) {
      const Eigen::Index at = i * At::kRows;
      sum[i] += (rate->constant + rate->slope * At::of(slider_mm + at)) * At::of(sensitive + at);
    }
  }
  for (int i = 0; i < Count; ++i) At::put(sum[i], derivative + row + i * At::kRows);
}

template <class L>
inline void chain_affine_in(const std::vector<AffineRate>& rates, Eigen::Index rows, Columns<const double> sliders_mm,
                            Columns<const double> sensitivity, Eigen::Index values, Columns<double> derivative) {
  constexpr int kTogether = 4;  // a rate is read once for so many rows of lanes
  const AffineRate *first = rates.data(), *const end = first + rates.size();
  for (Eigen::Index value = 0; value < values; ++value) {
    const AffineRate* last = first;
    while (last != end && last->value == value) ++last;
    double* const out = derivative.column(value);
    Eigen::Index row = 0;
    for (; row + kTogether * kLanesIn<L> <= rows; row += kTogether * kLanesIn<L>) {
      set_rows<LanesAt<L>, kTogether>(first, last, row, sliders_mm, sensitivity, out);
    }
    for (; row < rows; ++row) set_rows<OneAt, 1>(first, last, row, sliders_mm, sensitivity, out);
    first = last;
  }
}

}  // namespace

HEXDBB_BY_LANES(chain_affine,
                (const std::vector<AffineRate>& rates, Eigen::Index rows, Columns<const double> sliders_mm,
                 Columns<const double> sensitivity, Eigen::Index values, Columns<double> derivative),
                (rates, rows, sliders_mm, sensitivity, values, derivative))

}  // namespace hexdbb
