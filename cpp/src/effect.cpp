#include "hexdbb/effect.hpp"

#include <algorithm>
#include <stdexcept>

#include "block.hpp"

namespace hexdbb {

void Effect::require(const Samples& samples) const {
  for (const std::string& column : info().needs) require_column(samples.state, column, "effect " + info().name);
}

std::vector<Eigen::MatrixXd> push_derivatives(const Effect& effect, const Samples& samples, Values values) {
  const int size = effect.info().size();
  if (values.size() != size) {
    throw std::invalid_argument("values has " + std::to_string(values.size()) + " entries, expected " +
                                std::to_string(size) + " as effect " + effect.info().name + " has");
  }
  effect.require(samples);
  std::vector<Eigen::MatrixXd> out(port::kCount, Eigen::MatrixXd(samples.size(), size));
  // A reading that is the push at one port: the chain rule then yields that port's derivative.
  Eigen::Matrix<double, Eigen::Dynamic, port::kCount> one_port(Block::kRows, int{port::kCount});
  for (Eigen::Index first = 0; first < samples.size(); first += Block::kRows) {
    const SampleBlock block{samples, first, std::min<Eigen::Index>(Block::kRows, samples.size() - first)};
    for (int port = 0; port < port::kCount; ++port) {
      one_port.setZero();
      one_port.col(port).setOnes();
      effect.chain(block, values, one_port.topRows(block.count), out[port].middleRows(first, block.count));
    }
  }
  return out;
}

}  // namespace hexdbb
