#include "hexdbb/state.hpp"

#include <limits>
#include <stdexcept>

#include "hexdbb/prediction.hpp"

namespace hexdbb {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool may_lack_values(const std::string& column) { return column == "temperature_c" || column == "warming_k"; }

/// First row that is not a number all through, or -1.
template <class Column>
Eigen::Index first_unknown(const Column& column) {
  if (column.template cast<double>().allFinite()) return -1;
  Eigen::Index row = 0;
  while (column.row(row).template cast<double>().allFinite()) ++row;
  return row;
}

/// Samples of slider places alone, the bar set up one way for all.
Samples places(const SliderTable& sliders_mm, const SetUp& set_up) {
  Samples out;
  out.sliders_mm = sliders_mm;
  out.set_up.setZero(sliders_mm.rows());
  out.mount.setZero(sliders_mm.rows());
  out.set_ups = {set_up};
  return out;
}

}  // namespace

State State::rows(const std::vector<Eigen::Index>& which) const {
  State out = *this;
  for_each_column(out, [&](const char*, auto& column) {
    if (column.size() > 0) column = column(which, Eigen::all).eval();
  });
  return out;
}

void require_column(const State& state, const std::string& wanted, const std::string& who) {
  bool known = false;
  for_each_column(state, [&](const char* name, const auto& column) {
    if (wanted != name) return;
    known = true;
    if (column.size() == 0) {
      throw std::invalid_argument(who + " needs the samples' " + wanted + ", which these samples do not have");
    }
    const Eigen::Index row = may_lack_values(wanted) ? -1 : first_unknown(column);
    if (row >= 0) throw std::invalid_argument(who + " needs " + wanted + "[" + std::to_string(row) + "], not a number");
  });
  if (!known) throw std::invalid_argument(who + " needs " + wanted + ", which is no column of a sample's state");
}

SliderTable leg_force(const NominalGeometry& nominal, const SliderTable& sliders_mm) {
  // A bar from the reference point down to a cup 1000 km below hangs vertical: what it reads is height.
  const SetUp plumb{Vector3(0.0, 0.0, -1e9), Vector3::Zero(), 0.0};
  SliderTable out = -port_sensitivity(Model(nominal.machine), places(sliders_mm, plumb)).middleCols<kLegs>(port::kLeg);
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    if (out.row(row).isZero(0.0)) out.row(row).setConstant(kNothing);
  }
  return out;
}

Eigen::VectorXd nominal_reading_mm(const NominalGeometry& nominal, const Samples& samples) {
  const Prediction predicted = predict(Model(nominal.machine), samples, false);
  return (predicted.status.array() == 0).select(predicted.reading_mm, kNothing);
}

void derive(const NominalGeometry& nominal, Samples& samples) {
  State& state = samples.state;
  require_column(state, "time_s", "the sliders' motion");
  require_column(state, "sweep", "the sliders' motion");
  samples.validate();
  Motion moved = motion(state.time_s, state.sweep, samples.sliders_mm);
  state.velocity_mm_s = std::move(moved.velocity_mm_s);
  state.acceleration_mm_s2 = std::move(moved.acceleration_mm_s2);
  state.jerk_mm_s3 = std::move(moved.jerk_mm_s3);
  state.snap_mm_s4 = std::move(moved.snap_mm_s4);
  state.side = std::move(moved.side);
  state.since_reversal_s = std::move(moved.since_reversal_s);
  state.since_reversal_mm = std::move(moved.since_reversal_mm);
  state.leg_force = leg_force(nominal, samples.sliders_mm);
  state.nominal_reading_mm = nominal_reading_mm(nominal, samples);
}

}  // namespace hexdbb
