#include "bindings.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

void bind_effects(py::module_& module) {
  py::class_<ParameterInfo>(module, "ParameterInfo", "One parameter of an effect, in the engine's units.")
      .def_readonly("name", &ParameterInfo::name)
      .def_readonly("unit", &ParameterInfo::unit)
      .def_readonly("prior_sigma", &ParameterInfo::prior_sigma)
      .def_readonly("limit", &ParameterInfo::limit);
  py::class_<EffectInfo>(module, "EffectInfo", "What an effect is: physics, source, elements, parameters, ports.")
      .def_readonly("name", &EffectInfo::name)
      .def_readonly("physics", &EffectInfo::physics)
      .def_readonly("source", &EffectInfo::source)
      .def_readonly("element_kind", &EffectInfo::element_kind)
      .def_readonly("elements", &EffectInfo::elements)
      .def_readonly("parameters", &EffectInfo::parameters)
      .def_readonly("ports", &EffectInfo::ports)
      .def_readonly("is_set_up", &EffectInfo::is_set_up)
      .def_property_readonly("size", &EffectInfo::size);
  module.def("effect_names", &effect_names, "Names of all effects the engine knows.");
  module.def(
      "effect_info",
      [](const Machine& machine, int mounts, const std::string& name) {
        return find_effect(machine, mounts, name)->info();
      },
      py::arg("machine"), py::arg("mounts"), py::arg("name"),
      "The effect of that name; ValueError where there is none.");
}

}  // namespace hexdbb::bindings
