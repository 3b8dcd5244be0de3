// A position (x, y, z), of the cup or the ball, that differs between set-ups: one for each fixing of the tool cup.
#pragma once

#include <optional>
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
    for_each_run(block, [&](Eigen::Index first, Eigen::Index count, int mount) {
      for (int axis = 0; axis < 3; ++axis) {
        const double value = values[3 * mount + axis];
        if (value != 0.0) ports.col(first_port_ + axis).segment(first, count).array() += value;
      }
    });
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for_each_run(block, [&](Eigen::Index first, Eigen::Index count, int mount) {
      for (int axis = 0; axis < 3; ++axis) {
        jacobian.col(3 * mount + axis).segment(first, count) =
            sensitivity.col(first_port_ + axis).segment(first, count);
      }
    });
  }

  /// With one set-up for all samples its place is as constant as the machine's errors.
  std::optional<AffinePush> affine(Values values) const override {
    if (info().elements.size() != 1) return std::nullopt;
    AffinePush out;
    for (int axis = 0; axis < 3; ++axis) {
      out.constant.value[first_port_ + axis] = values[axis];
      out.rates.push_back({axis, first_port_ + axis, 1.0});
    }
    return out;
  }

 private:
  /// Call visit(first row, number of rows, mount) for neighbouring rows of one mount.
  template <class Visit>
  static void for_each_run(const SampleBlock& block, Visit visit) {
    for (Eigen::Index row = 0, end = 0; row < block.count; row = end) {
      while (end < block.count && block.mount(end) == block.mount(row)) ++end;
      visit(row, end - row, block.mount(row));
    }
  }

  static EffectInfo with_elements(EffectInfo info, int mounts) {
    info.element_kind = "mount";
    for (int element = 0; element < mounts; ++element) info.elements.push_back(std::to_string(element + 1));
    return info;
  }

  int first_port_;
};

}  // namespace hexdbb::effects
