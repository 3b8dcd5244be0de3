// Reading of the ball bar at a pose, and its sensitivity to each leg and slider.
#include <hexdbb/ball_bar.hpp>
#include <iostream>

int main() {
  const hexdbb::NominalGeometry machine{hexdbb::Machine()};
  const hexdbb::SetUp bar{hexdbb::Vector3(0.0, 0.0, 340.0), hexdbb::Vector3(0.0, 0.0, 60.0), 100.0};
  const hexdbb::Pose pose{hexdbb::Vector3(100.0, 0.0, 280.0), hexdbb::Matrix3::Identity()};

  const hexdbb::Ports none;
  const hexdbb::Mechanism mechanism = hexdbb::assemble(machine, hexdbb::inverse(machine, pose).sliders_mm, none);
  const hexdbb::PlatformTriangle triangle(hexdbb::shared_joints(mechanism));
  hexdbb::Ports sensitivity;
  if (!hexdbb::reading_sensitivity(machine, mechanism, triangle, pose, bar, none, sensitivity)) return 1;

  std::cout << "reading mm: " << hexdbb::reading_mm(pose, bar, none) << '\n'
            << "um of reading per um of leg:    " << sensitivity.leg().transpose() << '\n'
            << "um of reading per um of slider: " << sensitivity.slider().transpose() << '\n';
}
