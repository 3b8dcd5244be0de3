#include "compensating.hpp"

#include <algorithm>
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

CompensationTable table_of(const std::string& port, const std::string& variable, const std::vector<TablePush>& pushes,
                           double low, double high, int count) {
  CompensationTable out;
  out.effect = "learned:" + port + ":" + variable;
  out.port = port;
  out.variable = variable;
  out.pushes = pushes;
  for (int at = 0; at < count; ++at) {
    const double part = count > 1 ? double(at) / (count - 1) : 0.0;
    out.knots.push_back(low + (high - low) * (count % 2 == 0 ? part * part : part));
    out.values_mm.push_back(0.008 * std::sin(5.0 * part) + 0.002 * std::cos(17.0 * part));
  }
  return out;
}

std::vector<CompensationTable> all_tables() {
  std::vector<CompensationTable> out = {
      table_of("slider_joint", "sliders_mm", {{0, 2, 1.0}, {1, 5, 1.0}}, 30.0, 840.0, 73),
      table_of("slider_joint", "sliders_mm", {{2, 6, 0.5}, {2, 7, -0.8}}, 30.0, 840.0, 64),
      table_of("platform_joint", "platform_joint_angle_rad", {{3, 10, 1.0}}, 0.5, 2.5, 31),
      table_of("slider", "", {{4, 4, 1.0}}, 0.0, 0.0, 1),
      table_of("slider", "velocity_mm_s", {{0, 0, 1.0}, {5, 5, 1.0}}, -100.0, 100.0, 42),
      table_of("leg", "leg_force", {{1, 1, 1.0}}, -1.0, 1.0, 20),
      table_of("leg", "warming_k", {{2, 2, 1.0}}, -10.0, 10.0, 20),
      table_of("leg", "temperature_c", {{3, 3, 1.0}}, 10.0, 40.0, 20),
      table_of("leg", "slider_joint_angle_rad", {{4, 4, 1.0}}, 0.5, 2.5, 61),
      table_of("leg", "slider_joint_rate_rad_s", {{4, 4, 1.0}}, -0.2, 0.2, 62),
      table_of("leg", "slider_joint_direction", {{5, 5, 1.0}}, -1.0, 1.0, 2),
      table_of("leg", "platform_joint_rate_rad_s", {{0, 0, 1.0}}, -0.2, 0.2, 40),
      table_of("leg", "swing_angle_rad", {{1, 1, 1.0}}, -3.2, 3.2, 40),
      table_of("leg", "swing_rate_rad_s", {{2, 2, 1.0}}, -0.2, 0.2, 41)};
  out.push_back(table_of("slider", "sliders_mm", {{3, 3, 1.0}}, 0.0, 5.0, 49));
  out.back().period = 5.0;
  out.back().values_mm.back() = out.back().values_mm.front();
  out.push_back(table_of("leg", "sliders_mm", {{5, 5, 1.0}}, 30.0, 840.0, 20));
  out.back().times = "travel_direction";
  out.push_back(table_of("slider", "since_reversal_mm", {{1, 1, 1.0}, {2, 2, 1.0}}, 0.0, 60.0, 40));
  out.back().times = "travel_direction";
  out.push_back(table_of("leg", "since_reversal_mm", {{3, 3, 1.0}}, 0.0, 60.0, 41));
  out.push_back(table_of("slider", "acceleration_mm_s2", {{4, 4, 1.0}}, -40.0, 40.0, 40));
  return out;
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
    const std::size_t middle = std::clamp<std::size_t>(at, 1, path.size() - 2);
    const auto nominal_mm = [&](std::size_t pose) { return inverse(nominal, path[pose]).sliders_mm; };
    Direction direction =
        direction_through(nominal_mm(middle - 1), nominal_mm(middle), nominal_mm(middle + 1), step_s, step_s);
    direction.velocity_mm_s = (nominal_mm(after) - nominal_mm(before)) / (double(after - before) * step_s);
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
