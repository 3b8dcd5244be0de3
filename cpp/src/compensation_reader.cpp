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
    out.record_sha256 = records_;
    if (has("", "reference_temperature_c")) out.reference_temperature_c = number(take("", "reference_temperature_c"));
    for (const layout::Dimension& each : layout::kDimensions) {
      if (!each.is_angle || has("dimensions", each.name)) {
        fill(each.of(out.machine), take("dimensions", each.name));
      }
    }
    for (const layout::Limit& each : layout::kLimits) out.limits.*each.member = positive(take("limits", each.name));
    take("check", "crc32");
    for (std::size_t at = 0; has_section(layout::table_section(at)); ++at) out.tables.push_back(take_table(at));
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

  void check_version(const std::string& text) {
    const std::string start = "schema = \"" + layout::kSchema;
    if (text.size() < start.size() && start.compare(0, text.size(), text) == 0) {
      refuse(CompensationFault::kTruncated, "truncated: it ends in its first line");
    }
    if (text.compare(0, start.size(), start) != 0) {
      refuse(CompensationFault::kMalformed, "not a compensation file (expected " + start + "1\" first)");
    }
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + start.size(), end, version_);
    if (parsed.ptr == end) refuse(CompensationFault::kTruncated, "truncated: it ends in its first line");
    if (parsed.ec != std::errc() || *parsed.ptr != '"' || version_ < 1) {
      refuse(CompensationFault::kMalformed, "schema: no version (expected " + start + "1\")");
    }
    if (version_ > layout::kVersion) {
      refuse(CompensationFault::kLaterVersion, "of a later version: " + layout::kSchema + std::to_string(version_) +
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
      const bool is_record = line.compare(0, layout::kRecordComment.size(), layout::kRecordComment) == 0;
      if (is_record)
        records_.push_back(string({section, "record", line.substr(layout::kRecordComment.size()), number}));
      if (line.empty() || line[0] == '#') continue;
      const std::size_t equals = line.find(" = ", line.front() == '"' ? end_of_string(line) : 0);
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

  bool has_section(const std::string& section) const {
    return version_ > 1 &&
           std::any_of(entries_.begin(), entries_.end(), [&](const Entry& each) { return each.section == section; });
  }

  CompensationTable take_table(std::size_t at) {
    const std::string section = layout::table_section(at);
    CompensationTable out;
    out.effect = string(take(section, "effect"));
    out.port = string(take(section, "port"));
    out.variable = string(take(section, "variable"));
    out.times = string(take(section, "times"));
    out.period = number(take(section, "period"));
    const Entry elements = take(section, "elements");
    const std::vector<int> element = numbers<int>(elements);
    const std::vector<int> column = numbers<int>(take(section, "columns"));
    const std::vector<double> weight = numbers<double>(take(section, "weights"));
    out.knots = numbers<double>(take(section, "knots"));
    out.values_mm = numbers<double>(take(section, "values_mm"));
    if (column.size() != element.size() || weight.size() != element.size()) {
      malformed(elements, "as many elements as columns and weights");
    }
    // A number that is out of range stays so, also the smallest that an int can be.
    const auto from_zero = [](int number) { return number > 0 ? number - 1 : -1; };
    for (std::size_t push = 0; push < element.size(); ++push) {
      out.pushes.push_back({from_zero(element[push]), from_zero(column[push]), weight[push]});
    }
    return out;
  }

  void take_effect(const Entry& entry, CompensationData& out) const {
    constexpr const char* kPrefix = "effect.";
    if (entry.section == "left_out") {
      const bool is_quoted = entry.key.compare(0, 1, "\"") == 0;
      out.left_out.push_back(
          {is_quoted ? string(Entry{"", "left_out", entry.key, entry.line}) : entry.key, string(entry)});
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

  /// Set one value for all, or, where there are several, one each.
  void fill(std::span<double> values, const Entry& entry) const {
    if (values.size() == 1 || version_ < 3 || entry.value.front() != '[') {
      std::fill(values.begin(), values.end(), number(entry));
      return;
    }
    const std::vector<double> given = numbers<double>(entry);
    if (given.size() != values.size() ||
        !std::all_of(given.begin(), given.end(), [](double each) { return std::isfinite(each); })) {
      malformed(entry, "a list of " + std::to_string(values.size()) + " finite numbers");
    }
    std::copy(given.begin(), given.end(), values.begin());
  }

  /// Parse "[1, 2]"; that numbers are finite is checked with the table.
  template <class Number>
  std::vector<Number> numbers(const Entry& entry) const {
    const std::string& text = entry.value;
    if (text.size() < 2 || text.front() != '[' || text.back() != ']') unreadable(entry);
    const char *at = text.data() + 1, *const end = text.data() + text.size() - 1;
    std::vector<Number> out;
    while (at != end) {
      if (!out.empty() && (end - at < 2 || *at++ != ',' || *at++ != ' ')) unreadable(entry);
      Number value{};
      const auto parsed = std::from_chars(at, end, value);
      if (parsed.ec != std::errc()) unreadable(entry);
      out.push_back(value);
      at = parsed.ptr;
    }
    return out;
  }

  /// A list may be long: only its section and key are named.
  [[noreturn]] void unreadable(const Entry& entry) const {
    refuse(CompensationFault::kMalformed, "line " + std::to_string(entry.line) + ": " + entry.section + ": " +
                                              entry.key + " (expected a list of numbers)");
  }

  /// Return the place of the quote that ends the string with which a line begins; the line's length where none does.
  static std::size_t end_of_string(const std::string& line) {
    std::size_t at = 1;
    while (at < line.size() && line[at] != '"') at += line[at] == '\\' ? 2 : 1;
    return std::min(at, line.size());
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
  int version_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::string> records_;
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
