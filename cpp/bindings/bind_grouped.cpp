#include "bindings.hpp"
#include "hexdbb/grouped.hpp"

namespace py = pybind11;

namespace hexdbb::bindings {

void bind_grouped(py::module_& module) {
  module.def("grouped_sums", &grouped_sums, py::arg("group"), py::arg("weight"), py::arg("table"), py::arg("groups"),
             "Return the sums of a table's weighted rows by group, W'T, shape (groups, k).\n\n"
             "Parameters\n----------\ngroup : ndarray of int32, shape (n, parts)\n"
             "    Group of each row and part, from 0.\n"
             "weight : ndarray, shape (n, parts)\ntable : ndarray, shape (n, k)\ngroups : int\n\n"
             "Raises\n------\nValueError\n    Shapes that differ, or a group out of range.");
}

}  // namespace hexdbb::bindings
