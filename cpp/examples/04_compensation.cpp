// Slider targets at which the platform of the real machine takes the commanded pose: a leg 50 um too long and 20 um of
// play in every drive, written to a compensation file and loaded as a motion controller does.
#include <cmath>
#include <fstream>
#include <hexdbb/compensation.hpp>
#include <iostream>

int main() {
  hexdbb::Model diagnosed{hexdbb::Machine()};
  diagnosed.add(hexdbb::find_effect(diagnosed.nominal.machine, 1, "leg_length"));
  diagnosed.terms.back().values[0] = 0.050;
  diagnosed.add(hexdbb::find_effect(diagnosed.nominal.machine, 1, "backlash"));
  diagnosed.terms.back().values.setConstant(0.020);
  const double no_thermometer = std::nan("");
  std::ofstream("sp120.hexcomp") << hexdbb::compensation_text(
      hexdbb::compensation_of(diagnosed, "SP-120", "", hexdbb::CompensationLimits(), no_thermometer));

  try {
    hexdbb::Compensator compensator = hexdbb::load_compensation("sp120.hexcomp", hexdbb::Machine());
    for (int step = 0; step < 100; ++step) {  // a real-time loop: nothing in it allocates, throws or waits
      const double angle = 0.001 * step;
      const hexdbb::Pose pose{{90.0 * std::cos(angle), 90.0 * std::sin(angle), 285.0}, hexdbb::Matrix3::Identity()};
      const hexdbb::SliderTargets targets = compensator.sliders(pose);
      if (targets.status != hexdbb::Status::kOk) {
        std::cerr << hexdbb::status_name(targets.status) << '\n';
        return 1;
      }
      if (step % 33 == 0) std::cout << "correction um: " << 1e3 * targets.correction_mm.transpose() << '\n';
    }
  } catch (const hexdbb::CompensationError& error) {  // truncated, altered, of another machine, of a later version
    std::cerr << error.what() << '\n';
    return 1;
  }
}
