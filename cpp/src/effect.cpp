#include "hexdbb/effect.hpp"

#include <stdexcept>

namespace hexdbb {

namespace {

std::vector<EffectPtr> all_effects(const Machine& machine, int mounts) {
  std::vector<EffectPtr> all = geometric_effects(machine);
  for (EffectPtr& effect : set_up_effects(mounts)) all.push_back(std::move(effect));
  return all;
}

}  // namespace

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const EffectPtr& effect : all_effects(Machine(), 1)) names.push_back(effect->info().name);
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
