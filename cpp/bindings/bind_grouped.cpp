#include "bindings.hpp"
#include "hexdbb/grouped.hpp"

namespace py = pybind11;

namespace hexdbb::bindings {

void bind_grouped(py::module_& module) {
  py::class_<DesignSums>(module, "DesignSums", "Sums of a design W over each group of its rows, with a table T.")
      .def_readonly("square", &DesignSums::square, "W'W of one group after another, shape (groups * columns, columns).")
      .def_readonly("cross", &DesignSums::cross, "W'T of one group after another, shape (groups * columns, k).");
  module.def("design_sums", &design_sums, py::arg("place"), py::arg("weight"), py::arg("group"), py::arg("table"),
             py::arg("columns"), py::arg("groups"), py::call_guard<py::gil_scoped_release>(),
             "Return the sums of a design and a table over each group of their rows.\n\n"
             "Parameters\n----------\nplace : ndarray of int32, shape (n, parts)\n"
             "    Column of each entry of the design.\n"
             "weight : ndarray, shape (n, parts)\n    The entries; those of one place add up.\n"
             "group : ndarray of int32, shape (n,)\n    Group of each row, from 0; below 0 for none.\n"
             "table : ndarray, shape (n, k)\ncolumns : int\n    Of the design.\ngroups : int\n\n"
             "Raises\n------\nValueError\n    Shapes that differ, or a place or group out of range.");
}

}  // namespace hexdbb::bindings
