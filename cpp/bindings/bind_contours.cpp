#include "bindings.hpp"
#include "hexdbb/circle_fit.hpp"
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
  module.def(
      "orthonormal_harmonics", &orthonormal_harmonics, py::arg("angle_rad"), py::arg("highest"),
      "Return a constant and harmonics 1 to highest of angles (n,) as orthonormal columns, (n, 1 + 2 highest).\n\n"
      "Raises\n------\nValueError\n    A negative number of harmonics.");
}

}  // namespace hexdbb::bindings
