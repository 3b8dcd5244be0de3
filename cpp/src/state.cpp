#include "hexdbb/state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "hexdbb/prediction.hpp"

namespace hexdbb {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Return the first row that holds a NaN or infinity, or -1.
template <class Column>
Eigen::Index first_unknown(const Column& column) {
  if (column.template cast<double>().allFinite()) return -1;
  Eigen::Index row = 0;
  while (column.row(row).template cast<double>().allFinite()) ++row;
  return row;
}

/// Return samples of slider positions alone, with one set-up for all.
Samples samples_at(const SliderTable& sliders_mm, const SetUp& set_up) {
  Samples out;
  out.sliders_mm = sliders_mm;
  out.set_up.setZero(sliders_mm.rows());
  out.mount.setZero(sliders_mm.rows());
  out.set_ups = {set_up};
  return out;
}

double angle_between(const Vector3& one, const Vector3& other) {
  return std::acos(std::clamp(one.dot(other), -1.0, 1.0));
}

/// Take a column over unless it was not computed: what is there already stays.
void take(SliderTable& column, SliderTable& computed) {
  if (computed.size() > 0) column = std::move(computed);
}

/// Fill the columns of the sliders' motion, as many derivatives as asked for.
void fill_motion(Samples& samples, int derivatives) {
  State& state = samples.state;
  Motion slider =
      std::move(motions(state.time_s, state.sweep, state.angle_rad, {{samples.sliders_mm, derivatives}}).front());
  state.velocity_mm_s = std::move(slider.velocity_mm_s);
  take(state.acceleration_mm_s2, slider.acceleration_mm_s2);
  take(state.jerk_mm_s3, slider.jerk_mm_s3);
  take(state.snap_mm_s4, slider.snap_mm_s4);
  state.travel_direction = std::move(slider.travel_direction);
  state.since_reversal_s = std::move(slider.since_reversal_s);
  state.since_reversal_mm = std::move(slider.since_reversal_mm);
}

void fill_poses(const NominalGeometry& nominal, Samples& samples) {
  State& state = samples.state;
  NominalPoses poses = nominal_poses(nominal, samples.sliders_mm);
  state.position_mm = std::move(poses.position_mm);
  state.platform_rpy_rad = std::move(poses.platform_rpy_rad);
  state.slider_joint_angle_rad = std::move(poses.slider_joint_angle_rad);
  state.platform_joint_angle_rad = std::move(poses.platform_joint_angle_rad);
}

/// Fill the columns of the joints' motion, and those of the poses they follow from. Angles of joints are handled as arcs
/// of the leg's far end, so that the dead band of reversals is that of the sliders.
void fill_joint_motion(const NominalGeometry& nominal, Samples& samples) {
  State& state = samples.state;
  fill_poses(nominal, samples);
  const SliderTable length_mm =
      Eigen::Map<const Vector6>(nominal.machine.leg_length_mm.data()).transpose().replicate(samples.size(), 1);
  const SliderTable slider_arc_mm = state.slider_joint_angle_rad.cwiseProduct(length_mm);
  const SliderTable platform_arc_mm = state.platform_joint_angle_rad.cwiseProduct(length_mm);
  SliderTable position_mm = SliderTable::Zero(samples.size(), kLegs);
  position_mm.leftCols<3>() = state.position_mm;
  std::vector<Motion> all =
      motions(state.time_s, state.sweep, state.angle_rad, {{slider_arc_mm, 1}, {platform_arc_mm, 1}, {position_mm, 1}});
  const auto turned_mm = all[0].since_reversal_mm.array();
  state.slider_joint_rate_rad_s = all[0].velocity_mm_s.cwiseQuotient(length_mm);
  state.slider_joint_direction = std::move(all[0].travel_direction);
  state.slider_joint_since_reversal_rad = (turned_mm < kLongAgo).select(turned_mm / length_mm.array(), kLongAgo);
  state.platform_joint_rate_rad_s = all[1].velocity_mm_s.cwiseQuotient(length_mm);
  state.platform_velocity_mm_s = all[2].velocity_mm_s.leftCols<3>();
  state.speed_mm_s = state.platform_velocity_mm_s.rowwise().norm();
}

double wrapped(double angle_rad) {
  constexpr double kTurn = 2.0 * M_PI;
  const double out = angle_rad - kTurn * std::floor(angle_rad / kTurn);
  return out < kTurn ? out : 0.0;  // of -1e-17 the difference rounds to a whole turn
}

/// Columns that are derived together.
struct Derivation {
  std::vector<std::string> columns;
  void (*fill)(const NominalGeometry&, Samples&);
};

/// Every derivation; the last ones, from `kPartial` on, fill a part of what an earlier one fills.
const std::vector<Derivation>& derivations() {
  static const std::vector<Derivation> all = {
      {{"angle_wrapped_rad"},
       [](const NominalGeometry&, Samples& samples) {
         samples.state.angle_wrapped_rad = samples.state.angle_rad.unaryExpr(&wrapped);
       }},
      {{"acceleration_mm_s2", "jerk_mm_s3", "snap_mm_s4"},
       [](const NominalGeometry&, Samples& samples) { fill_motion(samples, kMostDerivatives); }},
      {{"slider_joint_rate_rad_s", "slider_joint_direction", "slider_joint_since_reversal_rad",
        "platform_joint_rate_rad_s", "speed_mm_s", "platform_velocity_mm_s"},
       &fill_joint_motion},
      {{"leg_force"},
       [](const NominalGeometry& nominal, Samples& samples) {
         samples.state.leg_force = leg_force(nominal, samples.sliders_mm);
       }},
      {{"nominal_reading_mm"},
       [](const NominalGeometry& nominal, Samples& samples) {
         samples.state.nominal_reading_mm = nominal_reading_mm(nominal, samples);
       }},
      {{"velocity_mm_s", "travel_direction", "since_reversal_s", "since_reversal_mm"},
       [](const NominalGeometry&, Samples& samples) { fill_motion(samples, 1); }},
      {{"position_mm", "platform_rpy_rad", "slider_joint_angle_rad", "platform_joint_angle_rad"}, &fill_poses},
  };
  return all;
}

constexpr std::size_t kPartial = 5;

const Derivation& derivation_of(const std::string& column) {
  for (const Derivation& each : derivations()) {
    if (std::find(each.columns.begin(), each.columns.end(), column) != each.columns.end()) return each;
  }
  throw std::invalid_argument(column + " is no column that follows from others");
}

}  // namespace

