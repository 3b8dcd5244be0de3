#include "hexdbb/tabulated_effect.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "block_column.hpp"

namespace hexdbb {

namespace {

BlockColumn rows_of(const SampleBlock& block, const Eigen::VectorXd& table) {
  const Eigen::VectorXi& row = block.samples.state.row;
  if (row.size() == 0) return table.segment(block.first, block.count).array();
  BlockColumn out(block.count);
  for (Eigen::Index at = 0; at < block.count; ++at) out[at] = table[row[block.first + at]];
  return out;
}

}  // namespace

TabulatedEffect::TabulatedEffect(EffectInfo info, std::vector<TabulatedLink> links)
    : Effect(std::move(info)), links_(std::move(links)) {
  count_ = links_.empty() ? 0 : links_.front().per_unit.size();
  for (const TabulatedLink& link : links_) {
    if (link.value < 0 || link.value >= this->info().size() || link.port < 0 || link.port >= port::kCount) {
      throw std::invalid_argument(this->info().name + ": value " + std::to_string(link.value) + " or port " +
                                  std::to_string(link.port) + " does not exist (expected values 0 to " +
                                  std::to_string(this->info().size() - 1) + ", ports 0 to " +
                                  std::to_string(port::kCount - 1) + ")");
    }
    if (link.per_unit.size() != count_ || !link.per_unit.allFinite()) {
      throw std::invalid_argument(this->info().name + ": its table needs " + std::to_string(count_) +
                                  " finite numbers per column");
    }
  }
}

std::shared_ptr<const TabulatedEffect> TabulatedEffect::of_rows(const Eigen::VectorXi& rows) const {
  std::vector<TabulatedLink> links;
  links.reserve(links_.size());
  for (const TabulatedLink& link : links_) links.push_back({link.value, link.port, link.per_unit(rows)});
  return std::make_shared<TabulatedEffect>(info(), std::move(links));
}

void TabulatedEffect::require(const Samples& samples) const {
  const Eigen::VectorXi& row = samples.state.row;
  const bool fits = row.size() == 0 ? samples.size() == count_ : row.minCoeff() >= 0 && row.maxCoeff() < count_;
  if (!fits) {
    throw std::invalid_argument("effect " + this->info().name + " is tabulated for " + std::to_string(count_) +
                                " samples, not for these (expected the same samples or rows of them)");
  }
}

void TabulatedEffect::push(const SampleBlock& block, Values values, PortBlock ports) const {
  for (const TabulatedLink& link : links_) {
    if (values[link.value] == 0.0) continue;
    ports.col(link.port).array() += values[link.value] * rows_of(block, link.per_unit);
  }
}

void TabulatedEffect::chain(const SampleBlock& block, Values, ConstPortBlock sensitivity,
                            JacobianBlock jacobian) const {
  jacobian.setZero();
  for (const TabulatedLink& link : links_) {
    jacobian.col(link.value).array() += sensitivity.col(link.port).array() * rows_of(block, link.per_unit);
  }
}

Model of_rows(const Model& model, const Eigen::VectorXi& rows) {
  Model out = model;
  for (Term& term : out.terms) {
    if (const auto* table = dynamic_cast<const TabulatedEffect*>(term.effect.get())) term.effect = table->of_rows(rows);
  }
  return out;
}

bool has_table(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(), [](const Term& term) {
    return dynamic_cast<const TabulatedEffect*>(term.effect.get()) != nullptr;
  });
}

}  // namespace hexdbb
