// Samples of a record, one row each: all that effects and prediction may depend on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hexdbb/ball_bar.hpp"
#include "hexdbb/state.hpp"

namespace hexdbb {

constexpr ColumnInfo kSlidersColumn = {"sliders_mm", "mm", "slider coordinate as the drive's encoder reports it",
                                       ColumnOf::kSlider};

struct Samples {
  SliderTable sliders_mm;  // as the drives' encoders report them
  Eigen::VectorXi set_up;  // index into set_ups
  Eigen::VectorXi mount;   // 0-based fixing of the tool cup
  std::vector<SetUp> set_ups;
  State state = {};  // optional columns
  // How far sliders_mm are moved on since the encoders were read, where they are those of the reading; otherwise empty.
  SliderTable moved_on_mm = {};

  Eigen::Index size() const { return sliders_mm.rows(); }

  /// Return every `stride`-th row, beginning with the first.
  Samples every(Eigen::Index stride) const;

  /// Return some rows; the state remembers which, so that an effect tabulated for the whole remains valid for the part.
  Samples rows(const std::vector<Eigen::Index>& which) const;

  /// Throw std::invalid_argument, naming the column and row, where lengths differ or an index is out of range.
  void validate() const;
};

/// Rows [first, first + count) of some samples.
struct SampleBlock {
  const Samples& samples;
  Eigen::Index first;
  Eigen::Index count;

  auto slider_mm(int k) const { return samples.sliders_mm.col(k).segment(first, count); }
  int mount(Eigen::Index row) const { return samples.mount[first + row]; }

  /// Return this block's rows of a column of the state, or of slider k's column of a table.
  auto of(const Eigen::VectorXd& column) const { return column.segment(first, count); }
  auto of(const SliderTable& table, int k) const { return table.col(k).segment(first, count); }
};

}  // namespace hexdbb
