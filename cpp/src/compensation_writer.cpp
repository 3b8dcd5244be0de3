#include <algorithm>
#include <cctype>
#include <cmath>

#include "compensation_layout.hpp"

namespace hexdbb {

namespace {

std::string line(const std::string& key, const std::string& value) { return key + " = " + value + "\n"; }

/// Return a comment as "# longer: mm"; numbers are in these units by definition.
std::string unit_comment(const Machine& machine, const std::string& effect) {
  std::string out;
  const EffectPtr found = find_effect(machine, 1, effect);
  for (const ParameterInfo& parameter : found->info().parameters) {
    out += (out.empty() ? "# " : ", ") + parameter.name + ": " + parameter.unit;
  }
  return out + "\n";
}

/// Return a key as it is where TOML allows it bare, otherwise in quotes.
std::string key(const std::string& name) {
  const bool is_bare = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char each) {
    return std::isalnum(each) != 0 || each == '_' || each == '-';
  });
  return is_bare ? name : layout::quoted(name);
}

std::string table_lines(const CompensationTable& table) {
  std::string out = line("effect", layout::quoted(table.effect)) + line("port", layout::quoted(table.port)) +
                    line("variable", layout::quoted(table.variable)) + line("times", layout::quoted(table.times)) +
                    line("period", layout::number(table.period));
  layout::for_each_list(table, "[", "]", [&](const char* name, const std::string& text) { out += line(name, text); });
  return out;
}

std::string without_check(const CompensationData& data) {
  std::string out = line("schema", layout::quoted(layout::kSchema + std::to_string(layout::version_of(data))));
  out +=
      "# Compensation for a motion controller, written by hexdbb compensate. Do not edit: the last line sums it up.\n";
  out += line("machine", layout::quoted(data.name));
  out += line("model_sha256", layout::quoted(data.model_sha256));
  for (const std::string& each : data.record_sha256) out += layout::kRecordComment + layout::quoted(each) + "\n";
  if (std::isfinite(data.reference_temperature_c)) {
    out += line("reference_temperature_c", layout::number(data.reference_temperature_c));
  }
  out += "\n[dimensions]\n";
  for (const layout::Dimension& each : layout::kDimensions) {
    if (each.is_angle && layout::is_regular(each, data.machine)) continue;
    out += line(each.name, layout::dimension_text(each, data.machine, "[", "]"));
  }
  out += "\n[limits]\n";
  for (const layout::Limit& each : layout::kLimits) out += line(each.name, layout::number(data.limits.*each.member));
  for (const CompensatedEffect& effect : data.effects) {
    out += "\n[effect." + effect.name + "]\n" + unit_comment(data.machine, effect.name);
    for (const CompensationValue& value : effect.values) {
      out += line(value.element + "." + value.parameter, layout::number(value.value));
    }
  }
  for (std::size_t at = 0; at < data.tables.size(); ++at) {
    out += "\n[" + layout::table_section(at) + "]\n" + table_lines(data.tables[at]);
  }
  out += "\n[left_out]\n";
  for (const LeftOut& each : data.left_out) out += line(key(each.effect), layout::quoted(each.reason));
  return out + "\n";
}

}  // namespace

std::uint32_t crc32(const std::string& bytes) noexcept {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

std::string compensation_text(const CompensationData& data) {
  compensation_model(data, "compensation data");  // throws where the file could not be read again
  const std::string above = without_check(data);
  return above + layout::check_section(above);
}

}  // namespace hexdbb
