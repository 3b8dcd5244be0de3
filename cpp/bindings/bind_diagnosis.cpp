#include "bindings.hpp"
#include "hexdbb/diagnosis.hpp"
#include "hexdbb/normal_equations.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

FitResult fit_with(const Model& model, const Samples& samples, const Eigen::VectorXd& measured_mm, double noise_mm,
                   std::vector<bool> free, int max_iterations, double robust_mm, const Eigen::VectorXi& sweep,
                   bool hypothesis, bool from_minimum, bool covariance, const Eigen::VectorXd& prior_scale,
                   const Eigen::MatrixXd& starts) {
  FitOptions options;
  options.noise_mm = noise_mm;
  options.free = std::move(free);
  options.max_iterations = max_iterations;
  options.robust_mm = robust_mm;
  options.sweep = sweep;
  options.hypothesis = hypothesis;
  options.from_minimum = from_minimum;
  options.covariance = covariance;
  options.prior_scale = prior_scale;
  options.starts = starts;
  return fit(model, samples, measured_mm, options);
}

}  // namespace

void bind_diagnosis(py::module_& module) {
  py::class_<NormalEquations>(module, "NormalEquations",
                              "Normal equations of all readings, r = measured - predicted, J = d predicted / d value.")
      .def_readonly("information", &NormalEquations::information, "J'J, shape (size, size).")
      .def_readonly("gradient", &NormalEquations::gradient, "J'r, shape (size,).")
      .def_readonly("squared", &NormalEquations::squared, "r'r, mm^2.")
      .def_readonly("failure", &NormalEquations::failure, "First sample without a solution, or -1.");
  module.def("normal_equations", &normal_equations, py::arg("model"), py::arg("samples"), py::arg("measured_mm"),
             py::call_guard<py::gil_scoped_release>(),
             "Compute the normal equations for all values of a model in one pass. ValueError where lengths differ.");
  module.def("limit_threads", &limit_threads, py::arg("most"),
             "Limit the threads that fits use, in the whole process; 0: as many as cores. ValueError where negative.");
  py::class_<Identifiability>(module, "Identifiability", "Singular values and directions of a scaled Jacobian.")
      .def_readonly("singular_values", &Identifiability::singular_values)
      .def_readonly("directions", &Identifiability::directions)
      .def_readonly("rank", &Identifiability::rank)
      .def_readonly("condition", &Identifiability::condition, "Largest over smallest singular value within the rank.")
      .def_property_readonly("identifiable", &Identifiability::identifiable, "Directions within the rank, as columns.")
      .def_property_readonly("unidentifiable", &Identifiability::unidentifiable, "The other directions, as columns.");
  py::class_<FitResult>(module, "FitResult", "Estimates, covariance, rank, unidentifiable directions, termination.")
      .def_readonly("values", &FitResult::values, "Shape (size,), engine units.")
      .def_readonly("covariance", &FitResult::covariance, "Shape (size, size), prior included; 0 where not free.")
      .def_readonly("machine", &FitResult::machine, "Identifiability of the machine's own free values.")
      .def_readonly("free_columns", &FitResult::free_columns, "Indices of the free values.")
      .def_readonly("residual_mm", &FitResult::residual_mm, "Measured minus predicted, shape (n,).")
      .def_readonly("rms_before_mm", &FitResult::rms_before_mm)
      .def_readonly("rms_after_mm", &FitResult::rms_after_mm)
      .def_readonly("noise_mm", &FitResult::noise_mm, "The larger of the given noise and the RMS residual.")
      .def_readonly("correlation", &FitResult::correlation, "Integrated autocorrelation time of the residuals, rows.")
      .def_readonly("iterations", &FitResult::iterations)
      .def_readonly("usable", &FitResult::usable)
      .def_readonly("termination", &FitResult::termination, "Why the iteration ended.");
  module.def("fit", &fit_with, py::arg("model"), py::arg("samples"), py::arg("measured_mm"), py::kw_only(),
             py::arg("noise_mm"), py::arg("free") = std::vector<bool>(), py::arg("max_iterations") = 50,
             py::arg("robust_mm") = 0.0, py::arg("sweep") = Eigen::VectorXi(), py::arg("hypothesis") = false,
             py::arg("from_minimum") = false, py::arg("covariance") = true, py::arg("prior_scale") = Eigen::VectorXd(),
             py::arg("starts") = Eigen::MatrixXd(), py::call_guard<py::gil_scoped_release>(),
             "Fit the free values of a model to readings.\n\n"
             "Parameters\n----------\nmodel : Model\n    Its values are the start.\nsamples : Samples\n"
             "measured_mm : ndarray, shape (n,)\nnoise_mm : float\n    Standard deviation of one reading.\n"
             "free : sequence of bool, optional\n    One per value; all are free where empty.\n"
             "max_iterations : int\nrobust_mm : float\n    Huber's limit; 0: least squares.\n"
             "sweep : ndarray of int, shape (n,), optional\n"
             "    Capture of each sample, within which neighbours may be correlated.\n"
             "hypothesis : bool\n    Full fit of a hypothesis: faster, its covariance to first order.\n"
             "from_minimum : bool\n    Of a hypothesis: the start is the minimum of nearly the same readings.\n"
             "covariance : bool\n    Whether covariance and correlation are wanted; else they are empty and 1.\n"
             "prior_scale : ndarray, shape (size,), optional\n    Factors on the prior standard deviations.\n"
             "starts : ndarray, shape (size, k), optional\n"
             "    Of a hypothesis: further starts of its free values; the lowest coarse minimum is refined.\n\n"
             "Raises\n------\nValueError\n    Lengths that differ, no readings, nothing free, or a sample without a\n"
             "    solution at the start.");
  module.def("prior_sigmas", &prior_sigmas, py::arg("model"),
             "Return the prior standard deviation of each value of a model, (size,).");
  module.def(
      "autocorrelation_time", &autocorrelation_time, py::arg("residual"), py::arg("sweep"),
      "Return the integrated autocorrelation time of a residual within sweeps, rows, at least 1 (Geyer 1992).\n\n"
      "Parameters\n----------\nresidual : ndarray, shape (n,)\nsweep : ndarray of int, shape (n,)\n"
      "    Capture of each row.\n\nRaises\n------\nValueError\n    Lengths that differ.");
  module.def("identifiability", &identifiability, py::arg("scaled_jacobian"), py::kw_only(), py::arg("relative"),
             py::arg("absolute") = 0.0,
             "Compute rank, condition and directions of a scaled Jacobian.\n\n"
             "The rank counts singular values above relative times the largest and above absolute.");
  module.def("schur_complement", &schur_complement, py::arg("information"), py::arg("wanted"), py::arg("nuisance"),
             "Return J'J of the unknowns wanted, what the unknowns nuisance can explain projected out.\n\n"
             "Parameters\n----------\ninformation : ndarray, shape (k, k)\n    J'J of all unknowns.\n"
             "wanted, nuisance : sequence of int\n    Indices of unknowns; redundant nuisance unknowns do no harm.\n\n"
             "Raises\n------\nValueError\n    Where an index is out of range.");
  module.def(
      "project_out", &project_out, py::arg("jacobian"), py::arg("nuisance"),
      "Return the part of a Jacobian (n, k) that nuisance columns (n, m) cannot explain. ValueError where n differs.");
}

}  // namespace hexdbb::bindings
