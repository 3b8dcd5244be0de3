#include "unknowns.hpp"

#include <stdexcept>
#include <string>

namespace hexdbb {

namespace {

/// Return one number of every value's parameter, in the order of a model's values.
template <class Number>
Eigen::VectorXd of_each_value(const Model& model, Number number) {
  Eigen::VectorXd out(model.size());
  Eigen::Index at = 0;
  for (const Term& term : model.terms) {
    const EffectInfo& info = term.effect->info();
    for (int j = 0; j < info.size(); ++j) out[at++] = number(info.parameters[j % info.parameters.size()]);
  }
  return out;
}

Eigen::VectorXd physical_limits(const Model& model) {
  return of_each_value(model, [](const ParameterInfo& parameter) { return parameter.limit; });
}

}  // namespace

Eigen::VectorXd prior_sigmas(const Model& model) {
  return of_each_value(model, [](const ParameterInfo& parameter) { return parameter.prior_sigma; });
}

Unknowns make_unknowns(const Model& model, const FitOptions& options) {
  if (!options.free.empty() && static_cast<int>(options.free.size()) != model.size()) {
    throw std::invalid_argument("free has " + std::to_string(options.free.size()) + " entries, expected " +
                                std::to_string(model.size()));
  }
  const bool is_scaled = options.prior_scale.size() > 0;
  if (is_scaled && (options.prior_scale.size() != model.size() || !(options.prior_scale.array() > 0.0).all())) {
    throw std::invalid_argument("prior_scale: expected " + std::to_string(model.size()) + " factors greater than 0");
  }
  if (options.starts.cols() > 0 && options.starts.rows() != model.size()) {
    throw std::invalid_argument("starts: expected " + std::to_string(model.size()) + " rows, one per value");
  }
  Unknowns out;
  out.start = model.values();
  for (int j = 0; j < model.size(); ++j) {
    if (options.free.empty() || options.free[j]) out.columns.push_back(j);
  }
  out.scale = prior_sigmas(model)(out.columns);
  if (is_scaled) out.scale.array() *= options.prior_scale(out.columns).array();
  out.limit = physical_limits(model)(out.columns);
  const Eigen::VectorXd shapes =
      of_each_value(model, [](const ParameterInfo& parameter) { return parameter.is_shape ? 1.0 : 0.0; });
  for (const int column : out.columns) out.shapes.push_back(shapes[column] != 0.0);
  return out;
}

}  // namespace hexdbb
