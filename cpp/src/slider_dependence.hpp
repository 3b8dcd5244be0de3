// How an effect's push depends on the places of the sliders and on the state of an instant, found by asking it at trial
// places in trial states.
#pragma once

#include <vector>

#include "hexdbb/slider_polynomials.hpp"

namespace hexdbb {

using Pushes = Eigen::Matrix<double, Eigen::Dynamic, port::kCount>;

/// Places of all sliders, each row elsewhere for each slider, within the travel; as many states to go with them.
SliderTable trial_places(const Machine& machine);
std::vector<InstantState> trial_instants();

/// Columns of the state a controller can fill, a row an instant: any play is crossed, no time has passed.
State state_of(const std::vector<InstantState>& instants);

/// What a term pushes with the sliders at these places.
Pushes ask(const Term& term, const SliderTable& sliders_mm, const State& state);

/// Most that the pushes on one leg change per mm of its slider's travel.
double steepness(const Term& term, const Machine& machine);

}  // namespace hexdbb
