// A model and the readings it predicts: every effect pushes at the ports, then the exact kinematics is solved, so that
// effects combine as in the machine, not as a sum of contours (thesis 3.1 is the linear case). Derivatives follow from
// the chain rule: sensitivity of the kinematics at the port times the effect's own derivative, analytic throughout.
#pragma once

#include <vector>

#include "hexdbb/effect.hpp"

namespace hexdbb {

struct Term {
  EffectPtr effect;
  Eigen::VectorXd values;  // element by element, engine units
};

struct Model {
  explicit Model(const Machine& machine) : nominal(machine) {}

  NominalGeometry nominal;
  std::vector<Term> terms;

  void add(EffectPtr effect);  // with all values zero
  int size() const;            // number of values over all terms
  Eigen::VectorXd values() const;
  void set_values(Values values);
};

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Prediction {
  Eigen::VectorXd reading_mm;
  Eigen::VectorXi status;              // of kinematics.hpp, one per sample; the reading is zero where it is not ok
  RowMajorMatrix jacobian;             // samples x values, d reading / d value; empty unless asked for
  Eigen::Index first_failure() const;  // row, or -1
};

/// Predict the readings of samples. Where readings are later than the encoders' values, effects act where the sliders are
/// when the gauge is read; for the Jacobian that place counts as given. Throws std::invalid_argument where samples lack
/// what an effect needs.
Prediction predict(const Model& model, const Samples& samples, bool want_jacobian);

/// Compute the sensitivity of every sample's reading to a push at each port, samples x 55.
RowMajorMatrix port_sensitivity(const Model& model, const Samples& samples);

/// Poses of the platform: rows of x, y, z and the rotation matrix row by row; one status per row.
struct PoseTable {
  RowMajorMatrix pose;  // rows x 12
  Eigen::VectorXi status;

  Pose at(Eigen::Index row) const;
};

/// Compute the poses of samples under all effects of a model.
PoseTable forward_table(const Model& model, const Samples& samples);

}  // namespace hexdbb
