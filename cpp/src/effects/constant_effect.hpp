// An effect in which every value pushes ports by a constant factor, whatever the state of the sample.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "affine_effect.hpp"

namespace hexdbb::effects {

/// Value `value` pushes port `port` by `factor` per unit.
struct Link {
  int value;
  int port;
  double factor;
};

class ConstantEffect : public AffineEffect {
 public:
  ConstantEffect(EffectInfo info, std::vector<Link> links) : AffineEffect(std::move(info)), links_(std::move(links)) {
    std::stable_sort(links_.begin(), links_.end(),
                     [](const Link& one, const Link& other) { return one.value < other.value; });
  }

  std::optional<AffinePush> affine(Values values) const override {
    AffinePush out;
    for (const Link& link : links_) {
      out.constant.value[link.port] += link.factor * values[link.value];
      out.rates.push_back({link.value, link.port, link.factor});
    }
    return out;
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
