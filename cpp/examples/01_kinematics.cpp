// Slider coordinates of a pose, and the pose they lead to on a machine with one leg 50 um too long.
#include <hexdbb/kinematics.hpp>
#include <iostream>

int main() {
  const hexdbb::NominalGeometry machine{hexdbb::Machine()};
  const hexdbb::Pose wanted{hexdbb::Vector3(30.0, -20.0, 280.0), hexdbb::rotation_from_rpy(0.05, 0.0, 0.1)};

  const hexdbb::InverseResult sliders = hexdbb::inverse(machine, wanted);
  if (sliders.status != hexdbb::Status::kOk) {
    std::cerr << hexdbb::status_name(sliders.status) << " (leg " << sliders.leg + 1 << ")\n";
    return 1;
  }
  std::cout << "sliders  mm: " << sliders.sliders_mm.transpose() << '\n';

  hexdbb::Ports errors;
  errors.leg()[0] = 0.050;
  hexdbb::RssrAngles angles;  // keep it: the next solution starts from here
  const hexdbb::ForwardResult real = hexdbb::forward(hexdbb::assemble(machine, sliders.sliders_mm, errors), angles);
  if (real.status != hexdbb::Status::kOk) return 1;
  std::cout << "platform is off by um: " << 1e3 * (real.pose.position - wanted.position).transpose() << '\n'
            << "residual mm: " << real.residual_mm << " after " << real.iterations << " Newton steps\n";
}
