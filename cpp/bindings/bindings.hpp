// One function per concept, called in order by module.cpp.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace hexdbb::bindings {

void bind_machine(pybind11::module_& module);
void bind_kinematics(pybind11::module_& module);
void bind_effects(pybind11::module_& module);
void bind_samples(pybind11::module_& module);
void bind_prediction(pybind11::module_& module);
void bind_diagnosis(pybind11::module_& module);
void bind_chance(pybind11::module_& module);
void bind_contours(pybind11::module_& module);
void bind_grouped(pybind11::module_& module);
void bind_compensation(pybind11::module_& module);

}  // namespace hexdbb::bindings
