#include <optional>
#include <utility>

#include "bindings.hpp"
#include "hexdbb/effect.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

EffectInfo user_info(std::string name, std::string physics, std::string source, std::string element_kind,
                     std::vector<std::string> elements, std::vector<ParameterInfo> parameters,
                     std::vector<std::string> ports, std::string formula) {
  return {.name = std::move(name),
          .group = group::kUser,
          .physics = std::move(physics),
          .formula = std::move(formula),
          .source = std::move(source),
          .element_kind = std::move(element_kind),
          .elements = std::move(elements),
          .parameters = std::move(parameters),
          .ports = std::move(ports)};
}

py::array_t<double> effect_pushes(const Machine& machine, int mounts, const std::string& name, const Samples& samples,
                                  const std::optional<Eigen::VectorXd>& values) {
  const EffectPtr effect = find_effect(machine, mounts, name);
  const Eigen::Index count = samples.size(), size = effect->info().size();
  const std::vector<Eigen::MatrixXd> of_port =
      push_derivatives(*effect, samples, values.value_or(Eigen::VectorXd::Zero(size)));
  py::array_t<double> out({count, Eigen::Index{port::kCount}, size});
  auto view = out.mutable_unchecked<3>();
  for (Eigen::Index row = 0; row < count; ++row) {
    for (Eigen::Index port = 0; port < port::kCount; ++port) {
      for (Eigen::Index value = 0; value < size; ++value) view(row, port, value) = of_port[port](row, value);
    }
  }
  return out;
}

}  // namespace

void bind_effects(py::module_& module) {
  py::class_<ParameterInfo>(module, "ParameterInfo", "One parameter of an effect, in the engine's units.")
      .def(py::init([](std::string name, std::string unit, double prior_sigma, double limit, bool is_nonnegative) {
             return ParameterInfo{.name = std::move(name),
                                  .unit = std::move(unit),
                                  .prior_sigma = prior_sigma,
                                  .limit = limit,
                                  .is_nonnegative = is_nonnegative};
           }),
           py::kw_only(), py::arg("name"), py::arg("unit"), py::arg("prior_sigma"), py::arg("limit"),
           py::arg("is_nonnegative") = false)
      .def_readonly("name", &ParameterInfo::name)
      .def_readonly("unit", &ParameterInfo::unit)
      .def_readonly("prior_sigma", &ParameterInfo::prior_sigma, "Prior standard deviation.")
      .def_readonly("limit", &ParameterInfo::limit, "Largest magnitude with a physical meaning; the fit's bound.")
      .def_readonly("is_shape", &ParameterInfo::is_shape,
                    "Whether it pushes nothing by itself but shapes what the effect's other parameters push.")
      .def_property_readonly("lower", &ParameterInfo::lower, "Lower end of the physical domain.")
      .def_property_readonly("upper", &ParameterInfo::upper, "Upper end of the physical domain.");
  py::class_<EffectInfo>(module, "EffectInfo", "Description of an effect: physics, elements, parameters, ports.")
      .def(py::init(&user_info), py::kw_only(), py::arg("name"), py::arg("physics"), py::arg("source"),
           py::arg("element_kind"), py::arg("elements"), py::arg("parameters"), py::arg("ports"),
           py::arg("formula") = "")
      .def_readonly("name", &EffectInfo::name)
      .def_readonly("group", &EffectInfo::group, "geometry, set-up, places, catalogue or user.")
      .def_readonly("physics", &EffectInfo::physics, "One sentence.")
      .def_readonly("formula", &EffectInfo::formula, "What is pushed, as plain text.")
      .def_readonly("source", &EffectInfo::source, "Thesis section, standard or paper.")
      .def_readonly("element_kind", &EffectInfo::element_kind, "leg, slider, guideway, side, mount or machine.")
      .def_readonly("elements", &EffectInfo::elements, "Label of each element.")
      .def_readonly("parameters", &EffectInfo::parameters, "Parameters of one element.")
      .def_readonly("ports", &EffectInfo::ports, "Ports it may push, keys of PORTS.")
      .def_readonly("needs", &EffectInfo::needs, "Columns of the samples' state it needs.")
      .def_readonly("is_set_up", &EffectInfo::is_set_up, "Whether it belongs to the measurement, not to the machine.")
      .def_readonly("is_free_at_first", &EffectInfo::is_free_at_first, "Whether a new model fits its values.")
      .def_property_readonly("size", &EffectInfo::size, "Number of values: elements times parameters.");
  module.def("effect_names", &effect_names, py::arg("group") = "",
             "Return the names of the effects of a group (geometry, set-up, places, catalogue), or of all.");
  module.def(
      "effect_info",
      [](const Machine& machine, int mounts, const std::string& name) {
        return find_effect(machine, mounts, name)->info();
      },
      py::arg("machine"), py::arg("mounts"), py::arg("name"),
      "Return the description of an effect.\n\n"
      "Parameters\n----------\nmachine : Machine\nmounts : int\n    Fixings of the tool cup the model distinguishes.\n"
      "name : str\n\nRaises\n------\nValueError\n    Where no effect has that name, with the known names.");
  module.def("effect_pushes", &effect_pushes, py::arg("machine"), py::arg("mounts"), py::arg("name"),
             py::arg("samples"), py::arg("values") = py::none(),
             "Compute what an effect pushes at every port per unit of each of its values.\n\n"
             "Parameters\n----------\nmachine : Machine\nmounts : int\n"
             "    Fixings of the tool cup the model distinguishes.\nname : str\nsamples : Samples\n"
             "values : ndarray, shape (size,), optional\n"
             "    Values at which the derivative is taken, engine units; zero where not given.\n\n"
             "Returns\n-------\nndarray, shape (n, 55, size)\n"
             "    d push / d value, mm per unit of the value; ports in the order of PORTS.\n\n"
             "Raises\n------\nValueError\n"
             "    An unknown effect, values of another length, or samples without a column that the effect needs.");
}

}  // namespace hexdbb::bindings
