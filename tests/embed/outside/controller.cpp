// A controller in C++: a file loaded, a pose there and back.
#include <hexdbb/compensation.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  hexdbb::Compensator compensator = hexdbb::load_compensation(argv[1], hexdbb::Machine());
  const hexdbb::Pose wanted{{10.0, 20.0, 285.0}, hexdbb::rotation_from_rpy(0.05, 0.0, 0.1)};
  const hexdbb::SliderTargets targets = compensator.sliders(wanted);
  const hexdbb::PoseEstimate back = compensator.pose(targets.sliders_mm);
  const bool is_good = targets.status == hexdbb::Status::kOk && back.status == hexdbb::Status::kOk &&
                       targets.largest_correction_mm > 1e-3 && (back.pose.position - wanted.position).norm() < 1e-6;
  return is_good ? 0 : 1;
}
