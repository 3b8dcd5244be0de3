#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bindings.hpp"
#include "hexdbb/compensation.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

using Rows3 = Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;
using Rows6 = Eigen::Matrix<double, Eigen::Dynamic, kLegs, Eigen::RowMajor>;

Pose pose_of(const Rows3& position_mm, const Rows3& rpy_rad, Eigen::Index row) {
  return {position_mm.row(row).transpose(), rotation_from_rpy(rpy_rad(row, 0), rpy_rad(row, 1), rpy_rad(row, 2))};
}

/// Return the coordinates of the nominal sliders, one row per pose; NaN where one is out of reach.
Rows6 nominal_sliders(const NominalGeometry& nominal, const Rows3& position_mm, const Rows3& rpy_rad) {
  Rows6 out(position_mm.rows(), int{kLegs});
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    const InverseResult found = inverse(nominal, pose_of(position_mm, rpy_rad, row));
    out.row(row) = found.sliders_mm.transpose();
    if (found.status == Status::kUnreachable) out.row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

/// Return how the sliders move in a row: by the neighbours on either side, at an end by the next two rows but for the
/// velocity, which is that between the two rows there. Zero, and no accelerations, where one of them is out of reach.
Direction direction_in(const Rows6& sliders_mm, const Eigen::VectorXd& time_s, Eigen::Index row) {
  const Eigen::Index last = sliders_mm.rows() - 1;
  Direction out;
  if (last < 1) return out;
  const Eigen::Index before = std::max<Eigen::Index>(row - 1, 0), after = std::min(row + 1, last);
  if (last >= 2) {
    const Eigen::Index at = std::clamp<Eigen::Index>(row, 1, last - 1);
    out =
        direction_through(sliders_mm.row(at - 1).transpose(), sliders_mm.row(at).transpose(),
                          sliders_mm.row(at + 1).transpose(), time_s[at] - time_s[at - 1], time_s[at + 1] - time_s[at]);
  }
  const double step_s = time_s[after] - time_s[before];
  out.velocity_mm_s = (sliders_mm.row(after) - sliders_mm.row(before)).transpose() / step_s;
  if (!(step_s > 0.0) || !out.velocity_mm_s.allFinite()) out.velocity_mm_s.setZero();
  return out;
}

/// Compute targets along a path. Velocities and accelerations are those of the nominal sliders between the neighbours of
/// each row; directions of travel, and the travel since reversals, follow from the motion where none are given.
py::tuple sliders_along(Compensator& compensator, const Rows3& position_mm, const Rows3& rpy_rad,
                        const Eigen::VectorXd& time_s, const Eigen::VectorXd& temperature_c,
                        const std::optional<Rows6>& travel_direction,
                        const std::optional<std::pair<Rows6, Rows6>>& since_reversal_mm) {
  const Eigen::Index count = position_mm.rows();
  if (travel_direction && travel_direction->rows() != count)
    throw std::invalid_argument("travel_direction and position_mm differ in length");
  if (since_reversal_mm && (since_reversal_mm->first.rows() != count || since_reversal_mm->second.rows() != count))
    throw std::invalid_argument("since_reversal_mm and position_mm differ in length");
  if (rpy_rad.rows() != count || time_s.size() != count || temperature_c.size() != count) {
    throw std::invalid_argument("position_mm, rpy_rad, time_s and temperature_c differ in length");
  }
  Rows6 sliders(count, int{kLegs}), correction(count, int{kLegs});
  Eigen::VectorXi status(count), slider(count);
  std::optional<py::gil_scoped_release> others_may_run(std::in_place);  // such as a cyclic loop
  const Rows6 nominal_mm = nominal_sliders(NominalGeometry(compensator.machine()), position_mm, rpy_rad);
  for (Eigen::Index row = 0; row < count; ++row) {
    Direction direction = direction_in(nominal_mm, time_s, row);
    direction.temperature_c = temperature_c[row];
    if (travel_direction) direction.travel_direction = travel_direction->row(row).transpose();
    if (since_reversal_mm) {
      direction.since_reversal_mm = {since_reversal_mm->first.row(row).transpose(),
                                     since_reversal_mm->second.row(row).transpose()};
    }
    const SliderTargets targets = compensator.sliders(pose_of(position_mm, rpy_rad, row), direction);
    sliders.row(row) = targets.sliders_mm.transpose();
    correction.row(row) = targets.correction_mm.transpose();
    if (targets.status == Status::kCorrectionLimit) correction(row, targets.slider) = targets.largest_correction_mm;
    status[row] = static_cast<int>(targets.status);
    slider[row] = targets.slider;
  }
  others_may_run.reset();
  return py::make_tuple(sliders, correction, status, slider);
}

py::tuple poses_of(Compensator& compensator, const Rows6& sliders_mm) {
  RowMajorMatrix pose(sliders_mm.rows(), 12);
  Eigen::VectorXi status(sliders_mm.rows());
  for (Eigen::Index row = 0; row < sliders_mm.rows(); ++row) {
    const PoseEstimate found = compensator.pose(sliders_mm.row(row).transpose());
    pose.row(row).head<3>() = found.pose.position.transpose();
    for (int i = 0; i < 9; ++i) pose(row, 3 + i) = found.pose.rotation(i / 3, i % 3);
    status[row] = static_cast<int>(found.status);
  }
  return py::make_tuple(pose, status);
}

using PushTuple = std::tuple<int, int, double>;  // element, column within the port, weight

CompensationTable table_of(const std::string& effect, const std::string& port, const std::string& variable,
                           const std::string& times, double period, const std::vector<PushTuple>& pushes,
                           const std::vector<double>& knots, const std::vector<double>& values_mm) {
  CompensationTable out{effect, port, variable, times, period, {}, knots, values_mm};
  for (const auto& [element, column, weight] : pushes) out.pushes.push_back({element, column, weight});
  return out;
}

void bind_table(py::module_& module) {
  py::class_<CompensationTable>(module, "CompensationTable",
                                "A function in compensation data; see compensation_tables.hpp.")
      .def(py::init(&table_of), py::kw_only(), py::arg("effect"), py::arg("port"), py::arg("variable"),
           py::arg("times"), py::arg("period"), py::arg("pushes"), py::arg("knots"), py::arg("values_mm"),
           "Make a table.\n\n"
           "Parameters\n----------\neffect : str\nport : str\nvariable, times : str\n"
           "    Columns of the samples' state; empty where there is none.\nperiod : float\n"
           "pushes : sequence of (element, column, weight)\n    Element and column of the port from 0.\n"
           "knots, values_mm : sequence of float")
      .def_readonly("effect", &CompensationTable::effect)
      .def_readonly("port", &CompensationTable::port)
      .def_readonly("variable", &CompensationTable::variable)
      .def_readonly("times", &CompensationTable::times)
      .def_readonly("period", &CompensationTable::period)
      .def_property_readonly(
          "pushes",
          [](const CompensationTable& table) {
            std::vector<PushTuple> out;
            for (const TablePush& each : table.pushes) out.emplace_back(each.element, each.column, each.weight);
            return out;
          },
          "Element and column of the port, both from 0, and weight.")
      .def_readonly("knots", &CompensationTable::knots)
      .def_readonly("values_mm", &CompensationTable::values_mm);
  std::vector<std::string> variables;
  for (const TableVariableInfo& each : kTableVariables) {
    if (each.variable != TableVariable::kNone) variables.emplace_back(each.column);
  }
  module.attr("TABLE_VARIABLES") = py::tuple(py::cast(variables));
  module.attr("LONG_AGO") = kLongAgo;
}

/// Return the names of the effects that data correct, those of tables last, each once.
std::vector<std::string> corrected(const CompensationData& data) {
  std::vector<std::string> out;
  for (const CompensatedEffect& each : data.effects) out.push_back(each.name);
  for (const CompensationTable& each : data.tables) {
    if (std::find(out.begin(), out.end(), each.effect) == out.end()) out.push_back(each.effect);
  }
  return out;
}

}  // namespace

