// Dependence of an effect's push on the slider coordinates and on the state of an instant, determined by evaluating it
// at trial positions in trial states.
#pragma once

#include <functional>
#include <vector>

#include "hexdbb/slider_polynomials.hpp"

namespace hexdbb {

using Pushes = Eigen::Matrix<double, Eigen::Dynamic, port::kCount>;

/// Return positions of all sliders within the travel, different in each row and for each slider, and as many states.
SliderTable trial_positions(const Machine& machine);
std::vector<InstantState> trial_instants();

/// Return the columns of the state that a controller knows, a row per instant: any play is crossed, no time has passed.
State state_of(const std::vector<InstantState>& instants);

/// Compute the pushes of a term with the sliders at these coordinates.
Pushes pushes_of(const Term& term, const SliderTable& sliders_mm, const State& state);

/// A folded form of a term's push.
using Folded = std::function<LegPorts(const Vector6& sliders_mm, const InstantState& instant)>;

/// Return whether a folded form is what a term pushes, and all that it pushes, at the trial positions and instants.
bool agrees_with(const Term& term, const Machine& machine, const Folded& folded);

/// Compute the largest change of the pushes on one leg per mm of its slider's travel.
double steepness(const Term& term, const Machine& machine);

}  // namespace hexdbb
