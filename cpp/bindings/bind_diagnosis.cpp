#include "bindings.hpp"
#include "hexdbb/diagnosis.hpp"
#include "hexdbb/normal_equations.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

FitResult fit_with(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, double noise_mm,
                   std::vector<bool> free, int max_iterations, double robust_mm, const Eigen::VectorXi& sweep,
                   bool judging) {
  FitOptions options;
  options.noise_mm = noise_mm;
  options.free = std::move(free);
  options.max_iterations = max_iterations;
  options.robust_mm = robust_mm;
  options.sweep = sweep;
  options.judging = judging;
  return fit(model, samples, measured_mm, options);
}

}  // namespace

void bind_diagnosis(py::module_& module) {
  py::class_<NormalEquations>(module, "NormalEquations", "J'J, J'r and r'r of all readings, r = measured - predicted.")
      .def_readonly("information", &NormalEquations::information)
      .def_readonly("gradient", &NormalEquations::gradient)
      .def_readonly("squared", &NormalEquations::squared)
      .def_property_readonly("failure", [](const NormalEquations& equations) { return equations.failure; });
  module.def("normal_equations", &normal_equations, py::arg("model"), py::arg("samples"), py::arg("measured_mm"),
             py::call_guard<py::gil_scoped_release>(), "Normal equations for all values of a model, in one pass.");
  py::class_<Identifiability>(module, "Identifiability", "Singular values and directions of a scaled Jacobian.")
      .def_readonly("singular_values", &Identifiability::singular_values)
      .def_readonly("directions", &Identifiability::directions)
      .def_readonly("rank", &Identifiability::rank)
      .def_readonly("condition", &Identifiability::condition)
      .def_property_readonly("identifiable", &Identifiability::identifiable)
      .def_property_readonly("unidentifiable", &Identifiability::unidentifiable);
  py::class_<FitResult>(module, "FitResult", "Estimates, covariance, rank, unidentifiable directions, termination.")
      .def_readonly("values", &FitResult::values)
      .def_readonly("covariance", &FitResult::covariance)
      .def_readonly("machine", &FitResult::machine)
      .def_readonly("free_columns", &FitResult::free_columns)
      .def_readonly("residual_mm", &FitResult::residual_mm)
      .def_readonly("rms_before_mm", &FitResult::rms_before_mm)
      .def_readonly("rms_after_mm", &FitResult::rms_after_mm)
      .def_readonly("noise_mm", &FitResult::noise_mm)
      .def_readonly("correlation", &FitResult::correlation)
      .def_readonly("iterations", &FitResult::iterations)
      .def_readonly("usable", &FitResult::usable)
      .def_readonly("termination", &FitResult::termination);
  module.def("fit", &fit_with, py::arg("model"), py::arg("samples"), py::arg("measured_mm"), py::kw_only(),
             py::arg("noise_mm"), py::arg("free") = std::vector<bool>(), py::arg("max_iterations") = 50,
             py::arg("robust_mm") = 0.0, py::arg("sweep") = Eigen::VectorXi(), py::arg("judging") = false,
             py::call_guard<py::gil_scoped_release>(), "Fit the free values of a model to readings.");
  module.def("expected_sizes", &expected_sizes, py::arg("model"), "Prior sigma of each value of a model.");
  module.def("identifiability", &identifiability, py::arg("scaled_jacobian"), py::kw_only(), py::arg("relative"),
             py::arg("absolute") = 0.0, "Rank, condition and directions of a scaled Jacobian.");
  module.def("project_out", &project_out, py::arg("jacobian"), py::arg("nuisance"),
             "The part of a Jacobian that nuisance columns cannot explain.");
}

}  // namespace hexdbb::bindings
