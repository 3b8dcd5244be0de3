#include "hexdbb/compensation_tables.hpp"

#include <algorithm>
#include <cmath>

#include "lanes.hpp"
#include "multiversion.hpp"

namespace hexdbb {

namespace {

// Departure of a knot from equal spacing, in intervals, that rounding explains: the line of the neighbouring interval
// is then as good.
constexpr double kEqual = 1e-9;

bool are_equally_spaced(const std::vector<double>& knots) {
  const double step = (knots.back() - knots.front()) / double(knots.size() - 1);
  for (std::size_t at = 0; at < knots.size(); ++at) {
    if (!(std::abs(knots[at] - knots.front() - double(at) * step) <= kEqual * step)) return false;
  }
  return true;
}

}  // namespace

const TableVariableInfo* find_table_variable(const std::string& column) noexcept {
  const auto found = std::find_if(kTableVariables.begin(), kTableVariables.end(),
                                  [&](const TableVariableInfo& each) { return each.column == column; });
  return found == kTableVariables.end() ? nullptr : &*found;
}

const PortSpan* find_compensated_port(const std::string& name) noexcept {
  const auto found = std::find_if(port::kSpans.begin(), port::kSpans.end(),
                                  [&](const PortSpan& each) { return each.name == name && each.first < port::kBall; });
  return found == port::kSpans.end() ? nullptr : &*found;
}

bool may_multiply(TableVariable variable) noexcept {
  return variable != TableVariable::kSliders && variable != TableVariable::kSinceReversal;
}

TableState::TableState() {
  for (Vector6& each : column) each.setZero();
  for (Vector6& each : since_reversal_mm) each.setZero();
  (*this)[TableVariable::kNone].setOnes();
}

TableFunction::TableFunction(const CompensationTable& table)
    : first_(table.knots.front()), last_(table.knots.back()), period_(table.period) {
  const std::vector<double>&x = table.knots, &y = table.values_mm;
  if (x.size() == 1) lines_.push_back({x[0], y[0], 0.0});
  for (std::size_t at = 0; at + 1 < x.size(); ++at) {
    lines_.push_back({x[at], y[at], (y[at + 1] - y[at]) / (x[at + 1] - x[at])});
    steepest_ = std::max(steepest_, std::abs(lines_[at].slope));
    if (at > 0) sharpest_ = std::max(sharpest_, std::abs(lines_[at].slope - lines_[at - 1].slope));
  }
  // Held beyond its ends, or continued at the other end of the period.
  sharpest_ = std::max({sharpest_, std::abs(lines_.front().slope), std::abs(lines_.back().slope)});
  if (period_ > 0.0) per_period_ = 1.0 / period_;
  if (are_equally_spaced(x) && x.size() > 1) per_interval_ = double(lines_.size()) / (last_ - first_);
}

double TableFunction::at(double x, int& interval) const noexcept {
  if (!std::isfinite(x)) return 0.0;
  if (period_ > 0.0) x -= period_ * std::floor(x * per_period_);
  x = std::clamp(x, first_, last_);
  const int count = static_cast<int>(lines_.size());
  int at = interval;
  if (per_interval_ > 0.0) {
    at = std::min(static_cast<int>((x - first_) * per_interval_), count - 1);
  } else if (x < lines_[at].from || (at + 1 < count && x >= lines_[at + 1].from)) {  // no longer where it was
    at = 0;
    for (int left = count; left > 1;) {  // a halving without branches
      const int half = left / 2;
      at += lines_[at + half].from <= x ? half : 0;
      left -= half;
    }
  }
  interval = at;
  const Line& line = lines_[at];
  return line.value + line.slope * (x - line.from);
}

TableSet::TableSet(const std::vector<CompensationTable>& tables) {
  Vector6 steepest = Vector6::Zero(), sharpest = Vector6::Zero();  // of each slider
  for (const CompensationTable& table : tables) {
    const TableVariable variable = find_table_variable(table.variable)->variable;
    const TableVariableInfo& times = *find_table_variable(table.times);
    const int first_port = find_compensated_port(table.port)->first;
    functions_.emplace_back(table);
    const int function = static_cast<int>(functions_.size()) - 1;
    int element = -1;
    for (const TablePush& each : table.pushes) {
      const int place = static_cast<int>(pushes_.size());
      if (each.element != element) lookups_.push_back({function, each.element, variable, times.variable, place, place});
      element = each.element;
      legs_[static_cast<std::size_t>(variable)] |= 1u << element;
      legs_[static_cast<std::size_t>(times.variable)] |= 1u << element;
      if (variable == TableVariable::kSinceReversal) {
        legs_[static_cast<std::size_t>(TableVariable::kTravelDirection)] |= 1u << element;
      }
      pushes_.push_back(on_row(LegPorts::place(first_port + each.column), each.weight));
      lookups_.back().last_push = place + 1;
      if (variable != TableVariable::kSliders) {
        settled_quantities_.push_back(pushes_.back().quantity);
      } else {
        steepest[element] += times.usual * std::abs(each.weight) * functions_.back().steepest();
        sharpest[element] += times.usual * std::abs(each.weight) * functions_.back().sharpest();
      }
    }
  }
  steepest_ = steepest.maxCoeff();
  sharpest_ = sharpest.maxCoeff();
  const auto rest = std::stable_partition(lookups_.begin(), lookups_.end(),
                                          [](const Lookup& each) { return each.variable == TableVariable::kSliders; });
  of_position_ = static_cast<std::size_t>(rest - lookups_.begin());
  std::vector<int>& quantities = settled_quantities_;
  std::sort(quantities.begin(), quantities.end());
  quantities.erase(std::unique(quantities.begin(), quantities.end()), quantities.end());
}

TableSet::Push TableSet::on_row(int place, double weight) noexcept {
  Vector6 legs = Vector6::Zero();
  legs[place % kLegLanes] = weight;
  return {place / kLegLanes, LegRow(legs)};
}

/// Return the value of a function of the travel since a reversal: of either direction of travel as much as is in force.
double TableSet::since_reversal(const TableState& state, Lookup& lookup) const noexcept {
  const TableFunction& function = functions_[static_cast<std::size_t>(lookup.function)];
  const bool is_signed = lookup.times == TableVariable::kTravelDirection;
  const double sigma = state[TableVariable::kTravelDirection][lookup.element];
  double out = 0.0;
  for (const std::size_t side : {0u, 1u}) {
    const double sign = side == 0 ? -1.0 : 1.0, part = 0.5 * (1.0 + sign * sigma);
    if (part == 0.0) continue;
    const double value_mm = function.at(state.since_reversal_mm[side][lookup.element], lookup.interval);
    out += part * (is_signed ? sign : lookup.factor) * value_mm;
  }
  return out;
}

void TableSet::push(const Lookup& lookup, double value_mm, LegPorts& out) const noexcept {
  for (int at = lookup.first_push; at < lookup.last_push; ++at) {
    const Push& each = pushes_[static_cast<std::size_t>(at)];
    double* const row = out.row(each.quantity);
    store(load(row) + value_mm * load(each.weight.of), row);
  }
}

HEXDBB_MULTIVERSION_WIDE
void TableSet::settle(const TableState& state) noexcept {
  for (const int quantity : settled_quantities_) store(Lanes{}, settled_.row(quantity));
  for (std::size_t at = 0; at < lookups_.size(); ++at) {
    Lookup& each = lookups_[at];
    const double factor = state[each.times][each.element];
    each.factor = std::isfinite(factor) ? factor : 0.0;
    if (at < of_position_) continue;
    if (each.variable == TableVariable::kSinceReversal) {
      push(each, since_reversal(state, each), settled_);
      continue;
    }
    const double value_mm = functions_[each.function].at(state[each.variable][each.element], each.interval);
    push(each, each.factor * value_mm, settled_);
  }
}

HEXDBB_MULTIVERSION_WIDE
void TableSet::add(const LegRow& sliders_mm, LegPorts& out) noexcept {
  for (std::size_t at = 0; at < of_position_; ++at) {
    Lookup& each = lookups_[at];
    push(each, each.factor * functions_[each.function].at(sliders_mm.of[each.element], each.interval), out);
  }
}

}  // namespace hexdbb
