// Texts of compensation files, good and altered.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "compensating.hpp"

namespace hexdbb::testing {

inline CompensationData everything() {
  std::vector<std::string> names = kGeometricNames;
  names.insert(names.end(), kCorrectable.begin(), kCorrectable.end());
  names.push_back("leg_thermal");
  names.push_back("cup_position");
  CompensationData data = data_of(wrong_machine(names, 21));
  data.name = "SP-120 \"left\" \\ hall 2\n";
  return data;
}

/// The same with tables of every variable.
inline CompensationData with_tables() {
  CompensationData out = everything();
  out.tables = all_tables();
  out.left_out.push_back({"learned:leg:1 = \"odd\"", "depends on time"});
  return out;
}

/// Return the text with a correct checksum, as another program would write it.
inline std::string resealed(const std::string& text) {
  const std::string above = text.substr(0, text.rfind("[check]\n"));
  char hex[9];
  std::snprintf(hex, sizeof hex, "%08x", static_cast<unsigned>(crc32(above)));
  return above + "[check]\ncrc32 = \"" + hex + "\"\n";
}

inline std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), with);
}

inline CompensationFault fault_of(const std::string& text, std::string* message = nullptr) {
  try {
    parse_compensation(text, "a.hexcomp");
    return CompensationFault::kNone;
  } catch (const CompensationError& error) {
    if (message != nullptr) *message = error.what();
    return error.fault();
  }
}

/// An altered text and how it is refused.
struct Wrong {
  const char* what;
  const char* old;
  const char* with;
  CompensationFault fault;
  const char* message;
};

}  // namespace hexdbb::testing