State State::rows(const std::vector<Eigen::Index>& which) const {
  std::vector<const void*> columns;  // of this state, in the order in which those of the other are visited
  for_each_column(*this, [&](const ColumnInfo&, const auto& column) { columns.push_back(&column); });
  State out;
  auto next = columns.begin();
  for_each_column(out, [&](const ColumnInfo&, auto& column) {
    const auto& whole = *static_cast<const std::decay_t<decltype(column)>*>(*next++);
    if (whole.size() > 0) column = whole(which, Eigen::all);
  });
  return out;
}

void require_column(const State& state, const std::string& wanted, const std::string& who) {
  bool known = false;
  for_each_column(state, [&](const ColumnInfo& info, const auto& column) {
    if (wanted != info.name) return;
    known = true;
    if (column.size() == 0) {
      throw std::invalid_argument(who + " needs the samples' " + wanted + ", which these samples do not have");
    }
    const Eigen::Index row = info.may_be_nan ? -1 : first_unknown(column);
    if (row >= 0) {
      throw std::invalid_argument(who + " needs " + wanted + "[" + std::to_string(row) + "], which is not a number");
    }
  });
  if (!known) throw std::invalid_argument(who + " needs " + wanted + ", which is no column of a sample's state");
}

SliderTable leg_force(const NominalGeometry& nominal, const SliderTable& sliders_mm) {
  // A bar from the reference point down to a cup 1000 km below hangs vertically: it reads the height.
  const SetUp plumb{Vector3(0.0, 0.0, -1e9), Vector3::Zero(), 0.0};
  SliderTable out =
      -port_sensitivity(Model(nominal.machine), samples_at(sliders_mm, plumb)).middleCols<kLegs>(port::kLeg);
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    if (out.row(row).isZero(0.0)) out.row(row).setConstant(kUnknown);
  }
  return out;
}

NominalPoses nominal_poses(const NominalGeometry& nominal, const SliderTable& sliders_mm) {
  const Eigen::Index count = sliders_mm.rows();
  const PoseTable table = forward_table(Model(nominal.machine), samples_at(sliders_mm, SetUp()));
  NominalPoses out{AxisTable::Constant(count, 3, kUnknown), AxisTable::Constant(count, 3, kUnknown),
                   SliderTable::Constant(count, kLegs, kUnknown), SliderTable::Constant(count, kLegs, kUnknown)};
  for (Eigen::Index row = 0; row < count; ++row) {
    if (table.status[row] != 0) continue;
    const Pose pose = table.at(row);
    out.position_mm.row(row) = pose.position.transpose();
    out.platform_rpy_rad.row(row) = rpy_from_rotation(pose.rotation).transpose();
    for (int k = 0; k < kLegs; ++k) {
      const Vector3 slider_joint = nominal.vertex.col(k) + sliders_mm(row, k) * nominal.direction.col(k);
      const Vector3 platform_joint = pose.position + pose.rotation * nominal.platform_joint.col(k);
      const Vector3 along = (platform_joint - slider_joint).normalized();
      out.slider_joint_angle_rad(row, k) = angle_between(along, nominal.direction.col(k));
      out.platform_joint_angle_rad(row, k) = angle_between(along, pose.rotation.col(2));
    }
  }
  return out;
}

Eigen::VectorXd nominal_reading_mm(const NominalGeometry& nominal, const Samples& samples) {
  const Prediction predicted = predict(Model(nominal.machine), samples, false);
  return (predicted.status.array() == 0).select(predicted.reading_mm, kUnknown);
}

void derive(const NominalGeometry& nominal, Samples& samples, const std::vector<std::string>& columns) {
  require_column(samples.state, "time_s", "the sliders' motion");
  require_column(samples.state, "sweep", "the sliders' motion");
  samples.validate();
  if (columns.empty()) {
    for (std::size_t each = 0; each < kPartial; ++each) derivations()[each].fill(nominal, samples);
  }
  std::set<const Derivation*> wanted;  // each once, in the table's order: what fills a part comes behind
  for (const std::string& column : columns) wanted.insert(&derivation_of(column));
  const bool has_motion = wanted.count(&derivation_of("acceleration_mm_s2")) > 0;
  const bool has_poses = wanted.count(&derivation_of("speed_mm_s")) > 0;
  if (has_motion) wanted.erase(&derivation_of("velocity_mm_s"));
  if (has_poses) wanted.erase(&derivation_of("position_mm"));
  for (const Derivation* each : wanted) each->fill(nominal, samples);
}

}  // namespace hexdbb
