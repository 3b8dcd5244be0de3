// The part of a model whose pushes are affine in the sliders' coordinates (affine_push.hpp), over blocks of samples: one
// operation per port whatever the number of effects, and none at ports where all of it is constant.
#pragma once

#include <optional>
#include <vector>

#include "block.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// Sums over rows of samples of residual times the reading's sensitivity at each port, and the same times the coordinate
/// of the slider of the port's leg.
struct PortGradient {
  Ports constant, slope;
};

class AffinePart {
 public:
  explicit AffinePart(const Model& model);

  /// Return whether a term of the model is in this part.
  bool has(std::size_t term) const { return terms_[term].has_value(); }

  /// Return whether all rows of all blocks have the same push at a port, that of the model's other terms included.
  bool is_constant(int port) const { return is_all_ && sum_.slope.value[port] == 0.0; }

  /// Set the ports of a block, always the same block. Constant ports are set by the first call only.
  void push(Block& block);

  /// Set derivatives of the block's readings by the values of a term of this part.
  void chain(std::size_t term, const Block& block, Eigen::Index rows, JacobianBlock jacobian) const;

  /// Add the first rows of a block to the sums; `residual` has zeros for the others.
  void add(const Block& block, Eigen::Index rows, const double* residual, PortGradient& sums) const;

  /// Compute J'r of the values of a term of this part.
  Eigen::VectorXd gradient(std::size_t term, Eigen::Index values, const PortGradient& sums) const;

 private:
  std::vector<std::optional<AffinePush>> terms_;  // of the model; nothing where a term is not affine
  AffinePush sum_;                                // its rates stay empty
  bool is_all_ = true;                            // of the model
  std::vector<int> varying_;                      // ports that are not constant
  std::vector<int> sloping_;  // ports that some value pushes in proportion to the slider's coordinate
  bool is_fresh_ = true;
};

}  // namespace hexdbb
