// A program that diagnoses: Ceres comes with hexdbb::diagnosis.
#include <cmath>
#include <hexdbb/diagnosis.hpp>

int main() {
  hexdbb::Model model{hexdbb::Machine()};
  model.add(hexdbb::find_effect(model.nominal.machine, 1, "cup_position"));
  hexdbb::Samples samples;
  constexpr int kReadings = 12;
  samples.sliders_mm.resize(kReadings, 6);
  samples.set_up.setZero(kReadings);
  samples.mount.setZero(kReadings);
  samples.set_ups = {{{0.0, 0.0, 340.0}, {0.0, 0.0, 60.0}, 100.0}};
  for (int row = 0; row < kReadings; ++row) {
    const double angle = 0.5 * row;
    const hexdbb::Pose pose{{90.0 * std::cos(angle), 90.0 * std::sin(angle), 280.0}, hexdbb::Matrix3::Identity()};
    samples.sliders_mm.row(row) = hexdbb::inverse(model.nominal, pose).sliders_mm.transpose();
  }
  model.terms[0].values << 0.1, -0.2, 0.3;
  const Eigen::VectorXd measured = hexdbb::predict(model, samples, false).reading_mm;
  model.terms[0].values.setZero();
  const hexdbb::FitResult fit = hexdbb::fit(model, samples, measured, hexdbb::FitOptions());
  return fit.usable && fit.rms_after_mm < 0.1 * fit.rms_before_mm ? 0 : 1;
}
