// Texts of compensation files, good and altered.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <utility>

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

/// Return the text with one to four changes in a part of it: bytes replaced by some of an alphabet, dropped, doubled or
/// exchanged.
inline std::string noisy(std::string text, std::size_t begin, std::size_t length, const std::string& alphabet,
                         std::mt19937_64& random) {
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  const std::string part = text.substr(begin, length);
  for (std::size_t change = 0; change <= below(4); ++change) {
    const std::size_t left = std::min(length, text.size() - begin);  // erasing has made the text shorter
    const std::size_t at = begin + below(left), span = 1 + below(8);
    switch (below(4)) {
      case 0:
        text[at] = alphabet[below(alphabet.size())];
        break;
      case 1:
        text.erase(at, span);
        break;
      case 2:
        text.insert(at, part.substr(below(length), span));
        break;
      default:
        std::swap(text[at], text[begin + below(left)]);
    }
  }
  return text;
}

/// Expect that a text is accepted and written alike, or refused with one line; return whether it is accepted.
inline bool read_or_refused(const std::string& text) {
  std::string message;
  if (fault_of(text, &message) != CompensationFault::kNone) {
    EXPECT_EQ(message.compare(0, 11, "a.hexcomp: "), 0) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return false;
  }
  const CompensationData data = parse_compensation(text, "a.hexcomp");
  EXPECT_EQ(compensation_text(parse_compensation(compensation_text(data), "again")), compensation_text(data));
  Compensator compensator(data);
  const SliderTargets targets = compensator.sliders(make_pose(10, 20, 285, 0, 0, 0));
  EXPECT_TRUE(targets.sliders_mm.allFinite());
  return true;
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
