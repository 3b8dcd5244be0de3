#include <pybind11/numpy.h>

#include "bindings.hpp"
#include "hexdbb/prediction.hpp"
#include "hexdbb/run_up.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

/// Fill the columns of a state from a dict of arrays by name; ValueError on an unknown name.
State make_state(const py::dict& columns) {
  State state;
  std::size_t used = 0;
  for_each_column(state, [&](const ColumnInfo& info, auto& column) {
    if (!columns.contains(info.name)) return;
    column = columns[info.name].template cast<std::decay_t<decltype(column)>>();
    ++used;
  });
  if (used == columns.size()) return state;
  for (const auto& item : columns) {
    const std::string given = item.first.cast<std::string>();
    bool known = false;
    for_each_column(state, [&](const ColumnInfo& info, const auto&) { known = known || given == info.name; });
    if (!known) throw std::invalid_argument("a sample's state has no column " + given);
  }
  return state;
}

Samples make_samples(SliderTable sliders_mm, Eigen::VectorXi set_up, Eigen::VectorXi mount, std::vector<SetUp> set_ups,
                     const py::dict& state) {
  Samples samples{std::move(sliders_mm), std::move(set_up), std::move(mount), std::move(set_ups), make_state(state)};
  samples.validate();
  return samples;
}

py::dict state_of(const Samples& samples) {
  py::dict out;
  for_each_column(samples.state, [&](const ColumnInfo& info, const auto& column) {
    if (column.size() > 0) out[info.name] = column;
  });
  return out;
}

/// A column of the vocabulary as Python sees it.
struct NamedColumn {
  ColumnInfo info;
  int width;
};

const char* name_of(ColumnOf of) {
  switch (of) {
    case ColumnOf::kAxis:
      return "axis";
    case ColumnOf::kSlider:
      return "slider";
    case ColumnOf::kLeg:
      return "leg";
    case ColumnOf::kSample:
      break;
  }
  return "sample";
}

std::vector<NamedColumn> state_columns() {
  std::vector<NamedColumn> out = {{kSlidersColumn, kLegs}};
  State state;
  for_each_column(state, [&](const ColumnInfo& info, const auto& column) {
    out.push_back({info, static_cast<int>(std::decay_t<decltype(column)>::ColsAtCompileTime)});
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
      .def_readonly("cup_mm", &SetUp::cup_mm, "Tool cup, base frame.")
      .def_readonly("ball_offset_mm", &SetUp::ball_offset_mm, "Centre ball, platform frame.")
      .def_readonly("bar_length_mm", &SetUp::bar_length_mm);

  py::class_<NamedColumn>(module, "StateColumn", "Description of one column of a sample's state.")
      .def_property_readonly("name", [](const NamedColumn& column) { return column.info.name; })
      .def_property_readonly("unit", [](const NamedColumn& column) { return column.info.unit; })
      .def_property_readonly("meaning", [](const NamedColumn& column) { return column.info.meaning; })
      .def_property_readonly(
          "of", [](const NamedColumn& column) { return name_of(column.info.of); },
          "What its numbers belong to: sample (shape (n,)), axis ((n, 3): x, y, z or roll, pitch, yaw), slider or leg "
          "((n, 6)).")
      .def_readonly("width", &NamedColumn::width, "Numbers per sample: 1, 3 or 6.")
      .def_property_readonly(
          "may_be_nan", [](const NamedColumn& column) { return column.info.may_be_nan; },
          "Whether nan is a value: not measured.");
  module.attr("RUN_UP_RAD") = kRunUp_rad;
  module.def(
      "run_up",
      [](const Eigen::VectorXd& time_s, const Eigen::VectorXd& angle_rad, double run_up_rad) {
        if (time_s.size() != angle_rad.size()) throw std::invalid_argument("times and angles differ in number");
        const RunUp found = run_up(time_s, angle_rad, run_up_rad);
        return py::make_tuple(found.first, found.end, found.lap_s);
      },
      py::arg("time_s"), py::arg("angle_rad"), py::arg("run_up_rad") = kRunUp_rad,
      "Return the rows of a sweep, from the first to before the last, that lie a lap behind the run-up to it, and the\n"
      "time of that lap, s; no rows where the sweep is less than a lap.\n\n"
      "Parameters\n----------\ntime_s, angle_rad : ndarray, shape (n,)\n    Times, which rise, and polar angles, with "
      "or\n"
      "    without their turns.\nrun_up_rad : float\n\nRaises\n------\nValueError\n    Where times and angles differ "
      "in number.");
  module.def("state_columns", &state_columns,
             "Return every column of a sample's state, sliders_mm first: the one vocabulary of names and units.");

  py::class_<Samples>(module, "Samples", "Samples of a record, one row each, with what is known of their state.")
      .def(py::init(&make_samples), py::kw_only(), py::arg("sliders_mm"), py::arg("set_up"), py::arg("mount"),
           py::arg("set_ups"), py::arg("state") = py::dict(),
           "Build samples.\n\n"
           "Parameters\n----------\nsliders_mm : ndarray, shape (n, 6)\n    As the encoders report them.\n"
           "set_up : ndarray of int, shape (n,)\n    Index into set_ups.\n"
           "mount : ndarray of int, shape (n,)\n    Fixing of the tool cup, from 0.\n"
           "set_ups : sequence of SetUp\nstate : dict of str to ndarray, optional\n"
           "    Columns by name (state_columns()), each of n rows; any may be missing.\n\n"
           "Raises\n------\nValueError\n    An unknown column, a column of another length, an index out of range.")
      .def_property_readonly("size", &Samples::size)
      .def_readonly("sliders_mm", &Samples::sliders_mm)
      .def_readonly("set_up", &Samples::set_up)
      .def_readonly("mount", &Samples::mount)
      .def_readonly("set_ups", &Samples::set_ups)
      .def_property_readonly("state", &state_of, "Columns of the state that are known, by name.")
      .def_property_readonly(
          "known",
          [](const Samples& samples) {
            std::vector<std::string> out;
            for_each_column(samples.state, [&](const ColumnInfo& info, const auto& column) {
              if (column.size() > 0) out.emplace_back(info.name);
            });
            return out;
          },
          "Names of the columns of the state that are known.")
      .def(
          "column",
          [](const Samples& samples, const std::string& name) {
            py::object out = py::none();
            for_each_column(samples.state, [&](const ColumnInfo& info, const auto& column) {
              if (name == info.name && column.size() > 0) out = py::cast(column);
            });
            return out;
          },
          py::arg("name"), "Return a column of the state, None where it is not known.")
      .def(
          "rows",
          [](const Samples& samples,
             const py::array_t<Eigen::Index, py::array::c_style | py::array::forcecast>& which) {
            return samples.rows({which.data(), which.data() + which.size()});
          },
          py::arg("which"),
          "Return some rows, by index from 0; they remember their place in the table. ValueError where there is no "
          "such "
          "row.")
      .def(
          "derive",
          [](Samples& samples, const Machine& machine, const std::vector<std::string>& columns) {
            derive(NominalGeometry(machine), samples, columns);
          },
          py::arg("machine"), py::arg("columns") = std::vector<std::string>(), py::call_guard<py::gil_scoped_release>(),
          "Compute columns that follow from time_s, sweep, angle_rad and the sliders: those named, and what is found "
          "on\n"
          "the way; all where none is named.\n\n"
          "Raises\n------\nValueError\n    Where time_s or sweep is missing, or time does not rise within a sweep, or "
          "a\n"
          "    column is named that follows from no others.");
}

}  // namespace hexdbb::bindings
