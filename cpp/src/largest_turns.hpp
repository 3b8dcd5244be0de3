// How far a Newton step on the angles of the legs' pairs may lead, as a tangent: from a neighbouring pose, where a longer
// one shows that it is not one, and from the symmetric start.
#pragma once

namespace hexdbb {

constexpr double kNeighbourTurn = 0.05;
constexpr double kHomeTurn = 0.5;

}  // namespace hexdbb
