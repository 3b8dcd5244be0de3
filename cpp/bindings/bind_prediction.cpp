#include "bindings.hpp"
#include "hexdbb/prediction.hpp"
#include "hexdbb/tabulated_effect.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

std::shared_ptr<TabulatedEffect> tabulated(EffectInfo info, const std::vector<int>& values,
                                           const std::vector<int>& ports, const Eigen::MatrixXd& per_unit) {
  if (values.size() != ports.size() || per_unit.cols() != static_cast<Eigen::Index>(ports.size())) {
    throw std::invalid_argument("values has " + std::to_string(values.size()) + " entries, ports " +
                                std::to_string(ports.size()) + ", per_unit " + std::to_string(per_unit.cols()) +
                                " columns; expected the same number");
  }
  std::vector<TabulatedLink> links;
  for (std::size_t j = 0; j < values.size(); ++j) {
    links.push_back({values[j], ports[j], per_unit.col(static_cast<Eigen::Index>(j))});
  }
  return std::make_shared<TabulatedEffect>(std::move(info), std::move(links));
}

}  // namespace

void bind_prediction(py::module_& module) {
  py::class_<TabulatedEffect, std::shared_ptr<TabulatedEffect>>(
      module, "TabulatedEffect",
      "An effect given as numbers: its value values[j] pushes port ports[j] by per_unit[:, j].")
      .def(py::init(&tabulated), py::arg("info"), py::kw_only(), py::arg("values"), py::arg("ports"),
           py::arg("per_unit"),
           "Keep the numbers of an effect.\n\n"
           "Parameters\n----------\ninfo : EffectInfo\nvalues : sequence of int\n    Indices of the effect's values.\n"
           "ports : sequence of int\n    Indices of ports, 0 to 54.\nper_unit : ndarray, shape (n, len(ports))\n"
           "    Push per unit of the value, one row per sample, mm.\n\n"
           "Raises\n------\nValueError\n    An index that does not exist, lengths that differ, a number not finite.");
  py::class_<Model>(module, "Model", "A machine and a list of effects with their values.")
      .def(py::init<const Machine&>(), py::arg("machine"))
      .def(
          "add",
          [](Model& model, const std::string& name, int mounts) {
            model.add(find_effect(model.nominal.machine, mounts, name));
          },
          py::arg("name"), py::arg("mounts"),
          "Append an effect with all values zero. ValueError where no effect has that name.")
      .def(
          "add_tabulated", [](Model& model, std::shared_ptr<TabulatedEffect> effect) { model.add(std::move(effect)); },
          py::arg("effect"), "Append an effect given as numbers, with all values zero; models share its numbers.")
      .def_property("values", &Model::values,
                    [](Model& model, const Eigen::VectorXd& values) {
                      if (values.size() != model.size()) {
                        throw std::invalid_argument("values has " + std::to_string(values.size()) +
                                                    " entries, expected " + std::to_string(model.size()));
                      }
                      model.set_values(values);
                    })
      .def_property_readonly("size", &Model::size);

  py::class_<Prediction>(module, "Prediction", "Predicted readings.")
      .def_readonly("reading_mm", &Prediction::reading_mm, "Shape (n,); 0 where there is no solution.")
      .def_readonly("status", &Prediction::status, "Shape (n,); 0: solved, see status_name.")
      .def_readonly("jacobian", &Prediction::jacobian, "d reading / d value, shape (n, size); empty unless asked for.")
      .def_property_readonly("first_failure", &Prediction::first_failure, "First row without a solution, or -1.");

  module.def("predict", &predict, py::arg("model"), py::arg("samples"), py::arg("want_jacobian") = false,
             py::call_guard<py::gil_scoped_release>(), "Predict the readings of the ball bar under a model.");
  module.def("port_sensitivity", &port_sensitivity, py::arg("model"), py::arg("samples"),
             py::call_guard<py::gil_scoped_release>(), "Compute d reading / d push at each port, (n, 55), mm per mm.");
  module.def(
      "forward_table",
      [](const Model& model, const Samples& samples) {
        const PoseTable table = forward_table(model, samples);
        return py::make_tuple(table.pose, table.status);
      },
      py::arg("model"), py::arg("samples"),
      "Compute the platform's poses, (n, 12) as x, y, z in mm and the rotation row by row, and their status, (n,).");
}

}  // namespace hexdbb::bindings
