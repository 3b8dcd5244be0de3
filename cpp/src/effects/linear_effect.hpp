// An effect that is linear in its values: value v pushes port p by factor * shape(state), for one or more shapes.
//
// A shape is a function of the samples' state, computed once per block.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "block_column.hpp"
#include "constant_effect.hpp"

namespace hexdbb::effects {

struct Shape {
  std::function<BlockColumn(const SampleBlock&)> of;
  std::vector<Link> links;
};

class LinearEffect : public Effect {
 public:
  LinearEffect(EffectInfo info, std::vector<Shape> shapes) : Effect(std::move(info)), shapes_(std::move(shapes)) {}

  void push(const SampleBlock& block, Values values, PortBlock ports) const override {
    for (const Shape& shape : shapes_) {
      if (!pushes(shape, values)) continue;
      const BlockColumn column = shape.of(block);
      for (const Link& link : shape.links) {
        ports.col(link.port).array() += (link.factor * values[link.value]) * column;
      }
    }
  }

  void chain(const SampleBlock& block, Values, ConstPortBlock sensitivity, JacobianBlock jacobian) const override {
    jacobian.setZero();
    for (const Shape& shape : shapes_) {
      const BlockColumn column = shape.of(block);
      for (const Link& link : shape.links) {
        jacobian.col(link.value).array() += link.factor * sensitivity.col(link.port).array() * column;
      }
    }
  }

 private:
  static bool pushes(const Shape& shape, Values values) {
    for (const Link& link : shape.links) {
      if (values[link.value] != 0.0) return true;
    }
    return false;
  }

  std::vector<Shape> shapes_;
};

}  // namespace hexdbb::effects
