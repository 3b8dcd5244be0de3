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
  std::string unit;       // "mm", "rad", "s", "mm/N", "mm/K", "mm/s", "mm/mm"; "1" for a ratio
  double prior_sigma;     // size to expect before any measurement, the scale of the fit
  double limit;           // values beyond +-limit make no physical sense
  bool is_shape = false;  // pushes nothing by itself: it shapes what the effect's other parameters push
};

/// Lists that an effect may belong to.
namespace group {
inline const std::string kGeometry = "geometry";    // the thesis' 33 errors
inline const std::string kSetUp = "set-up";         // where cup and ball are, how long the bar is
inline const std::string kCatalogue = "catalogue";  // physical causes beyond these
inline const std::string kUser = "user";            // a user's own
}  // namespace group

struct EffectInfo {
  std::string name;
  std::string physics;  // one sentence
  std::string source;
  std::string element_kind;               // "leg", "slider", "guideway", "side", "mount", "machine"
  std::vector<std::string> elements;      // label of each element: "1", "2", or "12"
  std::vector<ParameterInfo> parameters;  // of one element
  std::vector<std::string> ports;         // names of ports.hpp
  bool is_set_up = false;                 // belongs to the measurement, not to the machine: not to be compensated
  std::string group = hexdbb::group::kGeometry;
  std::vector<std::string> needs = {};  // columns of the samples' state (state.hpp)

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

  /// Throws std::invalid_argument where samples lack what the effect needs. Called once before any block.
  virtual void require(const Samples& samples) const;

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

/// Physical causes beyond geometry and set-up; `mounts` is the number of fixings of the tool cup a model knows.
std::vector<EffectPtr> catalogue_effects(const Machine& machine, int mounts);

/// All effects the engine knows, by name; throws std::invalid_argument naming the known ones.
EffectPtr find_effect(const Machine& machine, int mounts, const std::string& name);

/// Names of the effects of one group, or of all: geometry, set-up, catalogue.
std::vector<std::string> effect_names(const std::string& group = "");

}  // namespace hexdbb
