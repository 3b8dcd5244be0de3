// What tables of compensation data must be, whoever wrote them.
#include <algorithm>
#include <cmath>

#include "compensation_layout.hpp"

namespace hexdbb {

namespace {

using Fault = CompensationFault;

class TableCheck {
 public:
  TableCheck(const CompensationTable& table, std::string where) : table_(table), where_(std::move(where)) {}

  void all() const {
    names();
    pushes();
    numbers("knots", table_.knots);
    numbers("values_mm", table_.values_mm);
    knots();
  }

 private:
  [[noreturn]] void refuse(Fault fault, const std::string& what, const std::string& expected) const {
    throw CompensationError(fault, where_ + ": " + what + " (expected " + expected + ")");
  }

  void names() const {
    if (table_.effect.empty()) refuse(Fault::kMalformed, "effect: no name", "the name of an effect");
    if (find_compensated_port(table_.port) == nullptr) {
      refuse(Fault::kUnknownEffect, "port " + table_.port + ": cannot be corrected", "a port of slider, leg or joint");
    }
    if (find_table_variable(table_.variable) == nullptr) {
      refuse(Fault::kUnknownEffect, "variable " + table_.variable + ": not known here", "one that a controller knows");
    }
    const TableVariableInfo* times = find_table_variable(table_.times);
    if (times == nullptr || !may_multiply(times->variable)) {
      refuse(Fault::kUnknownEffect, "times " + table_.times + ": not known here", "one that a controller knows");
    }
  }

  void pushes() const {
    const int columns = find_compensated_port(table_.port)->size;
    if (table_.pushes.empty()) refuse(Fault::kMalformed, "elements: none", "at least one");
    for (const TablePush& each : table_.pushes) {
      in_range("element", each.element, kLegs);
      in_range("column", each.column, columns);
      if (!std::isfinite(each.weight)) refuse(Fault::kMalformed, "weights: not finite", "finite numbers");
    }
  }

  void in_range(const std::string& name, int number, int count) const {
    if (number >= 0 && number < count) return;
    refuse(Fault::kMalformed, name + " " + std::to_string(number + 1), "1 to " + std::to_string(count));
  }

  void numbers(const std::string& name, const std::vector<double>& all) const {
    const auto wrong = std::find_if(all.begin(), all.end(), [](double each) { return !std::isfinite(each); });
    if (wrong == all.end()) return;
    refuse(Fault::kMalformed, name + ": number " + std::to_string(wrong - all.begin() + 1) + " is not finite",
           "finite numbers");
  }

  void knots() const {
    const std::vector<double>& x = table_.knots;
    const bool has_variable = !table_.variable.empty();
    if (x.size() != table_.values_mm.size()) {
      refuse(Fault::kMalformed,
             std::to_string(x.size()) + " knots, " + std::to_string(table_.values_mm.size()) + " values_mm",
             "as many of one as of the other");
    }
    if (has_variable ? x.size() < 2 : x.size() != 1) {
      refuse(Fault::kMalformed, std::to_string(x.size()) + " knots",
             has_variable ? "at least 2" : "1 without a variable");
    }
    for (std::size_t at = 1; at < x.size(); ++at) {
      if (x[at] > x[at - 1]) continue;
      refuse(Fault::kMalformed, "knots: " + layout::number(x[at]) + " after " + layout::number(x[at - 1]),
             "rising numbers");
    }
    if (!(table_.period >= 0.0) || !std::isfinite(table_.period)) {
      refuse(Fault::kMalformed, "period " + layout::number(table_.period), "0 or more");
    }
    if (table_.period > 0.0 && (x.front() < 0.0 || x.back() > table_.period)) {
      refuse(Fault::kMalformed, "knots " + layout::number(x.front()) + " to " + layout::number(x.back()),
             "within 0 to the period, " + layout::number(table_.period));
    }
  }

  const CompensationTable& table_;
  std::string where_;
};

}  // namespace

void require_tables(const std::vector<CompensationTable>& tables, const std::string& source) {
  for (std::size_t at = 0; at < tables.size(); ++at) {
    TableCheck(tables[at], source + ": " + layout::table_section(at)).all();
  }
}

}  // namespace hexdbb
