// Reader of the files written by compensation_writer.cpp: every key must be known, none given twice, none missing.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "compensation_layout.hpp"

namespace hexdbb {

namespace {

struct Entry {
  std::string section, key, value;  // a string keeps its quotes
  int line;
};

class Reader {
 public:
  Reader(const std::string& text, const std::string& source) : source_(source) {
    check_version(text);
    check_sum(text);
    split(text);
  }

  CompensationData data() {
    CompensationData out;
    take("", "schema");
    out.name = string(take("", "machine"));
    out.model_sha256 = string(take("", "model_sha256"));
    if (has("", "reference_temperature_c")) out.reference_temperature_c = number(take("", "reference_temperature_c"));
    for (const layout::Dimension& each : layout::kDimensions) {
      out.machine.*each.member = number(take("dimensions", each.name));
    }
    for (const layout::Limit& each : layout::kLimits) out.limits.*each.member = positive(take("limits", each.name));
    take("check", "crc32");
    for (const Entry& entry : entries_) take_effect(entry, out);
    return out;
  }

 private:
  [[noreturn]] void refuse(CompensationFault fault, const std::string& message) const {
    throw CompensationError(fault, source_ + ": " + message);
  }
  [[noreturn]] void malformed(const Entry& entry, const std::string& expected) const {
    refuse(CompensationFault::kMalformed, "line " + std::to_string(entry.line) + ": " + entry.key + " = " +
                                              entry.value + " (expected " + expected + ")");
  }

  void check_version(const std::string& text) const {
    const std::string start = "schema = \"" + layout::kSchema;
    if (text.size() < start.size() && start.compare(0, text.size(), text) == 0) {
      refuse(CompensationFault::kTruncated, "truncated: it ends in its first line");
    }
    if (text.compare(0, start.size(), start) != 0) {
      refuse(CompensationFault::kMalformed, "not a compensation file (expected " + start + "1\" first)");
    }
    int version = 0;
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + start.size(), end, version);
    if (parsed.ptr == end) refuse(CompensationFault::kTruncated, "truncated: it ends in its first line");
    if (parsed.ec != std::errc() || *parsed.ptr != '"' || version < 1) {
      refuse(CompensationFault::kMalformed, "schema: no version (expected " + start + "1\")");
    }
    if (version > layout::kVersion) {
      refuse(CompensationFault::kLaterVersion, "of a later version: " + layout::kSchema + std::to_string(version) +
                                                   " (expected at most " + std::to_string(layout::kVersion) + ")");
    }
  }

  void check_sum(const std::string& text) const {
    const std::size_t at = text.rfind("[check]\n");
    const std::size_t length = layout::check_section("").size();
    if (at == std::string::npos || text.size() - at < length) {
      refuse(CompensationFault::kTruncated, "truncated: it ends before its checksum");
    }
    const std::string expected = layout::check_section(text.substr(0, at));
    if (text.compare(at, std::string::npos, expected) != 0) {
      refuse(CompensationFault::kAltered, "altered: its checksum does not match its content");
    }
  }

  void split(const std::string& text) {
    std::istringstream lines(text);
    std::string line, section;
    for (int number = 1; std::getline(lines, line); ++number) {
      if (line.empty() || line[0] == '#') continue;
      const std::size_t equals = line.find(" = ");
      if (line.front() == '[' && line.back() == ']') {
        section = line.substr(1, line.size() - 2);
      } else if (equals == std::string::npos) {
        malformed({section, line, "", number}, "key = value");
      } else {
        add({section, line.substr(0, equals), line.substr(equals + 3), number});
      }
    }
  }

  void add(Entry entry) {
    if (has(entry.section, entry.key) && entry.section != "left_out") malformed(entry, "every key once");
    entries_.push_back(std::move(entry));
  }

  bool has(const std::string& section, const std::string& key) const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& each) { return each.section == section && each.key == key; });
  }

  Entry take(const std::string& section, const std::string& key) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& each) { return each.section == section && each.key == key; });
    if (found == entries_.end()) {
      const std::string where = section.empty() ? key : section + "." + key;
      refuse(CompensationFault::kMalformed, where + ": missing");
    }
    Entry out = *found;
    entries_.erase(found);
    return out;
  }

  void take_effect(const Entry& entry, CompensationData& out) const {
    constexpr const char* kPrefix = "effect.";
    if (entry.section == "left_out") {
      out.left_out.push_back({entry.key, string(entry)});
      return;
    }
    const std::size_t dot = entry.key.find('.');
    if (entry.section.compare(0, 7, kPrefix) != 0 || dot == std::string::npos) malformed(entry, "no such key");
    const std::string effect = entry.section.substr(7);
    if (out.effects.empty() || out.effects.back().name != effect) out.effects.push_back({effect, {}});
    out.effects.back().values.push_back({entry.key.substr(0, dot), entry.key.substr(dot + 1), number(entry)});
  }

  double number(const Entry& entry) const {
    double out = 0.0;
    const char* end = entry.value.data() + entry.value.size();
    const auto parsed = std::from_chars(entry.value.data(), end, out);
    if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(out)) malformed(entry, "a finite number");
    return out;
  }

  double positive(const Entry& entry) const {
    const double out = number(entry);
    if (!(out > 0.0)) malformed(entry, "a number above 0");
    return out;
  }

  std::string string(const Entry& entry) const {
    const std::string& text = entry.value;
    if (text.size() < 2 || text.front() != '"' || text.back() != '"') malformed(entry, "a string");
    std::string out;
    for (std::size_t at = 1; at + 1 < text.size(); ++at) {
      if (text[at] == '\\') ++at;
      if (at + 1 < text.size()) out += text[at];
    }
    return out;
  }

  std::string source_;
  std::vector<Entry> entries_;
};

}  // namespace

CompensationData parse_compensation(const std::string& text, const std::string& source) {
  CompensationData out = Reader(text, source).data();
  compensation_model(out, source);
  return out;
}

CompensationData read_compensation(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!(file && text << file.rdbuf())) {
    throw CompensationError(CompensationFault::kCannotRead, path + ": cannot be read (expected a compensation file)");
  }
  return parse_compensation(text.str(), path);
}

}  // namespace hexdbb
