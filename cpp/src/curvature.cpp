#include "curvature.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <memory>
#include <vector>

namespace hexdbb {

namespace {

class Curvature {
 public:
  Curvature(const Model& model, const Samples& samples, const Accumulator& solved, const Unknowns& unknowns,
            const Eigen::MatrixXd& spread, double noise_mm)
      : model_(model), unknowns_(unknowns) {
    const Eigen::Index stride = std::max<Eigen::Index>(1, samples.size() / kRows);
    rows_ = samples.every(stride);
    no_reading_.setZero(rows_.size());
    accumulator_ = std::make_unique<Accumulator>(rows_, no_reading_, unknowns.columns);
    accumulator_->start_from(solved, stride);
    accumulator_->keep_jacobian();
    here_ = jacobian(Eigen::VectorXd::Zero(unknowns.size()));
    gain_ = (static_cast<double>(stride) / (noise_mm * noise_mm)) * spread * here_.transpose();
    const std::vector<Eigen::Index> bending = that_bend(model, unknowns);
    steps_.resize(unknowns.size(), 0);
    if (bending.empty()) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(spread(bending, bending));
    const Eigen::VectorXd sigma = principal.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const Eigen::Index weak = (sigma.array() > kWeak).count();  // eigenvalues rise
    // One standard deviation along each; the values that do not bend follow as the covariance ties them to it.
    steps_ = spread(Eigen::all, bending) * principal.eigenvectors().rightCols(weak) *
             sigma.tail(weak).cwiseInverse().asDiagonal();
  }

  Eigen::MatrixXd spread() const {
    const Eigen::Index size = unknowns_.size(), weak = steps_.cols();
    Eigen::MatrixXd seconds(rows_.size(), weak * (weak + 1) / 2);  // r_kl = 2 h_kl, but for the third derivatives
    Eigen::Index pair = 0;
    for (Eigen::Index k = 0; k < weak; ++k, pair += k) {
      seconds.middleCols(pair, k + 1).noalias() = (jacobian(steps_.col(k)) - here_) * steps_.leftCols(k + 1);
    }
    const Eigen::MatrixXd p = 0.5 * gain_ * seconds;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(size), times = Eigen::VectorXd::Constant(p.cols(), 4.0);  // kl and lk
    pair = 0;
    for (Eigen::Index k = 0; k < weak; ++k, pair += k) {
      mean += p.col(pair + k);
      times[pair + k] = 2.0;
    }
    const Eigen::MatrixXd out = p * times.asDiagonal() * p.transpose();
    return out + mean * mean.transpose();
  }

 private:
  static constexpr Eigen::Index kRows = 256;  // some 36 per circle of a seven-circle plan
  // In prior standard deviations: the curvature along directions determined better than this is (1 / 50)^2 of the
  // prior's.
  static constexpr double kWeak = 0.02;

  /// Return the unknowns along which readings bend: all but those of learned functions, which push micrometres. The
  /// square of that over the shortest length of a machine is far below any noise, and hundreds of them, most determined
  /// weakly, would take the square of their number in pairs.
  static std::vector<Eigen::Index> that_bend(const Model& model, const Unknowns& unknowns) {
    std::vector<bool> is_learned;
    for (const Term& term : model.terms) {
      const EffectInfo& info = term.effect->info();
      is_learned.insert(is_learned.end(), static_cast<std::size_t>(term.values.size()), info.source == "learned");
    }
    std::vector<Eigen::Index> out;
    for (Eigen::Index j = 0; j < unknowns.size(); ++j) {
      if (!is_learned[static_cast<std::size_t>(unknowns.columns[static_cast<std::size_t>(j)])]) out.push_back(j);
    }
    return out;
  }

  /// Return the scaled Jacobian one step away; where a sample has no solution there, the one here: no change.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& step) const {
    Model model = model_;
    const Eigen::VectorXd z = model.values()(unknowns_.columns).cwiseQuotient(unknowns_.scale) + step;
    model.set_values(unknowns_.values(z.data()));
    if (accumulator_->at(model).failure >= 0) return here_;
    return accumulator_->jacobian() * unknowns_.scale.asDiagonal();
  }

  const Model& model_;
  const Unknowns& unknowns_;
  Samples rows_;
  Eigen::VectorXd no_reading_;
  std::unique_ptr<Accumulator> accumulator_;  // of the rows; remembers their last solutions
  Eigen::MatrixXd here_, gain_;
  Eigen::MatrixXd steps_;  // columns
};

}  // namespace

Eigen::MatrixXd spread_of_curvature(const Model& model, const Samples& samples, const Accumulator& solved,
                                    const Unknowns& unknowns, const Eigen::MatrixXd& spread, double noise_mm) {
  return Curvature(model, samples, solved, unknowns, spread, noise_mm).spread();
}

}  // namespace hexdbb
