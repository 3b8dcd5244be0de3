// A place (x, y, z) that is another one in every set-up: of the cup per mount, of the ball per circle.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "hexdbb/effect.hpp"

namespace hexdbb {

class PlacePerSetUp : public Effect {
 public:
  using IndexOf = int (*)(const Samples& samples, Eigen::Index row);

  /// Element e + 1 of `count` pushes the three ports from `first_port` in samples whose index is e.
  PlacePerSetUp(EffectInfo info, int count, int first_port, std::string index_name, IndexOf index_of)
      : info_(std::move(info)), first_port_(first_port), index_name_(std::move(index_name)), index_of_(index_of) {
    for (int element = 0; element < count; ++element) info_.elements.push_back(std::to_string(element + 1));
  }

  const EffectInfo& info() const override { return info_; }

  void require(const Samples& samples) const override {
    Effect::require(samples);
    const int count = static_cast<int>(info_.elements.size());
    for (Eigen::Index row = 0; row < samples.size(); ++row) {
      const int index = index_of_(samples, row);
      if (index < 0 || index >= count) {
        throw std::invalid_argument(index_name_ + "[" + std::to_string(row) + "] is " + std::to_string(index) +
                                    ", expected 0 to " + std::to_string(count - 1) + ", which " + info_.name +
                                    " knows");
      }
    }
  }

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (Eigen::Index row = 0; row < block.count; ++row) {
      ports.block<1, 3>(row, first_port_) += values.segment<3>(3 * index(block, row)).transpose();
    }
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (Eigen::Index row = 0; row < block.count; ++row) {
      jacobian.block<1, 3>(row, 3 * index(block, row)) = sensitivity.block<1, 3>(row, first_port_);
    }
  }

 private:
  int index(const SampleBlock& block, Eigen::Index row) const { return index_of_(block.samples, block.first + row); }

  EffectInfo info_;
  int first_port_;
  std::string index_name_;
  IndexOf index_of_;
};

}  // namespace hexdbb
