// From a model to the part of it that can be compensated, and back to a model.
#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation_layout.hpp"

namespace hexdbb {

namespace {

using Reason = std::string;  // empty: none

constexpr const char* kNoReference = "needs the temperature of the record's first sample, which was not stated";

/// Return whether a controller knows a column of the state at the present moment.
bool is_known_to_controllers(const std::string& column) {
  static const std::vector<std::string> known = {"travel_direction", "since_reversal_mm", "velocity_mm_s", "leg_force",
                                                 "temperature_c",    "warming_k",         "time_s"};
  return std::find(known.begin(), known.end(), column) != known.end();
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Return why a function of a column of the state cannot be compensated.
Reason why_not(const std::string& column, double reference_temperature_c) {
  if (column == "time_s" || column.starts_with("elapsed")) return "depends on time";
  if (find_table_variable(column) == nullptr) return "depends on " + column + ", which is not known to a controller";
  if (column == "warming_k" && std::isnan(reference_temperature_c)) return kNoReference;
  return {};
}

/// Return why a table cannot be compensated.
Reason why_not(const CompensationTable& table, double reference_temperature_c) {
  if (find_compensated_port(table.port) == nullptr) return "pushes the " + table.port + ", not the machine";
  Reason reason = why_not(table.variable, reference_temperature_c);
  if (reason.empty()) reason = why_not(table.times, reference_temperature_c);
  if (!reason.empty() || may_multiply(find_table_variable(table.times)->variable)) return reason;
  return "depends on " + table.times + " as a factor, which is not known to a controller";
}

/// Sort tables into those that are compensated, effect by effect, and effects that are left out.
void take_tables(const std::vector<CompensationTable>& tables, CompensationData& out) {
  for (const CompensationTable& table : tables) {
    const Reason reason = why_not(table, out.reference_temperature_c);
    const auto is_same = [&](const LeftOut& each) { return each.effect == table.effect; };
    const bool is_left_out = std::any_of(out.left_out.begin(), out.left_out.end(), is_same);
    if (!reason.empty() && !is_left_out) out.left_out.push_back({table.effect, reason});
    if (reason.empty() && !is_left_out) out.tables.push_back(table);
  }
  const auto is_gone = [&](const CompensationTable& table) {
    return std::any_of(out.left_out.begin(), out.left_out.end(),
                       [&](const LeftOut& each) { return each.effect == table.effect; });
  };
  out.tables.erase(std::remove_if(out.tables.begin(), out.tables.end(), is_gone), out.tables.end());
}

/// Return why an effect cannot be compensated.
Reason why_not(const EffectInfo& info, double reference_temperature_c) {
  if (info.is_set_up) return "belongs to the measurement, not to the machine";
  if (!is_known_effect(info.name)) return "is defined outside the engine";
  for (const char* port : {"ball", "cup", "reading"}) {
    if (has(info.ports, port)) return std::string("pushes the ") + port + ", not the machine";
  }
  for (const std::string& column : info.needs) {
    if (!is_known_to_controllers(column)) return "depends on " + column + ", which is not known to a controller";
  }
  const bool has_temperature = has(info.needs, "warming_k") || has(info.needs, "temperature_c");
  if (has(info.needs, "time_s") && !has_temperature) return "depends on time";
  if (has(info.needs, "warming_k") && std::isnan(reference_temperature_c)) {
    return kNoReference;
  }
  return {};
}

CompensatedEffect named_values(const Term& term) {
  CompensatedEffect out;
  const EffectInfo& info = term.effect->info();
  out.name = info.name;
  Eigen::Index at = 0;
  for (const std::string& element : info.elements) {
    for (const ParameterInfo& parameter : info.parameters) {
      out.values.push_back({element, parameter.name, term.values[at++]});
    }
  }
  return out;
}

[[noreturn]] void refuse(CompensationFault fault, const std::string& message) {
  throw CompensationError(fault, message);
}

/// Return values in the effect's own order; every one must be named once.
Eigen::VectorXd ordered_values(const EffectInfo& info, const CompensatedEffect& given, const std::string& where) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(info.size(), std::numeric_limits<double>::quiet_NaN());
  for (const CompensationValue& value : given.values) {
    const auto element = std::find(info.elements.begin(), info.elements.end(), value.element);
    const auto parameter = std::find_if(info.parameters.begin(), info.parameters.end(),
                                        [&](const ParameterInfo& each) { return each.name == value.parameter; });
    const std::string name = value.element + "." + value.parameter;
    if (element == info.elements.end() || parameter == info.parameters.end()) {
      refuse(CompensationFault::kUnknownEffect, where + " has no value " + name);
    }
    const auto place = (element - info.elements.begin()) * static_cast<std::ptrdiff_t>(info.parameters.size()) +
                       (parameter - info.parameters.begin());
    if (!std::isnan(out[place]))
      refuse(CompensationFault::kMalformed, where + "." + name + ": given twice (expected once)");
    if (!std::isfinite(value.value)) {
      refuse(CompensationFault::kMalformed, where + "." + name + ": expected a finite number");
    }
    out[place] = value.value;
  }
  if (out.hasNaN())
    refuse(CompensationFault::kMalformed, where + ": expected " + std::to_string(info.size()) + " values");
  return out;
}

/// A dimension in which two machines differ.
struct Difference {
  const layout::Dimension* dimension = nullptr;  // none: the machines are the same
  std::size_t at = 0;                            // the guideway, leg or slider
};

Difference differing(const Machine& one, const Machine& other) {
  for (const layout::Dimension& dimension : layout::kDimensions) {
    const std::span<const double> a = dimension.values(one), b = dimension.values(other);
    for (std::size_t at = 0; at < a.size(); ++at) {
      if (!layout::is_same(a[at], b[at])) return {&dimension, at};
    }
  }
  return {};
}

}  // namespace

bool is_possible(const Machine& machine) noexcept {
  for (const layout::Dimension& each : layout::kDimensions) {
    for (const double value : each.values(machine)) {
      if (!std::isfinite(value)) return false;
    }
  }
  for (int k = 0; k < kLegs; ++k) {
    const int i = guideway_of(k);
    const double aside = std::cos(machine.joint_angle_rad[i] - machine.guideway_angle_rad[i]);
    const double reach = std::abs(machine.base_inradius_mm - machine.platform_circumradius_mm * aside);
    if (!(machine.leg_length_mm[k] > reach) || !(slider_travel(machine, k).half_mm > 0.0)) return false;
    if (!(2.0 * guideway_travel(machine, i).half_mm > machine.min_gap_mm)) return false;
  }
  return machine.base_inradius_mm > 0.0 && machine.platform_circumradius_mm > 0.0 && machine.min_gap_mm > 0.0 &&
         machine.screw_lead_mm > 0.0 && machine.moved_mass_kg >= 0.0;
}

CompensationData compensation_of(const Model& model, const std::string& name, const std::string& model_sha256,
                                 const CompensationLimits& limits, double reference_temperature_c,
                                 const std::vector<CompensationTable>& tables) {
  CompensationData out;
  out.name = name;
  out.model_sha256 = model_sha256;
  out.reference_temperature_c = reference_temperature_c;
  out.machine = model.nominal.machine;
  out.limits = limits;
  for (const Term& term : model.terms) {
    const EffectInfo& info = term.effect->info();
    const Reason reason = why_not(info, reference_temperature_c);
    if (!reason.empty()) {
      out.left_out.push_back({info.name, reason});
      continue;
    }
    out.effects.push_back(named_values(term));
    if (has(info.needs, "time_s")) out.left_out.push_back({info.name, "the part of it that depends on time alone"});
  }
  take_tables(tables, out);
  return out;
}

bool is_same_machine(const Machine& one, const Machine& other) noexcept {
  return differing(one, other).dimension == nullptr;
}

void require_machine(const Machine& of_data, const Machine& of_controller, const std::string& source) {
  const auto [dimension, at] = differing(of_data, of_controller);
  if (dimension == nullptr) return;
  const bool is_list =
      dimension->is_angle || !layout::is_regular(*dimension, of_data) || !layout::is_regular(*dimension, of_controller);
  // Appended piece by piece: for a sum of strings GCC 12 warns of an overlap that cannot be.
  std::string index;
  if (is_list) index.append("[").append(std::to_string(at)).append("]");
  refuse(CompensationFault::kOtherMachine, source + ": of another machine: " + dimension->name + index + " is " +
                                               layout::number(dimension->values(of_data)[at]) + " (expected " +
                                               layout::number(dimension->values(of_controller)[at]) + ")");
}

Model compensation_model(const CompensationData& data, const std::string& source) {
  if (!is_possible(data.machine))
    refuse(CompensationFault::kMalformed, source + ": dimensions: no such machine can be assembled");
  for (const layout::Limit& each : layout::kLimits) {
    if (!(data.limits.*each.member > 0.0) || !std::isfinite(data.limits.*each.member)) {
      refuse(CompensationFault::kMalformed, source + ": limits." + each.name + ": expected a number above 0");
    }
  }
  Model out(data.machine);
  for (const CompensatedEffect& given : data.effects) {
    const std::string where = source + ": effect." + given.name;
    if (!is_known_effect(given.name)) {
      refuse(CompensationFault::kUnknownEffect, where + ": no such effect in this version");
    }
    out.add(find_effect(data.machine, 1, given.name));
    const EffectInfo& info = out.terms.back().effect->info();
    if (info.is_set_up) refuse(CompensationFault::kUnknownEffect, where + ": belongs to the measurement");
    out.terms.back().values = ordered_values(info, given, where);
  }
  require_tables(data.tables, source);
  return out;
}

}  // namespace hexdbb
