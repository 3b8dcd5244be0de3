// An effect: a physical cause, its parameters, and what it pushes at the ports. A model is a machine plus a list of
// effects; nothing above this header knows any one effect by name.
//
// An effect has elements (leg 1..6, guideway 1..3, mount 1.., the whole machine) and the same parameters for each.
// Values are laid out element by element. Parameters are in the engine's units.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hexdbb/samples.hpp"

namespace hexdbb {

struct ParameterInfo {
  std::string name;
  std::string unit;    // "mm", "rad"
  double prior_sigma;  // size to expect before any measurement, the scale of the fit
  double limit;        // values beyond +-limit make no physical sense
};

struct EffectInfo {
  std::string name;
  std::string physics;  // one sentence
  std::string source;
  std::string element_kind;               // "leg", "slider", "guideway", "side", "mount", "machine"
  std::vector<std::string> elements;      // label of each element: "1", "2", or "12"
  std::vector<ParameterInfo> parameters;  // of one element
  std::vector<std::string> ports;         // names of ports.hpp
  bool is_set_up = false;                 // belongs to the set-up, not to the machine

  int size() const { return static_cast<int>(elements.size() * parameters.size()); }
};

/// Pushes, or sensitivities, of a block of samples: one row a sample, one column a port.
using PortBlock = Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>>;
using ConstPortBlock = Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>>;
/// Derivatives of a block's readings, one column a value of the effect.
using JacobianBlock = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using Values = Eigen::Ref<const Eigen::VectorXd>;

class Effect {
 public:
  virtual ~Effect() = default;
  virtual const EffectInfo& info() const = 0;

  /// Add what the effect pushes.
  virtual void push(const SampleBlock& block, Values values, PortBlock ports) const = 0;

  /// Chain rule: d reading / d value = sensitivity at the ports times d push / d value. Overwrites `jacobian`.
  virtual void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
                     JacobianBlock jacobian) const = 0;
};

using EffectPtr = std::shared_ptr<const Effect>;

/// The thesis' 33 geometric errors, one effect a group, in the order of thesis section 3.2.
std::vector<EffectPtr> geometric_effects(const Machine& machine);

/// Unknowns of the set-up: the cup's position per mount, the ball's offset, the bar's length.
std::vector<EffectPtr> set_up_effects(int mounts);

/// All effects the engine knows, by name; throws std::invalid_argument naming the known ones.
EffectPtr find_effect(const Machine& machine, int mounts, const std::string& name);
std::vector<std::string> effect_names();

}  // namespace hexdbb
