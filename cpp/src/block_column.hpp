// One number per row of a block, on the stack: its maximum size is fixed, so that nothing is allocated.
#pragma once

#include "block.hpp"

namespace hexdbb {

using BlockColumn = Eigen::Array<double, Eigen::Dynamic, 1, 0, Block::kRows, 1>;

}  // namespace hexdbb
