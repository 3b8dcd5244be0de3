#include "bindings.hpp"
#include "hexdbb/machine.hpp"

namespace hexdbb::bindings {

namespace py = pybind11;

namespace {

int checked(int guideway) {
  if (guideway < 0 || guideway >= kGuideways) {
    throw py::index_error("guideway is " + std::to_string(guideway) + ", expected 0 to " +
                          std::to_string(kGuideways - 1));
  }
  return guideway;
}

}  // namespace

void bind_machine(py::module_& module) {
  py::class_<Machine>(module, "Machine", "Nominal dimensions of a HexGlider.")
      .def(py::init([](double base_inradius_mm, double platform_circumradius_mm, double joint_plane_height_mm,
                       const PerLeg& leg_length_mm, const PerLeg& travel_min_mm, const PerLeg& travel_max_mm,
                       double min_gap_mm, double screw_lead_mm, double moved_mass_kg,
                       const PerGuideway& guideway_angle_rad, const PerGuideway& joint_angle_rad) {
             return Machine{base_inradius_mm,
                            platform_circumradius_mm,
                            joint_plane_height_mm,
                            leg_length_mm,
                            travel_min_mm,
                            travel_max_mm,
                            min_gap_mm,
                            screw_lead_mm,
                            moved_mass_kg,
                            guideway_angle_rad,
                            joint_angle_rad};
           }),
           py::kw_only(), py::arg("base_inradius_mm"), py::arg("platform_circumradius_mm"),
           py::arg("joint_plane_height_mm"), py::arg("leg_length_mm"), py::arg("travel_min_mm"),
           py::arg("travel_max_mm"), py::arg("min_gap_mm"), py::arg("screw_lead_mm"), py::arg("moved_mass_kg"),
           py::arg("guideway_angle_rad"), py::arg("joint_angle_rad"))
      .def_readonly("base_inradius_mm", &Machine::base_inradius_mm)
      .def_readonly("platform_circumradius_mm", &Machine::platform_circumradius_mm)
      .def_readonly("joint_plane_height_mm", &Machine::joint_plane_height_mm)
      .def_readonly("leg_length_mm", &Machine::leg_length_mm)
      .def_readonly("travel_min_mm", &Machine::travel_min_mm)
      .def_readonly("travel_max_mm", &Machine::travel_max_mm)
      .def_readonly("min_gap_mm", &Machine::min_gap_mm)
      .def_readonly("screw_lead_mm", &Machine::screw_lead_mm)
      .def_readonly("moved_mass_kg", &Machine::moved_mass_kg)
      .def_readonly("guideway_angle_rad", &Machine::guideway_angle_rad)
      .def_readonly("joint_angle_rad", &Machine::joint_angle_rad);
  module.def(
      "guideway_vertex",
      [](const Machine& machine, int guideway) { return guideway_vertex(machine, checked(guideway)); },
      py::arg("machine"), py::arg("guideway"),
      "Return V of guideway 0..2, (3,) in mm, base frame. IndexError for any other guideway.");
  module.def(
      "guideway_direction",
      [](const Machine& machine, int guideway) { return guideway_direction(machine, checked(guideway)); },
      py::arg("machine"), py::arg("guideway"),
      "Return d of guideway 0..2, unit vector (3,), base frame. IndexError for any other guideway.");
  module.def(
      "guideway_midpoint",
      [](const Machine& machine, int guideway) { return guideway_midpoint(machine, checked(guideway)); },
      py::arg("machine"), py::arg("guideway"),
      "Return the point of guideway 0..2 nearest to the base centre, (3,) in mm, base frame. IndexError for any other "
      "guideway.");
  module.def(
      "guideway_axes", [](const Machine& machine, int guideway) { return guideway_axes(machine, checked(guideway)); },
      py::arg("machine"), py::arg("guideway"),
      "Return the local axes of guideway 0..2 as columns (3, 3): outward, -d, up. IndexError for any other guideway.");
  module.def(
      "platform_joint", [](const Machine& machine, int guideway) { return platform_joint(machine, checked(guideway)); },
      py::arg("machine"), py::arg("guideway"),
      "Return the nominal ball joint of guideway 0..2, (3,) in mm, platform frame. IndexError for any other guideway.");
  module.def("rotation_from_rpy", &rotation_from_rpy, py::arg("roll_rad"), py::arg("pitch_rad"), py::arg("yaw_rad"),
             "Compute Rz(yaw) Ry(pitch) Rx(roll), (3, 3), thesis (2.27).");
  module.def("rpy_from_rotation", &rpy_from_rotation, py::arg("rotation"),
             "Compute roll, pitch and yaw in rad, (3,), for |pitch| below 90 deg; inverse of rotation_from_rpy.");
}

}  // namespace hexdbb::bindings