void bind_compensation(py::module_& module) {
  py::register_exception<CompensationError>(module, "CompensationError", PyExc_ValueError);

  bind_table(module);
  py::class_<CompensationData>(module, "CompensationData",
                               "Compensation data that a controller loads; see compensation_file.hpp.")
      .def_readonly("name", &CompensationData::name)
      .def_readonly("model_sha256", &CompensationData::model_sha256)
      .def_readonly("record_sha256", &CompensationData::record_sha256,
                    "Content hashes of the records that the model was fitted to.")
      .def_readonly("reference_temperature_c", &CompensationData::reference_temperature_c)
      .def_readonly("machine", &CompensationData::machine)
      .def_property_readonly("max_correction_mm", [](const CompensationData& d) { return d.limits.max_correction_mm; })
      .def_property_readonly("reversal_travel_mm",
                             [](const CompensationData& d) { return d.limits.reversal_travel_mm; })
      .def_property_readonly("effects", &corrected, "Names of the effects that are corrected.")
      .def_readonly("tables", &CompensationData::tables, "Functions of learned and users' effects.")
      .def_property_readonly(
          "left_out",
          [](const CompensationData& data) {
            std::vector<std::pair<std::string, std::string>> out;
            for (const LeftOut& each : data.left_out) out.emplace_back(each.effect, each.reason);
            return out;
          },
          "Effects that are not corrected, each with the reason.")
      .def("text", &compensation_text, "Return the content of a compensation file.")
      .def("header", &compensation_header, "Return the same as constants of a C program.");

  module.def(
      "compensation_of",
      [](const Model& model, const std::string& name, const std::string& model_sha256, double max_correction_mm,
         double reversal_travel_mm, double reference_temperature_c, const std::vector<CompensationTable>& tables,
         const std::vector<std::pair<std::string, std::string>>& left_out,
         const std::vector<std::string>& record_sha256) {
        CompensationData data = compensation_of(model, name, model_sha256, {max_correction_mm, reversal_travel_mm},
                                                reference_temperature_c, tables);
        for (const auto& [effect, reason] : left_out) data.left_out.push_back({effect, reason});
        data.record_sha256 = record_sha256;
        return data;
      },
      py::arg("model"), py::kw_only(), py::arg("name"), py::arg("model_sha256"), py::arg("max_correction_mm"),
      py::arg("reversal_travel_mm"), py::arg("reference_temperature_c"),
      py::arg("tables") = std::vector<CompensationTable>(),
      py::arg("left_out") = std::vector<std::pair<std::string, std::string>>(),
      py::arg("record_sha256") = std::vector<std::string>(),
      "Select the effects of a model that a controller can correct, and state why the others are left out.\n\n"
      "Parameters\n----------\nmodel : Model\nname : str\n    Of the machine.\n"
      "model_sha256 : str\n    Of the model file.\nmax_correction_mm, reversal_travel_mm : float\n"
      "reference_temperature_c : float\n    Temperature at which no growth is corrected; nan where not known.\n"
      "tables : sequence of CompensationTable, optional\n    Of effects that the engine does not have.\n"
      "left_out : sequence of (str, str), optional\n    Effects without a table, each with the reason.\n"
      "record_sha256 : sequence of str, optional\n    Content hashes of the records the model was fitted to.");
  module.def("read_compensation", &read_compensation, py::arg("path"),
             "Read a compensation file. CompensationError where it is refused, with the reason.");
  module.def("require_machine", &require_machine, py::arg("of_data"), py::arg("of_controller"), py::arg("source"),
             "Raise CompensationError, naming the first dimension that differs, unless both machines are the same.");

  module.attr("CORRECTION_LIMIT") = static_cast<int>(Status::kCorrectionLimit);
  py::class_<Compensator>(module, "Compensator", "Slider targets under every effect of compensation data.")
      .def(py::init<const CompensationData&, const std::string&>(), py::arg("data"), py::arg("source"))
      .def("sliders_along", &sliders_along, py::arg("position_mm"), py::arg("rpy_rad"), py::arg("time_s"),
           py::arg("temperature_c"), py::arg("travel_direction") = py::none(),
           py::arg("since_reversal_mm") = py::none(),
           "Compute slider targets of poses in order of motion.\n\n"
           "Parameters\n----------\nposition_mm, rpy_rad : ndarray, shape (n, 3)\n"
           "time_s, temperature_c : ndarray, shape (n,)\n    Temperature nan where not measured.\n"
           "travel_direction : ndarray, shape (n, 6), optional\n"
           "    -1 to 1 per slider, where the motion to come is known; from the motion so far where not given.\n"
           "since_reversal_mm : pair of ndarray, shape (n, 6), optional\n"
           "    Travel since a reversal, of motion down and of motion up; likewise.\n\n"
           "Returns\n-------\nsliders_mm, correction_mm : ndarray, shape (n, 6)\n"
           "    A refused row has the last targets and, where a correction is too large, its size.\n"
           "status, slider : ndarray of int, shape (n,)\n    Slider at fault from 0, or -1.")
      .def("poses_of", &poses_of, py::arg("sliders_mm"),
           "Compute the poses, (n, 12) as x, y, z in mm and the rotation row by row, and status (n,), of slider "
           "coordinates (n, 6).")
      .def("enable", &Compensator::enable, py::arg("on"),
           "Switch compensation off or on; it fades over the next 500 poses.")
      .def("reset", &Compensator::reset, "Forget the motion so far, as after homing.");
}

}  // namespace hexdbb::bindings
