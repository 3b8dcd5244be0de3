// An effect given as numbers: its push per unit of each value, for every sample of one table. A user's own effect
// enters the engine this way, and is then fitted, ranked and reported like any other.
#pragma once

#include <memory>

#include "hexdbb/effect.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// Value `value` pushes port `port` (column of Ports) by `per_unit` in each sample of the table.
struct TabulatedLink {
  int value;
  int port;
  Eigen::VectorXd per_unit;
};

/// Samples taken from the table by Samples::rows() or every() use their own rows of it.
class TabulatedEffect : public Effect {
 public:
  /// Throw std::invalid_argument where a link names a value or port that does not exist, columns differ in length, or a
  /// number is not finite.
  TabulatedEffect(EffectInfo info, std::vector<TabulatedLink> links);

  /// Return the same for some rows of its table alone, in their order.
  std::shared_ptr<const TabulatedEffect> of_rows(const Eigen::VectorXi& rows) const;

  void require(const Samples& samples) const override;
  void push(const SampleBlock& block, Values values, PortBlock ports) const override;
  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override;

 private:
  std::vector<TabulatedLink> links_;
  Eigen::Index count_ = 0;
};

/// Return a model of some rows of a table, whose tabulated effects hold these rows alone: a pass over few of a table's
/// rows reads as much memory as one over all. The samples then state no rows (Samples::state).
Model of_rows(const Model& model, const Eigen::VectorXi& rows);

/// Return whether a model has a tabulated effect.
bool has_table(const Model& model);

}  // namespace hexdbb
