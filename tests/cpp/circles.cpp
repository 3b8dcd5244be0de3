#include "circles.hpp"

#include <cmath>
#include <stdexcept>

namespace hexdbb::testing {

std::vector<CircleSpec> seven_circles() {
  const double tilt = 12.0 * M_PI / 180.0, yaw = 15.0 * M_PI / 180.0;
  std::vector<CircleSpec> out;
  for (const Vector3& rpy : {Vector3(0, 0, 0), Vector3(tilt, 0, 0), Vector3(-tilt, 0, 0), Vector3(0, tilt, 0),
                             Vector3(0, -tilt, 0), Vector3(0, 0, yaw), Vector3(0, 0, -yaw)}) {
    out.push_back({rpy, Vector3::Zero(), 0});
  }
  return out;
}

Samples circle_samples(const Machine& machine, const std::vector<CircleSpec>& circles, int count, const Vector3& cup_mm,
                       const Vector3& ball_offset_mm) {
  const NominalGeometry nominal(machine);
  const SetUp set_up{cup_mm, ball_offset_mm, 100.0};
  const Eigen::Index total = static_cast<Eigen::Index>(circles.size()) * count;
  Samples out;
  out.sliders_mm.resize(total, kLegs);
  out.set_up.setZero(total);
  out.mount.resize(total);
  out.set_ups = {set_up};
  Eigen::Index row = 0;
  for (const CircleSpec& circle : circles) {
    const Vector3& platform = circle.platform_rpy_rad;
    const Vector3& plane = circle.plane_rpy_rad;
    const Matrix3 rotation = rotation_from_rpy(platform[0], platform[1], platform[2]);
    const Matrix3 tilted = rotation_from_rpy(plane[0], plane[1], plane[2]);
    for (int i = 0; i < count; ++i, ++row) {
      const double angle = 2.0 * M_PI * i / count;
      const Vector3 ball = cup_mm + tilted * Vector3(100.0 * std::cos(angle), 100.0 * std::sin(angle), 0.0);
      const InverseResult result = inverse(nominal, {ball - rotation * ball_offset_mm, rotation});
      if (result.status != Status::kOk) throw std::logic_error("a circle of the test is out of reach");
      out.sliders_mm.row(row) = result.sliders_mm.transpose();
      out.mount[row] = circle.mount;
    }
  }
  return out;
}

Samples moving_samples(const Machine& machine, const std::vector<CircleSpec>& circles, int count, double lap_s) {
  Samples out = circle_samples(machine, circles, count);
  out.set_ups[0].bar_length_mm = 99.9;
  const Eigen::Index total = out.size();
  State& state = out.state;
  state.time_s = 3600.0 + (lap_s / count) * Eigen::ArrayXd::LinSpaced(total, 0.0, static_cast<double>(total - 1));
  state.circle = Eigen::VectorXi::NullaryExpr(total, [&](Eigen::Index row) { return static_cast<int>(row / count); });
  state.sweep = state.circle;
  state.temperature_c.setConstant(total, std::nan(""));
  state.temperature_c.tail(total / 2).setLinSpaced(21.0, 23.0);
  state.warming_k = state.temperature_c.array() - 20.0;
  derive(NominalGeometry(machine), out);
  return out;
}

Model full_model(const Machine& machine, int mounts) {
  Model model(machine);
  for (const std::string& of : {group::kGeometry, group::kSetUp}) {
    for (const std::string& name : effect_names(of)) model.add(find_effect(machine, mounts, name));
  }
  return model;
}

Model model_of_everything(const Machine& machine, int mounts) {
  Model model(machine);
  for (const std::string& name : effect_names()) model.add(find_effect(machine, mounts, name));
  return model;
}

Eigen::VectorXd difference(Model model, const Samples& samples, int value, double step) {
  Eigen::VectorXd values = model.values();
  values[value] += step;
  model.set_values(values);
  const Eigen::VectorXd above = predict(model, samples, false).reading_mm;
  values[value] -= 2.0 * step;
  model.set_values(values);
  return (above - predict(model, samples, false).reading_mm) / (2.0 * step);
}

}  // namespace hexdbb::testing
