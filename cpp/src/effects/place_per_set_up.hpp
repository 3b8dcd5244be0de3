// A position (x, y, z), of the cup or the ball, that differs between set-ups: one for each fixing of the tool cup.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "hexdbb/effect.hpp"

namespace hexdbb::effects {

class PlacePerSetUp : public Effect {
 public:
  /// Element e + 1 pushes the three ports from `first_port` in samples of mount e.
  PlacePerSetUp(EffectInfo info, int mounts, int first_port)
      : Effect(with_elements(std::move(info), mounts)), first_port_(first_port) {}

  void require(const Samples& samples) const override {
    Effect::require(samples);
    const int count = static_cast<int>(info().elements.size());
    for (Eigen::Index row = 0; row < samples.size(); ++row) {
      const int index = samples.mount[row];
      if (index < 0 || index >= count) {
        throw std::invalid_argument("mount[" + std::to_string(row) + "] is " + std::to_string(index) +
                                    ", expected 0 to " + std::to_string(count - 1) + ", the mounts of " + info().name);
      }
    }
  }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      ports.block<1, 3>(row, first_port_) += values.segment<3>(3 * block.mount(row)).transpose();
    }
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (Eigen::Index row = 0; row < block.count; ++row) {
      jacobian.block<1, 3>(row, 3 * block.mount(row)) = sensitivity.block<1, 3>(row, first_port_);
    }
  }

 private:
  static EffectInfo with_elements(EffectInfo info, int mounts) {
    info.element_kind = "mount";
    for (int element = 0; element < mounts; ++element) info.elements.push_back(std::to_string(element + 1));
    return info;
  }

  int first_port_;
};

}  // namespace hexdbb::effects
