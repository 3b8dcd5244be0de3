// Readings taken later than the encoders' values beside them.
//
// The sliders have moved on meanwhile, by 0.5 mm at 50 mm/s and 10 ms. What depends on where they are, or on their last
// reversal, is where they are when the gauge is read: a pitch error of 10 mm is 18 degrees further, forward in one
// direction and back in the other.
//
// A fit takes that place as given, and is repeated with the place that its delay makes, until both agree. So the delay is
// that of the readings themselves, as of a ball off the cup's axis; what a pitch error's phase tells of it is not used.
#pragma once

#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// Check for an effect by which readings may be late.
bool may_be_late(const Model& model);

/// Check that readings are late at the model's values, and that samples are not yet as they are then.
bool is_read_late(const Model& model, const Samples& samples);

/// Return by how much readings are late at the model's values.
double late_s(const Model& model);

/// Return samples as they are when the gauge is read, at the model's values: coordinates of the sliders, direction of
/// travel, what has passed since the reversal. Speeds and what changes slowly stay as they are. Throws
/// std::invalid_argument where a column is missing that the effect needs.
Samples when_read(const Model& model, const Samples& samples);

}  // namespace hexdbb
