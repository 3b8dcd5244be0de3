// The registry: which effects there are, in the order in which they are listed.
#include "hexdbb/effect.hpp"

#include <stdexcept>

#include "catalogue.hpp"

namespace hexdbb {

namespace {

std::vector<EffectPtr> all_effects(const Machine& machine, int mounts) {
  std::vector<EffectPtr> all = geometric_effects(machine);
  for (EffectPtr& effect : set_up_effects(mounts)) all.push_back(std::move(effect));
  for (EffectPtr& effect : catalogue_effects(machine, mounts)) all.push_back(std::move(effect));
  return all;
}

}  // namespace

void Effect::require(const Samples& samples) const {
  for (const std::string& column : info().needs) require_column(samples.state, column, "effect " + info().name);
}

std::vector<EffectPtr> catalogue_effects(const Machine& machine, int mounts) {
  return {backlash(),  reversal_spike(), pitch_cyclic(machine),  lead_error(machine),      straightness(machine),
          servo_lag(), leg_thermal(),    screw_thermal(machine), gravity_sag(machine),     joint_offset(),
          bar_drift(), bar_gain(),       sample_delay(),         ball_eccentricity(mounts)};
}

std::vector<std::string> effect_names(const std::string& group) {
  std::vector<std::string> names;
  for (const EffectPtr& effect : all_effects(Machine(), 1)) {
    if (group.empty() || effect->info().group == group) names.push_back(effect->info().name);
  }
  return names;
}

EffectPtr find_effect(const Machine& machine, int mounts, const std::string& name) {
  for (EffectPtr& effect : all_effects(machine, mounts)) {
    if (effect->info().name == name) return effect;
  }
  std::string known;
  for (const std::string& each : effect_names()) known += (known.empty() ? "" : ", ") + each;
  throw std::invalid_argument("no effect is called \"" + name + "\" (known: " + known + ")");
}

}  // namespace hexdbb
