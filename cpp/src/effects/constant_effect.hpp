// An effect in which every value pushes ports by a constant factor, whatever the state of the sample.
#pragma once

#include <utility>
#include <vector>

#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

/// Value `value` pushes port `port` by `factor` per unit.
struct Link {
  int value;
  int port;
  double factor;
};

class ConstantEffect : public Effect {
 public:
  ConstantEffect(EffectInfo info, std::vector<Link> links) : Effect(std::move(info)), links_(std::move(links)) {}

  void push(const SampleBlock&, Values values, PortBlock ports) const override {
    for (const Link& link : links_) ports.col(link.port).array() += link.factor * values[link.value];
  }

  void chain(const SampleBlock&, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (const Link& link : links_) jacobian.col(link.value) += link.factor * sensitivity.col(link.port);
  }

 private:
  std::vector<Link> links_;
};

/// Return an effect whose value j pushes port first_port + j by `factor` per unit.
inline EffectPtr one_to_one(EffectInfo info, int first_port, double factor = 1.0) {
  std::vector<Link> links;
  for (int value = 0; value < info.size(); ++value) links.push_back({value, first_port + value, factor});
  return std::make_shared<ConstantEffect>(std::move(info), std::move(links));
}

}  // namespace hexdbb::effects
