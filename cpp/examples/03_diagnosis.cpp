// Simulate readings of one circle with leg errors and diagnose them.
#include <cmath>
#include <hexdbb/diagnosis.hpp>
#include <iostream>

namespace {

hexdbb::Samples circle(const hexdbb::NominalGeometry& machine, int count) {
  hexdbb::Samples samples;
  samples.sliders_mm.resize(count, hexdbb::kLegs);
  samples.set_up = samples.mount = Eigen::VectorXi::Zero(count);
  samples.set_ups = {{hexdbb::Vector3(0.0, 0.0, 340.0), hexdbb::Vector3(0.0, 0.0, 60.0), 100.0}};
  for (int row = 0; row < count; ++row) {
    const double angle = 2.0 * M_PI * row / count;
    hexdbb::Pose pose;
    pose.position << 100.0 * std::cos(angle), 100.0 * std::sin(angle), 280.0;
    samples.sliders_mm.row(row) = hexdbb::inverse(machine, pose).sliders_mm.transpose();
  }
  return samples;
}

}  // namespace

int main() {
  const hexdbb::Machine machine;
  hexdbb::Model truth(machine), model(machine);
  for (const char* name : {"leg_length", "cup_position"}) {
    truth.add(hexdbb::find_effect(machine, 1, name));
    model.add(hexdbb::find_effect(machine, 1, name));
  }
  truth.terms[0].values << 0.05, -0.02, 0.0, 0.03, -0.04, 0.01;

  const hexdbb::Samples samples = circle(model.nominal, 720);
  const hexdbb::FitResult found =
      hexdbb::fit(model, samples, hexdbb::predict(truth, samples, false).reading_mm, hexdbb::FitOptions());
  std::cout << "reading error um: " << 1e3 * found.rms_before_mm << " -> " << 1e3 * found.rms_after_mm << '\n'
            << "rank " << found.machine.rank << " of the machine's unknowns\n";
  return found.usable && found.rms_after_mm < 1e-6 ? 0 : 1;
}
