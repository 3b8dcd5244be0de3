#include "bindings.hpp"
#include "hexdbb/captures.hpp"
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
      "mean_paths",
      [](const Numbers& angle_rad, const Numbers& deviation_mm, const Ordinals& turn, const std::vector<Rows>& captures,
         double most_gap_rad) {
        std::vector<Pair> out;
        for (ContourPath& found : mean_paths(angle_rad, deviation_mm, turn, captures, most_gap_rad)) {
          out.emplace_back(std::move(found.angle_rad), std::move(found.deviation_mm));
        }
        return out;
      },
      py::arg("angle_rad"), py::arg("deviation_mm"), py::arg("turn"), py::arg("captures"), py::arg("most_gap_rad"),
      "Return angles and deviations, each (m,), of the mean of each capture's laps.\n\n"
      "Parameters\n----------\nangle_rad, deviation_mm : ndarray, shape (n,)\n"
      "turn : ndarray of int, shape (n,)\n    Lap of each sample.\n"
      "captures : list of ndarray of int\n    Rows of each.\n"
      "most_gap_rad : float\n    Laps with a longer arc without a sample do not count as long as another one does.\n\n"
      "Raises\n------\nValueError\n    Lengths that differ, a row that is not there, or no samples.");
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
      "lap_differences",
      py::overload_cast<const Numbers&, const Ordinals&, const Numbers&, const std::vector<Rows>&,
                        const std::vector<int>&>(&lap_differences),
      py::arg("angle_rad"), py::arg("lap"), py::arg("values"), py::arg("captures"), py::arg("highest"),
      "Return the differences of each two consecutive laps of captures at one angle, in units of one value's noise.\n\n"
      "Parameters\n----------\nangle_rad, values : ndarray, shape (n,)\nlap : ndarray of int, shape (n,)\n"
      "captures : list of ndarray of int\n    Rows of each.\n"
      "highest : list of int\n    Harmonics that are removed from each capture's values first.\n\n"
      "Raises\n------\nValueError\n    Lengths that differ, or a row that is not there.");
  py::class_<CaptureHarmonics>(module, "CaptureHarmonics",
                               "The lowest harmonics of several captures, fitted to any number of columns.")
      .def(py::init<const Numbers&, std::vector<Rows>, int>(), py::arg("angle_rad"), py::arg("captures"),
           py::arg("highest"),
           "Prepare the harmonics.\n\n"
           "Parameters\n----------\nangle_rad : ndarray, shape (n,)\n"
           "captures : list of ndarray of int\n    Rows of each.\nhighest : int\n\n"
           "Raises\n------\nValueError\n    A row that is not there, or a negative number of harmonics.")
      .def(
          "split",
          [](const CaptureHarmonics& harmonics, const Numbers& values) {
            SplitColumn found = harmonics.split(values);
            return std::pair(std::move(found.taken), std::move(found.left));
          },
          py::arg("values"),
          "Fit a column (n,) by mean and harmonics of each capture.\n\n"
          "Returns\n-------\ntaken : ndarray, shape (captures, 1 + 2 highest)\n"
          "    Components along orthonormal columns.\nleft : ndarray, shape (n,)\n"
          "    What is left; zero in rows of no capture.\n\n"
          "Raises\n------\nValueError\n    A column of another length.");
  module.def(
      "compare_with_neighbours",
      [](const Numbers& angle_rad, const Numbers& values, const std::vector<Rows>& captures, double noise,
         int neighbours, double dense_rad, double doubtful, double alone) {
        Neighbours found =
            compare_with_neighbours(angle_rad, values, captures, noise, {neighbours, dense_rad, doubtful, alone});
        return std::pair(std::move(found.off), std::move(found.alone));
      },
      py::arg("angle_rad"), py::arg("values"), py::arg("captures"), py::arg("noise"), py::kw_only(),
      py::arg("neighbours"), py::arg("dense_rad"), py::arg("doubtful"), py::arg("alone"),
      "Compare values (n,) with their neighbours in a capture.\n\n"
      "Parameters\n----------\nnoise : float\n    Least standard deviation of one value.\n"
      "neighbours : int\n    Values to each side whose median is expected.\n"
      "dense_rad : float\n    Median angle between values up to which neighbours say what to expect.\n"
      "doubtful : float\n"
      "    Standard deviations from the middle of both neighbours from which a value is looked at.\n"
      "alone : float\n    Standard deviations from the median of all neighbours beyond which it stands alone.\n\n"
      "Returns\n-------\noff : ndarray, shape (n,)\n"
      "    Distance from the middle of both neighbours, in standard deviations; at the ends of a capture from lines\n"
      "    through the values behind.\n"
      "alone : ndarray of bool, shape (n,)\n\n"
      "Raises\n------\nValueError\n    Lengths that differ, or a row that is not there.");
}

}  // namespace hexdbb::bindings
