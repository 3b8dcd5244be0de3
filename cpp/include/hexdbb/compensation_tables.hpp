// Functions given as tables: how learned effects, and users' effects that depend on one variable, reach a controller.
//
// Model: push at a port column = weight x times x f(variable), f linear between its knots and held beyond them. Variable
// and `times` are columns of the samples' state (state.hpp) that a controller knows, those of one slider or leg, or of
// the whole machine. A variable with a period is wrapped into [0, period) first. A variable that is not a number
// (temperature not measured, acceleration not stated, legs that do not hold the platform) pushes nothing.
//
// A function of the travel since a reversal jumps at the reversal, and no drive follows that. It is taken twice, of the
// travel in either direction, and pushes (1 + sigma) / 2 of the one upwards and (1 - sigma) / 2 of the one downwards,
// sigma the direction of travel (-1 to 1, compensation.hpp), each with its own sign of sigma where sigma multiplies it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hexdbb/leg_ports.hpp"

namespace hexdbb {

/// One port column that a table pushes.
struct TablePush {
  int element = 0;      // 0-based slider or leg whose variable is taken
  int column = 0;       // 0-based, within the port
  double weight = 1.0;  // of the value in the table
};

struct CompensationTable {
  std::string effect = {};    // to which it belongs; an effect may have several tables
  std::string port = {};      // slider, leg, slider_joint, platform_joint
  std::string variable = {};  // column of the state; empty: the value is one number
  std::string times = {};     // column that multiplies; empty: none
  double period = 0.0;        // of the variable, in its unit; 0: not periodic
  std::vector<TablePush> pushes = {};
  std::vector<double> knots = {};  // rising, in the variable's unit
  std::vector<double> values_mm = {};
};

/// Columns of the state that a controller knows at every pose. The joints' are those of the nominal machine.
enum class TableVariable : int {
  kNone = 0,  // 1 everywhere
  kSliders,
  kVelocity,
  kTravelDirection,
  kLegForce,
  kTemperature,
  kWarming,
  kSliderJointAngle,
  kSliderJointRate,
  kSliderJointDirection,
  kPlatformJointAngle,
  kPlatformJointRate,
  kSwingAngle,
  kSwingRate,
  kSinceReversal,
  kAcceleration,
  kLegInclination,
  kDriveLoad,
  kCarriageLoad,
  kCount
};

struct TableVariableInfo {
  TableVariable variable;
  const char* column;
  double usual;  // magnitude that it hardly exceeds; bounds how steeply a correction that it multiplies may change
};

constexpr std::array<TableVariableInfo, static_cast<std::size_t>(TableVariable::kCount)> kTableVariables = {
    {{TableVariable::kNone, "", 1.0},
     {TableVariable::kSliders, "sliders_mm", 1000.0},
     {TableVariable::kVelocity, "velocity_mm_s", 100.0},
     {TableVariable::kTravelDirection, "travel_direction", 1.0},
     {TableVariable::kLegForce, "leg_force", 1.0},
     {TableVariable::kTemperature, "temperature_c", 30.0},
     {TableVariable::kWarming, "warming_k", 10.0},
     {TableVariable::kSliderJointAngle, "slider_joint_angle_rad", 3.2},
     {TableVariable::kSliderJointRate, "slider_joint_rate_rad_s", 0.3},
     {TableVariable::kSliderJointDirection, "slider_joint_direction", 1.0},
     {TableVariable::kPlatformJointAngle, "platform_joint_angle_rad", 3.2},
     {TableVariable::kPlatformJointRate, "platform_joint_rate_rad_s", 0.3},
     {TableVariable::kSwingAngle, "swing_angle_rad", 3.2},
     {TableVariable::kSwingRate, "swing_rate_rad_s", 0.3},
     {TableVariable::kSinceReversal, "since_reversal_mm", 1000.0},
     {TableVariable::kAcceleration, "acceleration_mm_s2", 500.0},
     {TableVariable::kLegInclination, "leg_inclination_rad", 3.2},
     {TableVariable::kDriveLoad, "drive_load", 1.0},
     {TableVariable::kCarriageLoad, "carriage_load", 1.0}}};

/// Return the variable of a column's name, nullptr where a controller does not know it.
const TableVariableInfo* find_table_variable(const std::string& column) noexcept;

/// Return the port of that name at which compensation can push, nullptr for any other: ball, cup and reading belong to
/// the measurement.
const PortSpan* find_compensated_port(const std::string& name) noexcept;

/// Return whether a column may multiply a function: all that tables may depend on but positions, which the iteration
/// changes, and the travel since a reversal, which has two values while a slider turns over.
bool may_multiply(TableVariable variable) noexcept;

/// What tables may depend on, at one instant: six numbers each, those of the whole machine repeated.
struct TableState {
  std::array<Vector6, static_cast<std::size_t>(TableVariable::kCount)> column;
  std::array<Vector6, 2> since_reversal_mm;  // of travel down and up, in place of the column

