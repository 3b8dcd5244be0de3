// An effect in which every value pushes ports by a constant factor, whatever the state of the sample.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "columns.hpp"
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
  ConstantEffect(EffectInfo info, std::vector<Link> links) : Effect(std::move(info)), links_(std::move(links)) {
    std::stable_sort(links_.begin(), links_.end(),
                     [](const Link& one, const Link& other) { return one.value < other.value; });
  }

  void push(const SampleBlock&, Values values, PortBlock ports) const override {
    for (const Link& link : links_) {
      const double pushed = link.factor * values[link.value];
      if (pushed != 0.0) ports.col(link.port).array() += pushed;
    }
  }

  void chain(const SampleBlock&, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    auto link = links_.begin();
    for (Eigen::Index value = 0; value < jacobian.cols(); ++value) {
      auto add = &set_scaled;
      if (link == links_.end() || link->value != value) jacobian.col(value).setZero();
      for (; link != links_.end() && link->value == value; ++link, add = &add_scaled) {
        add(jacobian.rows(), link->factor, sensitivity.col(link->port).data(), jacobian.col(value).data());
      }
    }
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
