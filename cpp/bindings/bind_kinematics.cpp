#include <stdexcept>

#include "bindings.hpp"
#include "hexdbb/kinematics.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

using Rows3 = Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>;
using Rows6 = Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>>;
using PortVector = Eigen::Matrix<double, port::kCount, 1>;

py::tuple inverse_table(const Machine& machine, const Rows3& position_mm, const Rows3& rpy_rad) {
  if (position_mm.rows() != rpy_rad.rows())
    throw std::invalid_argument("position_mm has " + std::to_string(position_mm.rows()) + " rows, rpy_rad " +
                                std::to_string(rpy_rad.rows()) + "; expected the same number");
  const NominalGeometry nominal(machine);
  const Ports none;
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> sliders(position_mm.rows(), 6);
  Eigen::VectorXi status(position_mm.rows()), leg(position_mm.rows());
  for (Eigen::Index row = 0; row < position_mm.rows(); ++row) {
    const Pose pose{position_mm.row(row).transpose(),
                    rotation_from_rpy(rpy_rad(row, 0), rpy_rad(row, 1), rpy_rad(row, 2))};
    const InverseResult result = inverse(nominal, pose, none);
    sliders.row(row) = result.sliders_mm.transpose();
    status[row] = static_cast<int>(result.status);
    leg[row] = result.leg;
  }
  return py::make_tuple(sliders, status, leg);
}

py::tuple as_tuple(const ForwardResult& result) {
  return py::make_tuple(result.pose.position, result.pose.rotation, result.residual_mm, result.iterations,
                        static_cast<int>(result.status));
}

py::tuple forward_one(const Machine& machine, const Vector6& sliders_mm, const PortVector& push) {
  Ports ports;
  ports.value = push;
  RssrAngles angles;
  return as_tuple(forward(assemble(NominalGeometry(machine), sliders_mm, ports), angles));
}

py::tuple forward_six_one(const Machine& machine, const Vector6& sliders_mm, const PortVector& push) {
  Ports ports;
  ports.value = push;
  const NominalGeometry nominal(machine);
  return as_tuple(forward_six(assemble(nominal, sliders_mm, ports), home_pose(nominal)));
}

const char* name_of_status(int code) {
  if (code < 0 || code > static_cast<int>(Status::kLast)) {
    throw std::invalid_argument("no status has the code " + std::to_string(code) + ", expected 0 to " +
                                std::to_string(static_cast<int>(Status::kLast)));
  }
  return status_name(static_cast<Status>(code));
}

Vector3 rssr_angles(const Machine& machine, const Vector6& sliders_mm) {
  RssrAngles angles;
  forward(assemble(NominalGeometry(machine), sliders_mm, Ports()), angles);
  return angles.angle_rad();
}

}  // namespace

void bind_kinematics(py::module_& module) {
  module.def("status_name", &name_of_status, py::arg("code"),
             "Return what a status code of the kinematics means. ValueError for an unknown code.");
  module.def("inverse_table", &inverse_table, py::arg("machine"), py::arg("position_mm"), py::arg("rpy_rad"),
             "Compute the slider coordinates of poses of the nominal machine.\n\n"
             "Parameters\n----------\nmachine : Machine\nposition_mm : ndarray, shape (n, 3)\n"
             "rpy_rad : ndarray, shape (n, 3)\n\n"
             "Returns\n-------\nsliders_mm : ndarray, shape (n, 6)\nstatus : ndarray of int, shape (n,)\n"
             "    0: reached; see status_name.\nleg : ndarray of int, shape (n,)\n    Leg at fault from 0, or -1.");
  module.def("forward_one", &forward_one, py::arg("machine"), py::arg("sliders_mm"), py::arg("push"),
             "Solve the RSSR loops from home: position, rotation, residual_mm, iterations, status.");
  module.def("forward_six_one", &forward_six_one, py::arg("machine"), py::arg("sliders_mm"), py::arg("push"),
             "Solve the six pose coordinates from home: position, rotation, residual_mm, iterations, status.");
  module.def("rssr_angles", &rssr_angles, py::arg("machine"), py::arg("sliders_mm"),
             "Compute theta, delta, phi of the nominal machine, (3,) in rad, with the thesis' signs.");
  py::dict spans;
  for (const PortSpan& span : port::kSpans) spans[span.name] = py::make_tuple(span.first, span.size);
  module.attr("PORTS") = spans;
}

}  // namespace hexdbb::bindings
