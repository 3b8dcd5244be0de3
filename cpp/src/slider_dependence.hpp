// How an effect's push depends on the places of the sliders, found by asking it at trial places in one generic state of
// motion, load and warmth.
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

using Pushes = Eigen::Matrix<double, Eigen::Dynamic, port::kCount>;

/// Places of all sliders, each row elsewhere for each slider, within the travel.
SliderTable trial_places(const Machine& machine);

/// What a term pushes with the sliders at these places.
Pushes ask(const Term& term, const SliderTable& sliders_mm);

/// Most that the pushes on one leg change per mm of its slider's travel.
double steepness(const Term& term, const Machine& machine);

}  // namespace hexdbb
