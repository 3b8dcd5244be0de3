// Compensation data as constants of a C program (hexdbb.h).
#include <cmath>

#include "compensation_layout.hpp"

namespace hexdbb {

namespace {

constexpr const char* kValues = "hexdbb_compensation_values";
constexpr const char* kLayout = "hexdbb_compensation_layout";
constexpr const char* kTables = "hexdbb_compensation_tables";

/// Return "fitted to the records a, b", nothing where there are none.
std::string records_words(const CompensationData& data) {
  std::string out;
  for (const std::string& each : data.record_sha256) {
    out += (out.empty() ? ",\n * fitted to the records\n *   " : ",\n *   ") + layout::c_comment(each);
  }
  return out;
}

std::string member(const std::string& text, const std::string& name) {
  return "    " + text + ", /* " + name + " */\n";
}

/// Return the array of values, or a place holder: C has no empty arrays.
std::string values_array(const CompensationData& data, std::size_t& count) {
  std::string out = std::string("static const hexdbb_value ") + kValues + "[] = {\n";
  count = 0;
  for (const CompensatedEffect& effect : data.effects) {
    for (const CompensationValue& value : effect.values) {
      out += "    {" + layout::c_string(effect.name) + ", " + layout::c_string(value.element) + ", " +
             layout::c_string(value.parameter) + ", " + layout::number(value.value) + "},\n";
      ++count;
    }
  }
  if (count == 0) out += "    {0, 0, 0, 0.0} /* none: the nominal machine */\n";
  return out + "};\n\n";
}

std::string list_name(std::size_t table, const std::string& list) {
  return std::string(kTables) + "_" + std::to_string(table + 1) + "_" + list;
}

/// Return the arrays of one table, and in `row` its row in the array of all.
std::string table_arrays(const CompensationTable& table, std::size_t at, std::string& row) {
  std::string out;
  row = "    {" + layout::c_string(table.effect) + ", " + layout::c_string(table.port) + ", " +
        layout::c_string(table.variable) + ", " + layout::c_string(table.times) + ", " + layout::number(table.period) +
        ", " + std::to_string(table.pushes.size()) + ", " + std::to_string(table.knots.size());
  layout::for_each_list(table, "{", "}", [&](const std::string& name, const std::string& text) {
    const bool is_integer = name == "elements" || name == "columns";
    out += std::string("static const ") + (is_integer ? "int32_t " : "double ") + list_name(at, name) + "[] = " + text +
           ";\n";
    row += ",\n     " + list_name(at, name);
  });
  row += "},\n";
  return out;
}

std::string tables_array(const CompensationData& data) {
  if (data.tables.empty()) return {};
  std::string arrays, rows, row;
  for (std::size_t at = 0; at < data.tables.size(); ++at) {
    arrays += table_arrays(data.tables[at], at, row);
    rows += row;
  }
  return arrays + "static const hexdbb_table " + kTables + "[] = {\n" + rows + "};\n\n";
}

/// Return the rows of hexdbb_dimensions: of what is different for each leg or slider, the first.
std::string dimensions_rows(const Machine& machine) {
  std::string out;
  for (const layout::Dimension& each : layout::kDimensions) {
    if (each.is_angle) continue;
    const bool is_last = &each + 1 == layout::kDimensions.end() || (&each + 1)->is_angle;
    out += "     " + layout::number(each.values(machine)[0]) + (is_last ? "}," : ",") + " /* " + each.name + " */\n";
  }
  return out;
}

/// Return the constant with what a machine has for each guideway, leg and slider; nothing where all is alike.
std::string layout_struct(const Machine& machine) {
  if (layout::is_regular(machine)) return {};
  const auto row = [](const char* name, const auto& values, const char* end) {
    const auto text = [&](std::size_t at) { return layout::number(values[at]); };
    return "    " + layout::list(values.size(), text, "{", "}") + end + " /* " + name + " */\n";
  };
  return std::string("static const hexdbb_layout ") + kLayout + " = {\n    sizeof(hexdbb_layout), 0,\n" +
         row("guideway_angle_rad", machine.guideway_angle_rad, ",") +
         row("joint_angle_rad", machine.joint_angle_rad, ",") + row("leg_length_mm", machine.leg_length_mm, ",") +
         row("travel_min_mm", machine.travel_min_mm, ",") + row("travel_max_mm", machine.travel_max_mm, "") + "};\n\n";
}

}  // namespace

std::string compensation_header(const CompensationData& data) {
  compensation_model(data, "compensation data");  // throws where the program could not use them
  std::size_t count = 0;
  std::string out = "/* Compensation of \"" + layout::c_comment(data.name) +
                    "\", written by hexdbb compensate: mm, rad, s, N, K.\n" + " * Model " +
                    layout::c_comment(data.model_sha256) + records_words(data) +
                    ".\n * Use: hexdbb_create_from_constants(&hexdbb_compensation, ...). */\n" +
                    "#ifndef HEXDBB_COMPENSATION_CONSTANTS_H\n#define HEXDBB_COMPENSATION_CONSTANTS_H\n\n" +
                    "#include <hexdbb/hexdbb.h>\n#include <math.h>\n\n";
  out += values_array(data, count) + tables_array(data) + layout_struct(data.machine);
  out += "static const hexdbb_constants hexdbb_compensation = {\n    sizeof(hexdbb_constants),\n" +
         member(std::to_string(count), "values") + "    {sizeof(hexdbb_dimensions), 0,\n";
  out += dimensions_rows(data.machine);
  for (const layout::Limit& each : layout::kLimits) out += member(layout::number(data.limits.*each.member), each.name);
  const bool has_reference = std::isfinite(data.reference_temperature_c);
  out += member(has_reference ? layout::number(data.reference_temperature_c) : "NAN", "reference_temperature_c");
  out += std::string("    ") + kValues + ",\n";
  out += data.tables.empty() ? std::string("    0, 0, 0, /* no tables */\n")
                             : "    " + std::to_string(data.tables.size()) + ", 0, " + kTables + ",\n";
  out += layout::is_regular(data.machine) ? "    0, /* no layout */\n" : std::string("    &") + kLayout + ",\n";
  return out + "};\n\n#endif\n";
}

}  // namespace hexdbb
