#include "bindings.hpp"
#include "hexdbb/circle_fit.hpp"
#include "hexdbb/contour_path.hpp"
#include "hexdbb/harmonics.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

void bind_contours(py::module_& module) {
  py::class_<FittedCircle>(module, "FittedCircle", "A circle in the plane of a path.")
      .def_readonly("centre_mm", &FittedCircle::centre_mm, "Shape (2,).")
      .def_readonly("radius_mm", &FittedCircle::radius_mm);
  py::class_<Zone>(module, "Zone", "Two concentric circles that enclose a path.")
      .def_readonly("centre_mm", &Zone::centre_mm, "Shape (2,).")
      .def_readonly("inner_mm", &Zone::inner_mm)
      .def_readonly("outer_mm", &Zone::outer_mm)
      .def_property_readonly(
          "width_mm", [](const Zone& zone) { return zone.outer_mm - zone.inner_mm; },
          "Radial separation of the two circles.");
  module.def("least_squares_circle", &least_squares_circle, py::arg("points_mm"),
             "Fit the circle with the smallest sum of squared radial distances to points (n, 2).\n\n"
             "Raises\n------\nValueError\n    Fewer than three points, or all on one line.");
  module.def("minimum_zone", &minimum_zone, py::arg("points_mm"),
             "Find the two concentric circles of smallest radial separation that enclose points (n, 2).\n\n"
             "Raises\n------\nValueError\n    Fewer than four points at different angles, or all on one line.\n"
             "RuntimeError\n    No zone was found within the iteration limit.");
  using Pair = std::pair<Eigen::VectorXd, Eigen::VectorXd>;
  module.def(
      "make_path",
      [](const Numbers& angle_rad, const Numbers& deviation_mm) {
        ContourPath found = make_path(angle_rad, deviation_mm);
        return Pair(std::move(found.angle_rad), std::move(found.deviation_mm));
      },
      py::arg("angle_rad"), py::arg("deviation_mm"),
      "Return angles (n,) in [0, 2 pi), rising, and the deviations at them. ValueError where lengths differ.");
  module.def("largest_gap_rad", &largest_gap_rad, py::arg("angle_rad"),
             "Return the largest arc without one of the angles (n,) of a path.");
  module.def("deviation_at", &deviation_at, py::arg("angle_rad"), py::arg("deviation_mm"), py::arg("at_rad"),
             "Return a path's deviation (mm) at other angles (m,), by periodic linear interpolation.");
  module.def(
      "mean_path",
      [](const Numbers& angle_rad, const Numbers& deviation_mm, const Ordinals& turn, double most_gap_rad) {
        ContourPath found = mean_path(angle_rad, deviation_mm, turn, most_gap_rad);
        return Pair(std::move(found.angle_rad), std::move(found.deviation_mm));
      },
      py::arg("angle_rad"), py::arg("deviation_mm"), py::arg("turn"), py::arg("most_gap_rad"),
      "Return angles and deviations, each (m,), of the mean of laps.\n\n"
      "Parameters\n----------\nangle_rad, deviation_mm : ndarray, shape (n,)\n"
      "turn : ndarray of int, shape (n,)\n    Lap of each sample.\n"
      "most_gap_rad : float\n    Laps with a longer arc without a sample do not count as long as another one does.\n\n"
      "Raises\n------\nValueError\n    Lengths that differ, or no samples.");
  module.def(
      "circular_hysteresis_mm",
      [](const Pair& one, const Pair& other) {
        return circular_hysteresis_mm({one.first, one.second}, {other.first, other.second});
      },
      py::arg("one"), py::arg("other"),
      "Return the largest difference (mm) of two paths, angles and deviations each, at an angle that either has.");
  module.def("path_points_mm", &path_points_mm, py::arg("angle_rad"), py::arg("deviation_mm"),
             py::arg("nominal_radius_mm"), "Return a path's places in its plane, (n, 2), about the nominal centre.");
  module.def("without_harmonics", &without_harmonics, py::arg("angle_rad"), py::arg("values"), py::arg("highest"),
             "Return values (n,) less their mean and their harmonics 1 to highest of angles (n,).");
  module.def(
      "lap_differences", &lap_differences, py::arg("angle_rad"), py::arg("lap"), py::arg("values"), py::arg("highest"),
      "Return the differences of each two consecutive laps of a sweep at one angle, in units of one value's noise.\n\n"
      "Parameters\n----------\nangle_rad, values : ndarray, shape (n,)\nlap : ndarray of int, shape (n,)\n"
      "highest : int\n    Harmonics that are removed from the values first.\n\n"
      "Raises\n------\nValueError\n    Lengths that differ.");
  module.def(
      "orthonormal_harmonics", &orthonormal_harmonics, py::arg("angle_rad"), py::arg("highest"),
      "Return a constant and harmonics 1 to highest of angles (n,) as orthonormal columns, (n, 1 + 2 highest).\n\n"
      "Raises\n------\nValueError\n    A negative number of harmonics.");
}

}  // namespace hexdbb::bindings
