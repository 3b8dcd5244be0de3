#include <cmath>

#include "compensation_layout.hpp"

namespace hexdbb {

namespace {

/// Quote a string for TOML and C, control characters as spaces.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char each : text) {
    if (each == '"' || each == '\\') out += '\\';
    out += static_cast<unsigned char>(each) < 0x20 || each == 0x7f ? ' ' : each;
  }
  return out + "\"";
}

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

std::string without_check(const CompensationData& data) {
  std::string out = line("schema", quoted(layout::kSchema + std::to_string(layout::kVersion)));
  out +=
      "# Compensation for a motion controller, written by hexdbb compensate. Do not edit: the last line sums it up.\n";
  out += line("machine", quoted(data.name));
  out += line("model_sha256", quoted(data.model_sha256));
  if (std::isfinite(data.reference_temperature_c)) {
    out += line("reference_temperature_c", layout::number(data.reference_temperature_c));
  }
  out += "\n[dimensions]\n";
  for (const layout::Dimension& each : layout::kDimensions) {
    out += line(each.name, layout::number(data.machine.*each.member));
  }
  out += "\n[limits]\n";
  for (const layout::Limit& each : layout::kLimits) out += line(each.name, layout::number(data.limits.*each.member));
  for (const CompensatedEffect& effect : data.effects) {
    out += "\n[effect." + effect.name + "]\n" + unit_comment(data.machine, effect.name);
    for (const CompensationValue& value : effect.values) {
      out += line(value.element + "." + value.parameter, layout::number(value.value));
    }
  }
  out += "\n[left_out]\n";
  for (const LeftOut& each : data.left_out) out += line(each.effect, quoted(each.reason));
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

std::string compensation_header(const CompensationData& data) {
  compensation_model(data, "compensation data");
  std::string out =
      "/* Compensation of " + quoted(data.name) + ", written by hexdbb compensate: mm, rad, s, N, K.\n" + " * Model " +
      data.model_sha256 + ". Use: hexdbb_create_from_constants(&hexdbb_compensation, ...). */\n" +
      "#ifndef HEXDBB_COMPENSATION_CONSTANTS_H\n#define HEXDBB_COMPENSATION_CONSTANTS_H\n\n" +
      "#include <hexdbb/hexdbb.h>\n#include <math.h>\n\nstatic const hexdbb_value hexdbb_compensation_values[] = {\n";
  std::size_t count = 0;
  for (const CompensatedEffect& effect : data.effects) {
    for (const CompensationValue& value : effect.values) {
      out += "    {" + quoted(effect.name) + ", " + quoted(value.element) + ", " + quoted(value.parameter) + ", " +
             layout::number(value.value) + "},\n";
      ++count;
    }
  }
  if (count == 0) out += "    {0, 0, 0, 0.0} /* none: the nominal machine */\n";
  out += "};\n\nstatic const hexdbb_constants hexdbb_compensation = {\n    sizeof(hexdbb_constants),\n    " +
         std::to_string(count) + ", /* values */\n    {sizeof(hexdbb_dimensions), 0,\n";
  for (const layout::Dimension& each : layout::kDimensions) {
    const bool is_last = &each == &layout::kDimensions.back();
    out += "     " + layout::number(data.machine.*each.member) + (is_last ? "}," : ",") + " /* " + each.name + " */\n";
  }
  for (const layout::Limit& each : layout::kLimits) {
    out += "    " + layout::number(data.limits.*each.member) + ", /* " + each.name + " */\n";
  }
  out += "    " + (std::isfinite(data.reference_temperature_c) ? layout::number(data.reference_temperature_c) : "NAN") +
         ", /* reference_temperature_c */\n    hexdbb_compensation_values,\n};\n\n#endif\n";
  return out;
}

}  // namespace hexdbb
