// How far a Newton step on the angles of the legs' pairs may lead, as a tangent: from a neighbouring pose, where a longer
// one shows that it is not one, and from the symmetric start.
#pragma once

namespace hexdbb {

// 20 mm at the end of a leg of 400 mm: readings of a lap are millimetres apart, two circles tens of them.
constexpr double kNeighbourTurn = 0.05;
// Pairs lean inward by 0.41 rad in the symmetric pose: a longer step from it may pass the upright or the flat one, where
// other assemblies of the machine begin.
constexpr double kHomeTurn = 0.5;

}  // namespace hexdbb
