#include <utility>

#include "bindings.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

EffectInfo user_info(std::string name, std::string physics, std::string source, std::string element_kind,
                     std::vector<std::string> elements, std::vector<ParameterInfo> parameters,
                     std::vector<std::string> ports) {
  return {std::move(name),     std::move(physics),    std::move(source), std::move(element_kind),
          std::move(elements), std::move(parameters), std::move(ports),  false,
          group::kUser};
}

}  // namespace

void bind_effects(py::module_& module) {
  py::class_<ParameterInfo>(module, "ParameterInfo", "One parameter of an effect, in the engine's units.")
      .def(py::init([](std::string name, std::string unit, double prior_sigma, double limit) {
             return ParameterInfo{std::move(name), std::move(unit), prior_sigma, limit};
           }),
           py::kw_only(), py::arg("name"), py::arg("unit"), py::arg("prior_sigma"), py::arg("limit"))
      .def_readonly("name", &ParameterInfo::name)
      .def_readonly("unit", &ParameterInfo::unit)
      .def_readonly("prior_sigma", &ParameterInfo::prior_sigma)
      .def_readonly("limit", &ParameterInfo::limit)
      .def_readonly("is_shape", &ParameterInfo::is_shape);
  py::class_<EffectInfo>(module, "EffectInfo", "What an effect is: physics, source, elements, parameters, ports.")
      .def(py::init(&user_info), py::kw_only(), py::arg("name"), py::arg("physics"), py::arg("source"),
           py::arg("element_kind"), py::arg("elements"), py::arg("parameters"), py::arg("ports"))
      .def_readonly("name", &EffectInfo::name)
      .def_readonly("physics", &EffectInfo::physics)
      .def_readonly("source", &EffectInfo::source)
      .def_readonly("element_kind", &EffectInfo::element_kind)
      .def_readonly("elements", &EffectInfo::elements)
      .def_readonly("parameters", &EffectInfo::parameters)
      .def_readonly("ports", &EffectInfo::ports)
      .def_readonly("is_set_up", &EffectInfo::is_set_up)
      .def_readonly("group", &EffectInfo::group)
      .def_readonly("needs", &EffectInfo::needs)
      .def_property_readonly("size", &EffectInfo::size);
  module.def("effect_names", &effect_names, py::arg("group") = "",
             "Names of the effects of a group (geometry, set-up, catalogue), or of all.");
  module.def(
      "effect_info",
      [](const Machine& machine, int mounts, const std::string& name) {
        return find_effect(machine, mounts, name)->info();
      },
      py::arg("machine"), py::arg("mounts"), py::arg("name"),
      "The effect of that name; ValueError where there is none.");
}

}  // namespace hexdbb::bindings
