#include "bindings.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

Samples make_samples(const Eigen::Matrix<double, Eigen::Dynamic, kLegs>& sliders_mm, const Eigen::VectorXi& set_up,
                     const Eigen::VectorXi& mount, std::vector<SetUp> set_ups) {
  Samples samples{sliders_mm, set_up, mount, std::move(set_ups)};
  samples.validate();
  return samples;
}

}  // namespace

void bind_prediction(py::module_& module) {
  py::class_<SetUp>(module, "SetUp", "One fixing of the bar: nominal cup, ball and bar length.")
      .def(py::init([](const Vector3& cup_mm, const Vector3& ball_offset_mm, double bar_length_mm) {
             return SetUp{cup_mm, ball_offset_mm, bar_length_mm};
           }),
           py::kw_only(), py::arg("cup_mm"), py::arg("ball_offset_mm"), py::arg("bar_length_mm"))
      .def_readonly("cup_mm", &SetUp::cup_mm)
      .def_readonly("ball_offset_mm", &SetUp::ball_offset_mm)
      .def_readonly("bar_length_mm", &SetUp::bar_length_mm);

  py::class_<Samples>(module, "Samples", "State of a record's samples, one row each.")
      .def(py::init(&make_samples), py::kw_only(), py::arg("sliders_mm"), py::arg("set_up"), py::arg("mount"),
           py::arg("set_ups"))
      .def_property_readonly("size", &Samples::size);

  py::class_<Model>(module, "Model", "A machine and a list of effects with their values.")
      .def(py::init<const Machine&>(), py::arg("machine"))
      .def(
          "add",
          [](Model& model, const std::string& name, int mounts) {
            model.add(find_effect(model.nominal.machine, mounts, name));
          },
          py::arg("name"), py::arg("mounts"), "Append the effect of that name with all values zero.")
      .def_property("values", &Model::values,
                    [](Model& model, const Eigen::VectorXd& values) {
                      if (values.size() != model.size()) {
                        throw std::invalid_argument("values has " + std::to_string(values.size()) +
                                                    " entries, expected " + std::to_string(model.size()));
                      }
                      model.set_values(values);
                    })
      .def_property_readonly("size", &Model::size);

  py::class_<Prediction>(module, "Prediction", "Readings in mm, status, Jacobian (samples x values).")
      .def_readonly("reading_mm", &Prediction::reading_mm)
      .def_readonly("status", &Prediction::status)
      .def_readonly("jacobian", &Prediction::jacobian)
      .def_property_readonly("first_failure", &Prediction::first_failure);

  module.def("predict", &predict, py::arg("model"), py::arg("samples"), py::arg("want_jacobian") = false,
             py::call_guard<py::gil_scoped_release>(), "What the ball bar reads under a model.");
  module.def("port_sensitivity", &port_sensitivity, py::arg("model"), py::arg("samples"),
             py::call_guard<py::gil_scoped_release>(), "d reading / d push at each port, (n, 55), mm per mm.");
  module.def(
      "forward_table",
      [](const Model& model, const Samples& samples) {
        const PoseTable table = forward_table(model, samples);
        return py::make_tuple(table.pose, table.status);
      },
      py::arg("model"), py::arg("samples"), "Poses (n, 12) as x, y, z and the rotation row by row; status (n,).");
}

}  // namespace hexdbb::bindings
