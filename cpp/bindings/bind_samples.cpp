#include <pybind11/numpy.h>

#include "bindings.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

/// Fill the columns of a state from a dict of arrays by name; ValueError on a name that is none.
State make_state(const py::dict& columns) {
  State state;
  std::size_t used = 0;
  for_each_column(state, [&](const char* name, auto& column) {
    if (!columns.contains(name)) return;
    column = columns[name].template cast<std::decay_t<decltype(column)>>();
    ++used;
  });
  if (used == columns.size()) return state;
  for (const auto& item : columns) {
    const std::string given = item.first.cast<std::string>();
    bool known = false;
    for_each_column(state, [&](const char* name, const auto&) { known = known || given == name; });
    if (!known) throw std::invalid_argument("a sample's state has no column " + given);
  }
  return state;
}

Samples make_samples(const SliderTable& sliders_mm, const Eigen::VectorXi& set_up, const Eigen::VectorXi& mount,
                     std::vector<SetUp> set_ups, const py::dict& state) {
  Samples samples{sliders_mm, set_up, mount, std::move(set_ups), make_state(state)};
  samples.validate();
  return samples;
}

py::dict state_of(const Samples& samples) {
  py::dict out;
  for_each_column(samples.state, [&](const char* name, const auto& column) {
    if (column.size() > 0) out[name] = column;
  });
  return out;
}

}  // namespace

void bind_samples(py::module_& module) {
  py::class_<SetUp>(module, "SetUp", "One fixing of the bar: nominal cup, ball and bar length.")
      .def(py::init([](const Vector3& cup_mm, const Vector3& ball_offset_mm, double bar_length_mm) {
             return SetUp{cup_mm, ball_offset_mm, bar_length_mm};
           }),
           py::kw_only(), py::arg("cup_mm"), py::arg("ball_offset_mm"), py::arg("bar_length_mm"))
      .def_readonly("cup_mm", &SetUp::cup_mm)
      .def_readonly("ball_offset_mm", &SetUp::ball_offset_mm)
      .def_readonly("bar_length_mm", &SetUp::bar_length_mm);

  py::class_<Samples>(module, "Samples", "Samples of a record, one row each, with what is known of their state.")
      .def(py::init(&make_samples), py::kw_only(), py::arg("sliders_mm"), py::arg("set_up"), py::arg("mount"),
           py::arg("set_ups"), py::arg("state") = py::dict(),
           "`state`: columns by name; any may be missing, an effect that needs one says so.")
      .def_property_readonly("size", &Samples::size)
      .def_readonly("sliders_mm", &Samples::sliders_mm)
      .def_property_readonly("state", &state_of, "Columns of the state that are known, by name.")
      .def(
          "rows",
          [](const Samples& samples,
             const py::array_t<Eigen::Index, py::array::c_style | py::array::forcecast>& which) {
            return samples.rows({which.data(), which.data() + which.size()});
          },
          py::arg("which"), "Some rows; what is tabulated for the whole stays right for the part.")
      .def(
          "derive", [](Samples& samples, const Machine& machine) { derive(NominalGeometry(machine), samples); },
          py::arg("machine"), py::call_guard<py::gil_scoped_release>(),
          "Fill what follows from time_s, sweep and the sliders: motion, leg forces, nominal readings.");
}

}  // namespace hexdbb::bindings