  TableState();  // kNone: ones; all others zero
  Vector6& operator[](TableVariable variable) { return column[static_cast<std::size_t>(variable)]; }
  const Vector6& operator[](TableVariable variable) const { return column[static_cast<std::size_t>(variable)]; }
};

/// One function: knots, and the lines between them.
class TableFunction {
 public:
  explicit TableFunction(const CompensationTable& table);

  /// Return f(x) in mm, 0 where x is not a number. `interval` is where the search begins, and becomes where it ended.
  double at(double x, int& interval) const noexcept;

  /// Largest magnitude of a slope, and largest change of slope from one interval to the next; mm per unit.
  double steepest() const noexcept { return steepest_; }
  double sharpest() const noexcept { return sharpest_; }

 private:
  struct Line {
    double from, value, slope;
  };

  std::vector<Line> lines_;  // one for each interval; a single number is one line without slope
  double first_ = 0.0, last_ = 0.0;
  double period_ = 0.0, per_period_ = 0.0;
  double per_interval_ = 0.0;  // above 0: knots are equally spaced, and an interval follows from x alone
  double steepest_ = 0.0, sharpest_ = 0.0;
};

/// All tables of some compensation data, evaluated without allocation.
class TableSet {
 public:
  TableSet() = default;

  /// Tables must be valid (require_tables in compensation_file.hpp).
  explicit TableSet(const std::vector<CompensationTable>& tables);

  bool empty() const noexcept { return lookups_.empty(); }

  /// Return the sliders or legs of which a variable is needed: bit k is slider or leg k.
  unsigned legs(TableVariable variable) const noexcept { return legs_[static_cast<std::size_t>(variable)]; }

  /// Bounds, per mm of a slider's travel, of the change of all pushes on its leg, and of the change of that slope
  /// from one interval to the next.
  double steepest() const noexcept { return steepest_; }
  double sharpest() const noexcept { return sharpest_; }

  /// Whether some function depends on where the sliders are.
  bool follows_sliders() const noexcept { return of_position_ > 0; }

  /// Set the state for the following calls.
  void settle(const TableState& state) noexcept;

  /// Pushes that do not depend on where the sliders are, zero but for these quantities of LegPorts.
  const LegPorts& settled() const noexcept { return settled_; }
  const std::vector<int>& settled_quantities() const noexcept { return settled_quantities_; }

  /// Add the pushes that do, with the sliders at these coordinates.
  void add(const LegRow& sliders_mm, LegPorts& push) noexcept;

 private:
  /// A function of one element's variable, and what it pushes: [first_push, last_push) of pushes_.
  struct Lookup {
    int function, element;
    TableVariable variable, times;
    int first_push, last_push;
    int interval = 0;
    double factor = 0.0;
  };
  /// On a whole row: single numbers written before a row is read would stall the processor.
  struct Push {
    int quantity;  // of LegPorts
    LegRow weight;
  };

  static Push on_row(int place, double weight) noexcept;
  double since_reversal(const TableState& state, Lookup& lookup) const noexcept;
  void push(const Lookup& lookup, double value_mm, LegPorts& out) const noexcept;

  std::vector<TableFunction> functions_;
  std::vector<Lookup> lookups_;  // those of slider positions first
  std::size_t of_position_ = 0;  // number of lookups that depend on slider positions
  std::vector<Push> pushes_;
  std::array<unsigned, static_cast<std::size_t>(TableVariable::kCount)> legs_{};
  double steepest_ = 0.0, sharpest_ = 0.0;
  LegPorts settled_;
  std::vector<int> settled_quantities_;
};

}  // namespace hexdbb
