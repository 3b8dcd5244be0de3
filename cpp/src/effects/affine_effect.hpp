// An effect whose pushes are affine in the sliders' coordinates: all it does follows from affine().
#pragma once

#include "affine_chain.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

class AffineEffect : public Effect {
 public:
  using Effect::Effect;

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    const AffinePush sum = *affine(values);
    for (int port = 0; port < port::kCount; ++port) {
      const double constant = sum.constant.value[port], slope = sum.slope.value[port];
      if (constant != 0.0) ports.col(port).array() += constant;
      if (slope != 0.0) ports.col(port) += slope * block.slider_mm(leg_of(port));
    }
  }

  void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
             JacobianBlock jacobian) const override {
    const SliderTable& sliders_mm = block.samples.sliders_mm;
    chain_affine(affine(values)->rates, block.count, {sliders_mm.data() + block.first, sliders_mm.rows()},
                 {sensitivity.data(), sensitivity.outerStride()}, jacobian.cols(),
                 {jacobian.data(), jacobian.outerStride()});
  }
};

}  // namespace hexdbb::effects
