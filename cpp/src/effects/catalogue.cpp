#include "catalogue.hpp"

#include <algorithm>
#include <stdexcept>

namespace hexdbb {

namespace {

struct Entry {
  const char* name;
  EffectPtr (*build)(const effects::Context&);
};

#define HEXDBB_ENTRY(name) {#name, &effects::name},
constexpr Entry kEntries[] = {HEXDBB_CATALOGUE(HEXDBB_ENTRY)};
#undef HEXDBB_ENTRY

const Entry* entry(const std::string& name) {
  const auto* found =
      std::find_if(std::begin(kEntries), std::end(kEntries), [&](const Entry& each) { return each.name == name; });
  return found == std::end(kEntries) ? nullptr : found;
}

}  // namespace

bool is_known_effect(const std::string& name) { return entry(name) != nullptr; }

EffectPtr find_effect(const Machine& machine, int mounts, const std::string& name) {
  if (mounts < 0) throw std::invalid_argument("mounts is " + std::to_string(mounts) + ", expected 0 or more");
  const Entry* found = entry(name);
  if (found != nullptr) return found->build({machine, mounts});
  std::string known;
  for (const Entry& each : kEntries) known += (known.empty() ? "" : ", ") + std::string(each.name);
  throw std::invalid_argument("no effect has the name \"" + name + "\" (known: " + known + ")");
}

std::vector<std::string> effect_names(const std::string& group) {
  std::vector<std::string> names;
  for (const Entry& each : kEntries) {
    if (group.empty() || each.build({Machine(), 1})->info().group == group) names.emplace_back(each.name);
  }
  return names;
}

}  // namespace hexdbb
