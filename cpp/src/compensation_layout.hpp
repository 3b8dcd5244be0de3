// Layout of a compensation file, shared by writer and reader.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <type_traits>

#include "hexdbb/compensation_file.hpp"

namespace hexdbb::layout {

inline const std::string kSchema = "hexdbb.compensation/";
constexpr int kVersion = 3;

/// Return the section of a table, counted from 0 here and from 1 in the file.
inline std::string table_section(std::size_t table) { return "table." + std::to_string(table + 1); }

/// A dimension: one value, or one for each guideway, leg or slider.
struct Dimension {
  const char* name;
  std::span<double> (*of)(Machine&);
  bool is_angle = false;  // in the machine of the thesis thirds of a turn, otherwise alike for all

  std::span<const double> values(const Machine& machine) const { return of(const_cast<Machine&>(machine)); }
};

template <auto Member>
constexpr std::span<double> values_of(Machine& machine) {
  auto& value = machine.*Member;
  if constexpr (std::is_same_v<decltype(value), double&>) {
    return {&value, 1};
  } else {
    return value;
  }
}

constexpr std::array<Dimension, 11> kDimensions = {
    {{"base_inradius_mm", values_of<&Machine::base_inradius_mm>},
     {"platform_circumradius_mm", values_of<&Machine::platform_circumradius_mm>},
     {"joint_plane_height_mm", values_of<&Machine::joint_plane_height_mm>},
     {"leg_length_mm", values_of<&Machine::leg_length_mm>},
     {"travel_min_mm", values_of<&Machine::travel_min_mm>},
     {"travel_max_mm", values_of<&Machine::travel_max_mm>},
     {"min_gap_mm", values_of<&Machine::min_gap_mm>},
     {"screw_lead_mm", values_of<&Machine::screw_lead_mm>},
     {"moved_mass_kg", values_of<&Machine::moved_mass_kg>},
     {"guideway_angle_rad", values_of<&Machine::guideway_angle_rad>, true},
     {"joint_angle_rad", values_of<&Machine::joint_angle_rad>, true}}};

/// Return whether two values of a dimension count as one: files hold decimal numbers.
inline bool is_same(double one, double other) {
  return std::abs(one - other) <= 1e-9 * std::max(std::abs(one), std::abs(other));
}

/// Return whether a dimension is as in the machine of the thesis: angles are thirds of a turn, all others alike.
inline bool is_regular(const Dimension& dimension, const Machine& machine) {
  const std::span<const double> values = dimension.values(machine);
  for (std::size_t at = 0; at < values.size(); ++at) {
    if (!is_same(values[at], dimension.is_angle ? kThirds_rad[at] : values[0])) return false;
  }
  return true;
}

/// Return whether a machine needs a list for some dimension.
inline bool is_regular(const Machine& machine) {
  return std::all_of(kDimensions.begin(), kDimensions.end(),
                     [&](const Dimension& each) { return is_regular(each, machine); });
}

/// Return the version that these data are written as: 3 has lists of dimensions, 2 has tables.
inline int version_of(const CompensationData& data) {
  if (!is_regular(data.machine)) return 3;
  return data.tables.empty() ? 1 : 2;
}

struct Limit {
  const char* name;
  double CompensationLimits::* member;
};

constexpr std::array<Limit, 2> kLimits = {{{"max_correction_mm", &CompensationLimits::max_correction_mm},
                                           {"reversal_travel_mm", &CompensationLimits::reversal_travel_mm}}};

/// Return the shortest decimal number that reads as the same bits, whatever the locale.
inline std::string number(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::string(text.data(), end);
}

/// Begins the comment that holds a record's hash, before the hash in quotes.
inline const std::string kRecordComment = "# record_sha256 = ";

/// Return text as one line that a terminal or an editor shows as it is: control characters, C1 controls, line and
/// paragraph separators and marks that reverse the direction of text (U+0000-1F, 7F-9F, 200E-0F, 2028-2E, 2066-69)
/// become spaces.
inline std::string printable(const std::string& text) {
  std::string out;
  const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u; };
  for (std::size_t at = 0; at < text.size(); ++at) {
    const unsigned first = byte(at), second = byte(at + 1), third = byte(at + 2);
    const bool is_c1 = first == 0xc2 && second >= 0x80 && second <= 0x9f;
    const bool is_mark =
        first == 0xe2 && ((second == 0x80 && (third == 0x8e || third == 0x8f || (third >= 0xa8 && third <= 0xae))) ||
                          (second == 0x81 && third >= 0xa6 && third <= 0xa9));
    out += first < 0x20 || first == 0x7f || is_c1 || is_mark ? ' ' : text[at];
    at += is_mark ? 2 : (is_c1 ? 1 : 0);
  }
  return out;
}

