#include "bindings.hpp"

PYBIND11_MODULE(_core, module) {
  module.doc() =
      "The engine of hexdbb: kinematics, effects, prediction, diagnosis. Units: mm, rad, s, N; indices from 0.";
  using namespace hexdbb::bindings;
  bind_machine(module);
  bind_kinematics(module);
  bind_samples(module);
  bind_effects(module);
  bind_prediction(module);
  bind_diagnosis(module);
  bind_chance(module);
  bind_contours(module);
  bind_grouped(module);
  bind_compensation(module);
}
