// Inconsistent samples are refused with column, row and what was expected.
#include <gtest/gtest.h>

#include <limits>

#include "circles.hpp"
#include "refusal.hpp"

namespace hexdbb::testing {
namespace {

class SamplesTest : public ::testing::Test {
 protected:
  Samples samples = circle_samples(Machine(), {CircleSpec()}, 5);

  std::string said() const {
    return refusal([this] { samples.validate(); });
  }
};

TEST_F(SamplesTest, GoodOnesPass) { EXPECT_NO_THROW(samples.validate()); }

TEST_F(SamplesTest, ColumnOfAnotherLength) {
  samples.set_up.setZero(4);
  EXPECT_EQ(said(), "set_up has 4 rows, expected 5 as in sliders_mm");
  samples.set_up.setZero(5);
  samples.mount.setZero(6);
  EXPECT_EQ(said(), "mount has 6 rows, expected 5 as in sliders_mm");
}

TEST_F(SamplesTest, SetUpThatDoesNotExist) {
  samples.set_up[3] = 1;
  EXPECT_EQ(said(), "set_up[3] is 1, expected 0 to 0");
  samples.set_up[3] = -1;
  EXPECT_EQ(said(), "set_up[3] is -1, expected 0 to 0");
}

TEST_F(SamplesTest, NegativeMount) {
  samples.mount[2] = -1;
  EXPECT_TRUE(contains(said(), "mount[2]")) << said();
}

TEST_F(SamplesTest, SliderThatIsNotANumber) {
  samples.sliders_mm(4, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(said(), "sliders_mm[4] is not finite");
}

TEST_F(SamplesTest, MountThatTheModelDoesNotKnow) {
  samples.mount[1] = 2;  // the model has two mounts, 0 and 1
  const Model model = full_model(Machine(), 2);
  EXPECT_THROW(predict(model, samples, true), std::invalid_argument);
}

}  // namespace
}  // namespace hexdbb::testing
