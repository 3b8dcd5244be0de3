// An effect: a physical cause, its parameters, and what it pushes at the ports. A model is a machine plus a list of
// effects; nothing above this header knows any one effect by name.
//
// An effect has elements (leg 1..6, guideway 1..3, mount 1.., the whole machine) and the same parameters for each.
// Values are laid out element by element. Parameters are in the engine's units.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hexdbb/affine_push.hpp"
#include "hexdbb/samples.hpp"

namespace hexdbb {

struct ParameterInfo {
  std::string name = {};
  std::string unit = {};        // "mm", "rad", "s", "mm/N", "mm/K", "mm/s", "mm/mm"; "1" for a ratio
  double prior_sigma = 0.0;     // prior standard deviation, and the scale of the fit
  double limit = 0.0;           // largest magnitude with a physical meaning
  bool is_shape = false;        // pushes nothing by itself: it shapes what the effect's other parameters push
  bool is_nonnegative = false;  // physics admits no value below 0 (play, delay, compliance)

  /// Physical domain [lower, upper]. Description only: a fit is bounded by +-limit.
  double lower() const { return is_nonnegative ? 0.0 : -limit; }
  double upper() const { return limit; }
};

/// Lists to which an effect may belong.
namespace group {
inline const std::string kGeometry = "geometry";    // the 33 geometric errors of the thesis
inline const std::string kSetUp = "set-up";         // positions of cup and ball, length of the bar
inline const std::string kPlaces = "places";        // of the set-up too, where the ball had several places
inline const std::string kCatalogue = "catalogue";  // physical causes beyond these
inline const std::string kUser = "user";            // defined by a user
}  // namespace group

struct EffectInfo {
  std::string name = {};
  std::string group = {};
  std::string physics = {};                    // one sentence
  std::string formula = {};                    // what is pushed, as plain text
  std::string source = {};                     // thesis section, standard, paper
  std::string element_kind = {};               // "leg", "slider", "guideway", "side", "mount", "machine"
  std::vector<std::string> elements = {};      // label of each element: "1", "2", or "12"
  std::vector<ParameterInfo> parameters = {};  // of one element
  std::vector<std::string> ports = {};         // names of ports.hpp
  std::vector<std::string> needs = {};         // columns of the samples' state (state.hpp)
  bool is_set_up = false;                      // belongs to the measurement, not to the machine: never compensated
  bool is_free_at_first = true;  // whether a new model fits its values; false: fixed until freed by the user

  int size() const { return static_cast<int>(elements.size() * parameters.size()); }
};

/// Pushes, or sensitivities, of a block of samples: one row per sample, one column per port.
using PortBlock = Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>>;
using ConstPortBlock = Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, port::kCount>, 0, Eigen::OuterStride<>>;
/// Derivatives of a block's readings, one column per value of the effect.
using JacobianBlock = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using Values = Eigen::Ref<const Eigen::VectorXd>;

class Effect;
using EffectPtr = std::shared_ptr<const Effect>;

class Effect {
 public:
  explicit Effect(EffectInfo info) : info_(std::move(info)) {}
  virtual ~Effect() = default;

  const EffectInfo& info() const { return info_; }

  /// Throw std::invalid_argument where samples lack what the effect needs. Called once before any block.
  virtual void require(const Samples& samples) const;

  /// Add what the effect pushes.
  virtual void push(const SampleBlock& block, Values values, PortBlock ports) const = 0;

  /// Chain rule: d reading / d value = sensitivity at the ports times d push / d value. Overwrites `jacobian`.
  virtual void chain(const SampleBlock& block, Values values, ConstPortBlock sensitivity,
                     JacobianBlock jacobian) const = 0;

  /// Return the pushes at these values where they are affine in the sliders' coordinates for all samples; nothing where
  /// they are not. push() and chain() then are what follows from it.
  virtual std::optional<AffinePush> affine(Values) const { return std::nullopt; }

  /// Return by how much readings are later than the encoders' values at these values; nothing where the effect has no
  /// such. What it pushes the sliders by is where they are then; other effects act there (read_late.hpp).
  virtual std::optional<double> late_s(Values) const { return std::nullopt; }

 private:
  EffectInfo info_;
};

/// Return the effect of that name; `mounts` is the number of fixings of the tool cup that the model distinguishes.
/// Throws std::invalid_argument, listing the known names, where there is none.
EffectPtr find_effect(const Machine& machine, int mounts, const std::string& name);

bool is_known_effect(const std::string& name);

/// Return the names of the effects of one group (geometry, set-up, places, catalogue), or of all, in catalogue order.
std::vector<std::string> effect_names(const std::string& group = "");

/// Compute d push / d value of an effect at given values: a matrix of samples x values for each of the 55 ports.
std::vector<Eigen::MatrixXd> push_derivatives(const Effect& effect, const Samples& samples, Values values);

}  // namespace hexdbb
