// An effect given as numbers: its push per unit of each value, for every sample of one table. A user's own effect
// enters the engine this way, and is then fitted, ranked and reported like any other.
#pragma once

#include "hexdbb/effect.hpp"

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

  void require(const Samples& samples) const override;
  void push(const SampleBlock& block, Values values, PortBlock ports) const override;
  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override;

 private:
  std::vector<TabulatedLink> links_;
  Eigen::Index count_ = 0;
};

}  // namespace hexdbb
