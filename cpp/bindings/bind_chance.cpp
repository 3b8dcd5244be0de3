#include "bindings.hpp"
#include "hexdbb/chance.hpp"

namespace py = pybind11;

namespace hexdbb::bindings {

void bind_chance(py::module_& module) {
  module.def("f_tail", &f_tail, py::arg("numerator"), py::arg("denominator"), py::arg("value"),
             "Return the probability that F with these degrees of freedom (above 0) exceeds a value.");
  module.def("chi_square_tail", &chi_square_tail, py::arg("freedom"), py::arg("value"),
             "Return the probability that chi-square with these degrees of freedom (above 0) exceeds a value.");
  module.def("log_normal_below", &log_normal_below, py::arg("value"),
             "Return the logarithm of the probability that a standard normal value lies below a value.");
}

}  // namespace hexdbb::bindings
