#include "compensating.hpp"

#include <cmath>
#include <stdexcept>

namespace hexdbb::testing {

Model wrong_machine(const std::vector<std::string>& effects, std::uint64_t seed) {
  Drawing drawing(seed);
  Model model{Machine()};
  for (const std::string& name : effects) {
    model.add(find_effect(Machine(), 1, name));
    Term& term = model.terms.back();
    const EffectInfo& info = term.effect->info();
    for (int value = 0; value < info.size(); ++value) {
      const ParameterInfo& parameter = info.parameters[static_cast<std::size_t>(value) % info.parameters.size()];
      const bool is_geometry = info.group == group::kGeometry;
      const double size = is_geometry ? (parameter.unit == "rad" ? 2e-4 : 0.05) : parameter.prior_sigma;
      term.values[value] = drawing.uniform(-size, size);
    }
  }
  return model;
}

CompensationData data_of(const Model& model, double reference_temperature_c) {
  return compensation_of(model, "SP-120", std::string(64, 'a'), {2.0, 0.01}, reference_temperature_c);
}

std::vector<Pose> circle_path(double step_s, double laps, const Vector3& rpy_rad) {
  constexpr double kLap_s = 12.0, kRadius_mm = 90.0;
  std::vector<Pose> out;
  for (double time_s = 0.0; time_s < laps * kLap_s; time_s += step_s) {
    const double angle = 2.0 * M_PI * time_s / kLap_s;
    out.push_back(make_pose(kRadius_mm * std::cos(angle), kRadius_mm * std::sin(angle), 285.0, rpy_rad[0], rpy_rad[1],
                            rpy_rad[2]));
  }
  return out;
}

SliderTable drive(Compensator& compensator, const std::vector<Pose>& path, double step_s, double temperature_c) {
  const NominalGeometry nominal(compensator.machine());
  SliderTable out(static_cast<Eigen::Index>(path.size()), int{kLegs});
  for (std::size_t at = 0; at < path.size(); ++at) {
    const std::size_t before = at == 0 ? at : at - 1, after = at + 1 == path.size() ? at : at + 1;
    Direction direction = direction_between(nominal, path[before], path[after], double(after - before) * step_s);
    direction.temperature_c = temperature_c;
    const SliderTargets targets = compensator.sliders(path[at], direction);
    if (targets.status != Status::kOk) throw std::runtime_error(status_name(targets.status));
    out.row(static_cast<Eigen::Index>(at)) = targets.sliders_mm.transpose();
  }
  return out;
}

double distance_mm(const NominalGeometry& nominal, const Pose& one, const Pose& other) {
  double out = (one.position - other.position).cwiseAbs().maxCoeff();
  for (int k = 0; k < kLegs; ++k) {
    const Vector3 joint = nominal.platform_joint.col(k);
    const Vector3 apart = one.position + one.rotation * joint - other.position - other.rotation * joint;
    out = std::max(out, apart.cwiseAbs().maxCoeff());
  }
  return out;
}

}  // namespace hexdbb::testing
