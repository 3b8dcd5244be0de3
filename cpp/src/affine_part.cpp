#include "affine_part.hpp"

#include "affine_chain.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

/// Set a port's column of a block to constant + slope s.
HEXDBB_MULTIVERSION
void set_column(double constant, double slope, const double* slider_mm, double* out) noexcept {
  for (Eigen::Index row = 0; row < Block::kRows; ++row) out[row] = constant + slope * slider_mm[row];
}

/// Add residual times sensitivity for all ports, and times the slider's coordinate for some; whole lanes of rows, as they
/// are solved.
template <class L>
inline void add_products_in(const Block& block, Eigen::Index rows, const double* residual,
                            const std::vector<int>& sloping, PortGradient& sums) {
  for (int port = 0; port < port::kCount; ++port) {
    const double* const sensitivity = &block.sensitivity(0, port);
    L sum = {};
    for (Eigen::Index row = 0; row < rows; row += kLanesIn<L>) {
      sum += load<L>(residual + row) * load<L>(sensitivity + row);
    }
    sums.constant.value[port] += sum_of(sum);
  }
  for (const int port : sloping) {
    const double *const sensitivity = &block.sensitivity(0, port), *const slider_mm =
                                                                       &block.sliders_mm(0, leg_of(port));
    L sum = {};
    for (Eigen::Index row = 0; row < rows; row += kLanesIn<L>) {
      sum += load<L>(residual + row) * load<L>(sensitivity + row) * load<L>(slider_mm + row);
    }
    sums.slope.value[port] += sum_of(sum);
  }
}

HEXDBB_BY_LANES(add_products,
                (const Block& block, Eigen::Index rows, const double* residual, const std::vector<int>& sloping,
                 PortGradient& sums),
                (block, rows, residual, sloping, sums))

}  // namespace

AffinePart::AffinePart(const Model& model) {
  bool is_sloping[port::kCount] = {};
  for (const Term& term : model.terms) {
    terms_.push_back(term.effect->affine(term.values));
    is_all_ = is_all_ && terms_.back();
    if (!terms_.back()) continue;
    sum_.constant.value += terms_.back()->constant.value;
    sum_.slope.value += terms_.back()->slope.value;
    for (const AffineRate& rate : terms_.back()->rates) is_sloping[rate.port] |= rate.slope != 0.0;
  }
  for (int port = 0; port < port::kCount; ++port) {
    if (!is_constant(port)) varying_.push_back(port);
    if (is_sloping[port]) sloping_.push_back(port);
  }
}

void AffinePart::push(Block& block) {
  if (is_fresh_) {
    for (int port = 0; port < port::kCount; ++port) block.ports.col(port).setConstant(sum_.constant.value[port]);
  }
  is_fresh_ = false;
  for (const int port : varying_) {
    const double slope = sum_.slope.value[port];
    const int leg = slope != 0.0 ? leg_of(port) : 0;
    set_column(sum_.constant.value[port], slope, &block.sliders_mm(0, leg), &block.ports(0, port));
  }
}

void AffinePart::chain(std::size_t term, const Block& block, Eigen::Index rows, JacobianBlock jacobian) const {
  chain_affine(terms_[term]->rates, rows, {block.sliders_mm.data(), Block::kRows},
               {block.sensitivity.data(), Block::kRows}, jacobian.cols(), {jacobian.data(), jacobian.outerStride()});
}

void AffinePart::add(const Block& block, Eigen::Index rows, const double* residual, PortGradient& sums) const {
  add_products(block, rows, residual, sloping_, sums);
}

Eigen::VectorXd AffinePart::gradient(std::size_t term, Eigen::Index values, const PortGradient& sums) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(values);
  for (const AffineRate& rate : terms_[term]->rates) {
    out[rate.value] += rate.constant * sums.constant.value[rate.port] + rate.slope * sums.slope.value[rate.port];
  }
  return out;
}

}  // namespace hexdbb
