// An effect whose every value pushes ports by a constant factor, whatever the state of the sample.
#pragma once

#include <utility>
#include <vector>

#include "hexdbb/effect.hpp"

namespace hexdbb {

/// Value `value` pushes port `port` by `factor` per unit.
struct Link {
  int value;
  int port;
  double factor;
};

class ConstantEffect : public Effect {
 public:
  ConstantEffect(EffectInfo info, std::vector<Link> links) : info_(std::move(info)), links_(std::move(links)) {}

  const EffectInfo& info() const override { return info_; }

  void push(const SampleBlock&, Values values, PortBlock ports) const override {
    for (const Link& link : links_) ports.col(link.port).array() += link.factor * values[link.value];
  }

  void chain(const SampleBlock&, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (const Link& link : links_) jacobian.col(link.value) += link.factor * sensitivity.col(link.port);
  }

 private:
  EffectInfo info_;
  std::vector<Link> links_;
};

}  // namespace hexdbb
