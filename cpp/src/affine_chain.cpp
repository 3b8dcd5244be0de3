#include "affine_chain.hpp"

#include "lanes.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

struct LanesAt {
  using Number = Lanes;
  static Number of(const double* from) { return load(from); }
  static void put(const Number& value, double* to) { store(value, to); }
};

struct OneAt {
  using Number = double;
  static Number of(const double* from) { return *from; }
  static void put(const Number& value, double* to) { *to = value; }
};

/// Set the derivative by one value, of rates [first, last), in one row or a row of lanes.
template <class At>
inline void set_row(const AffineRate* first, const AffineRate* last, Eigen::Index row, Columns<const double> sliders_mm,
                    Columns<const double> sensitivity, double* derivative) {
  typename At::Number sum = {};
  for (const AffineRate* rate = first; rate != last; ++rate) {
    const typename At::Number sensitive = At::of(sensitivity.column(rate->port) + row);
    if (rate->slope == 0.0) {
      sum += rate->constant * sensitive;
    } else {
      sum += (rate->constant + rate->slope * At::of(sliders_mm.column(leg_of(rate->port)) + row)) * sensitive;
    }
  }
  At::put(sum, derivative + row);
}

}  // namespace

HEXDBB_MULTIVERSION_WIDE
void chain_affine(const std::vector<AffineRate>& rates, Eigen::Index rows, Columns<const double> sliders_mm,
                  Columns<const double> sensitivity, Eigen::Index values, Columns<double> derivative) noexcept {
  const AffineRate *first = rates.data(), *const end = first + rates.size();
  for (Eigen::Index value = 0; value < values; ++value) {
    const AffineRate* last = first;
    while (last != end && last->value == value) ++last;
    Eigen::Index row = 0;
    for (; row + kLanes <= rows; row += kLanes) {
      set_row<LanesAt>(first, last, row, sliders_mm, sensitivity, derivative.column(value));
    }
    for (; row < rows; ++row) set_row<OneAt>(first, last, row, sliders_mm, sensitivity, derivative.column(value));
    first = last;
  }
}

}  // namespace hexdbb
