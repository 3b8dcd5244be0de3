#include "catalogue.hpp"
#include "place_per_set_up.hpp"
#include "set_up_sizes.hpp"

namespace hexdbb::effects {

EffectPtr cup_position(const Context& context) {
  EffectInfo info = {
      .name = "cup_position",
      .group = group::kSetUp,
      .physics = "The tool cup is not where planned.",
      .formula = "cup = (x, y, z) of the mount, base frame",
      .source = "set-up",
      .parameters = {place("x"), place("y"), place("z")},
      .ports = {"cup"},
      .is_set_up = true,
  };
  return std::make_shared<PlacePerSetUp>(std::move(info), context.mounts, port::kCup);
}

}  // namespace hexdbb::effects
