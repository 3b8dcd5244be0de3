// Layout of a compensation file, shared by writer and reader.
#pragma once

#include <array>
#include <charconv>
#include <cstdio>
#include <string>

#include "hexdbb/compensation_file.hpp"

namespace hexdbb::layout {

inline const std::string kSchema = "hexdbb.compensation/";
constexpr int kVersion = 1;

struct Dimension {
  const char* name;
  double Machine::* member;
};

constexpr std::array<Dimension, 9> kDimensions = {{{"base_inradius_mm", &Machine::base_inradius_mm},
                                                   {"platform_circumradius_mm", &Machine::platform_circumradius_mm},
                                                   {"joint_plane_height_mm", &Machine::joint_plane_height_mm},
                                                   {"leg_length_mm", &Machine::leg_length_mm},
                                                   {"travel_min_mm", &Machine::travel_min_mm},
                                                   {"travel_max_mm", &Machine::travel_max_mm},
                                                   {"min_gap_mm", &Machine::min_gap_mm},
                                                   {"screw_lead_mm", &Machine::screw_lead_mm},
                                                   {"moved_mass_kg", &Machine::moved_mass_kg}}};

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

/// Return the last section: the checksum of everything above it.
inline std::string check_section(const std::string& above) {
  std::array<char, 9> hex;
  std::snprintf(hex.data(), hex.size(), "%08x", static_cast<unsigned>(crc32(above)));
  return std::string("[check]\ncrc32 = \"") + hex.data() + "\"\n";
}

}  // namespace hexdbb::layout