/// Quote a string for TOML, what is not printable as spaces.
inline std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char each : printable(text)) {
    if (each == '"' || each == '\\') out += '\\';
    out += each;
  }
  return out + "\"";
}

/// Quote a string for C: as for TOML, without trigraphs (ISO C99 5.2.1.1).
inline std::string c_string(const std::string& text) {
  std::string out;
  for (const char each : quoted(text)) {
    if (each == '?' && !out.empty() && out.back() == '?') out += '\\';
    out += each;
  }
  return out;
}

/// Return text for a C comment: one line that neither ends it nor begins another, nor continues the line.
inline std::string c_comment(const std::string& text) {
  std::string out;
  for (const char each : printable(text)) {
    const bool is_mark = !out.empty() && ((out.back() == '*' && each == '/') || (out.back() == '/' && each == '*') ||
                                          (out.back() == '?' && each == '?'));
    out += is_mark ? std::string(" ") + each : std::string(1, each);
  }
  if (!out.empty() && out.back() == '\\') out += ' ';
  return out;
}

/// Join what `text` makes of each of `count` numbers as "[1, 2]", the brackets given.
template <class Text>
std::string list(std::size_t count, Text text, const char* open, const char* close) {
  std::string out = open;
  for (std::size_t at = 0; at < count; ++at) out += (at == 0 ? "" : ", ") + text(at);
  return out + close;
}

/// Return the values of a dimension as one number where it is regular, otherwise as a list; angles are always a list.
inline std::string dimension_text(const Dimension& dimension, const Machine& machine, const char* open,
                                  const char* close) {
  const std::span<const double> values = dimension.values(machine);
  if (!dimension.is_angle && is_regular(dimension, machine)) return number(values[0]);
  return list(values.size(), [&](std::size_t at) { return number(values[at]); }, open, close);
}

/// Call write(key, list as text) for each list of numbers of a table; elements and columns count from 1 in files.
template <class Write>
void for_each_list(const CompensationTable& table, const char* open, const char* close, Write write) {
  const std::vector<TablePush>& pushes = table.pushes;
  const auto text = [&](std::size_t count, auto each) { return list(count, each, open, close); };
  write("elements", text(pushes.size(), [&](std::size_t at) { return std::to_string(pushes[at].element + 1); }));
  write("columns", text(pushes.size(), [&](std::size_t at) { return std::to_string(pushes[at].column + 1); }));
  write("weights", text(pushes.size(), [&](std::size_t at) { return number(pushes[at].weight); }));
  write("knots", text(table.knots.size(), [&](std::size_t at) { return number(table.knots[at]); }));
  write("values_mm", text(table.values_mm.size(), [&](std::size_t at) { return number(table.values_mm[at]); }));
}

/// Return the last section: the checksum of everything above it.
inline std::string check_section(const std::string& above) {
  std::array<char, 9> hex;
  std::snprintf(hex.data(), hex.size(), "%08x", static_cast<unsigned>(crc32(above)));
  return std::string("[check]\ncrc32 = \"") + hex.data() + "\"\n";
}

}  // namespace hexdbb::layout
