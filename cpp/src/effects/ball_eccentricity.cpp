#include "catalogue.hpp"
#include "fitted_sizes.hpp"
#include "place_per_set_up.hpp"

namespace hexdbb::effects {

EffectPtr ball_eccentricity(const Context& context) {
  EffectInfo info = {
      .name = "ball_eccentricity",
      .group = group::kCatalogue,
      .physics =
          "The bar's ball has a different position on the platform in every set-up, one offset for each fixing of "
          "the tool cup; ball_offset is the part common to all.",
      .formula = "ball = (x, y, z) of the mount, platform frame",
      .source = "set-up",
      .parameters = {fitted_by_hand("x"), fitted_by_hand("y"), fitted_by_hand("z")},
      .ports = {"ball"},
      .is_set_up = true,
  };
  return std::make_shared<PlacePerSetUp>(std::move(info), context.mounts, port::kBall);
}

}  // namespace hexdbb::effects
