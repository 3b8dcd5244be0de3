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
      if (result.status != Status::kOk) throw std::logic_error("a test's circle is out of reach");
      out.sliders_mm.row(row) = result.sliders_mm.transpose();
      out.mount[row] = circle.mount;
    }
  }
  return out;
}

Samples rows(const Samples& samples, const std::vector<Eigen::Index>& which) {
  Samples out;
  const Eigen::Index count = static_cast<Eigen::Index>(which.size());
  out.sliders_mm.resize(count, kLegs);
  out.set_up.resize(count);
  out.mount.resize(count);
  out.set_ups = samples.set_ups;
  for (Eigen::Index row = 0; row < count; ++row) {
    const Eigen::Index from = which[static_cast<std::size_t>(row)];
    out.sliders_mm.row(row) = samples.sliders_mm.row(from);
    out.set_up[row] = samples.set_up[from];
    out.mount[row] = samples.mount[from];
  }
  return out;
}

Model full_model(const Machine& machine, int mounts) {
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
