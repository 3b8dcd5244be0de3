// Tables in the compensation file, version 2: nothing lost in a round trip, nothing wrong accepted.
#include <gtest/gtest.h>

#include <random>

#include "compensation_texts.hpp"

namespace hexdbb::testing {
namespace {

TEST(TablesInFile, TablesReadAsTheSameBits) {
  const CompensationData data = with_tables();
  const std::string text = compensation_text(data);
  EXPECT_EQ(text.find("schema = \"hexdbb.compensation/2\"\n"), 0u);
  const CompensationData again = parse_compensation(text, "a.hexcomp");
  EXPECT_EQ(compensation_text(again), text);
  EXPECT_EQ(again.left_out.back().effect, data.left_out.back().effect);
  ASSERT_EQ(again.tables.size(), data.tables.size());
  for (std::size_t t = 0; t < data.tables.size(); ++t) {
    const CompensationTable &one = again.tables[t], &other = data.tables[t];
    EXPECT_EQ(one.effect, other.effect);
    EXPECT_EQ(one.port, other.port);
    EXPECT_EQ(one.variable, other.variable);
    EXPECT_EQ(one.times, other.times);
    EXPECT_EQ(one.period, other.period);
    EXPECT_EQ(one.knots, other.knots);
    EXPECT_EQ(one.values_mm, other.values_mm);
    ASSERT_EQ(one.pushes.size(), other.pushes.size());
    for (std::size_t p = 0; p < other.pushes.size(); ++p) {
      EXPECT_EQ(one.pushes[p].element, other.pushes[p].element);
      EXPECT_EQ(one.pushes[p].column, other.pushes[p].column);
      EXPECT_EQ(one.pushes[p].weight, other.pushes[p].weight);
    }
  }
}

TEST(TablesInFile, WithoutTablesIsOfVersion1) {
  const std::string text = compensation_text(everything());
  EXPECT_EQ(text.find("schema = \"hexdbb.compensation/1\"\n"), 0u);
  // Version 1 has no tables.
  const std::string claimed = replaced(compensation_text(with_tables()), "compensation/2", "compensation/1");
  std::string message;
  EXPECT_EQ(fault_of(resealed(claimed), &message), CompensationFault::kMalformed);
  EXPECT_NE(message.find("no such key"), std::string::npos) << message;
}

class WrongTable : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongTable, IsRefusedByName) {
  const Wrong& wrong = GetParam();
  std::string message;
  EXPECT_EQ(fault_of(resealed(replaced(compensation_text(with_tables()), wrong.old, wrong.with)), &message),
            wrong.fault);
  EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    TablesInFile, WrongTable,
    ::testing::Values(
        Wrong{"port", "port = \"slider_joint\"", "port = \"knee\"", CompensationFault::kUnknownEffect,
              "table.1: port knee: cannot be corrected"},
        Wrong{"port_of_measurement", "port = \"slider_joint\"", "port = \"cup\"", CompensationFault::kUnknownEffect,
              "table.1: port cup"},
        Wrong{"variable", "variable = \"sliders_mm\"", "variable = \"angle_rad\"", CompensationFault::kUnknownEffect,
              "table.1: variable angle_rad: not known here"},
        Wrong{"times", "times = \"\"", "times = \"elapsed\"", CompensationFault::kUnknownEffect,
              "table.1: times elapsed: not known here"},
        Wrong{"times_position", "times = \"\"", "times = \"sliders_mm\"", CompensationFault::kUnknownEffect,
              "table.1: times sliders_mm"},
        Wrong{"times_since_reversal", "times = \"\"", "times = \"since_reversal_mm\"",
              CompensationFault::kUnknownEffect, "table.1: times since_reversal_mm"},
        Wrong{"variable_of_time", "variable = \"since_reversal_mm\"", "variable = \"since_reversal_s\"",
              CompensationFault::kUnknownEffect, "table.17: variable since_reversal_s: not known here"},
        Wrong{"table_element", "elements = [1, 2]", "elements = [1, 7]", CompensationFault::kMalformed,
              "table.1: element 7 (expected 1 to 6)"},
        Wrong{"table_element_0", "elements = [1, 2]", "elements = [0, 2]", CompensationFault::kMalformed,
              "table.1: element 0 (expected 1 to 6)"},
        Wrong{"table_column", "columns = [3, 6]", "columns = [3, 19]", CompensationFault::kMalformed,
              "table.1: column 19 (expected 1 to 18)"},
        Wrong{"table_pushes", "elements = [1, 2]", "elements = [1]", CompensationFault::kMalformed,
              "as many elements as columns and weights"},
        Wrong{"table_no_pushes", "elements = [1, 2]\ncolumns = [3, 6]\nweights = [1, 1]",
              "elements = []\ncolumns = []\nweights = []", CompensationFault::kMalformed,
              "table.1: elements: none (expected at least one)"},
        Wrong{"table_weight", "weights = [1, 1]", "weights = [1, inf]", CompensationFault::kMalformed,
              "table.1: weights: not finite"},
        Wrong{"knots_unsorted", "knots = [30, 41.25", "knots = [41.25, 30", CompensationFault::kMalformed,
              "table.1: knots: 30 after 41.25 (expected rising numbers)"},
        Wrong{"knots_twice", "knots = [30, 41.25", "knots = [30, 30", CompensationFault::kMalformed,
              "table.1: knots: 30 after 30 (expected rising numbers)"},
        Wrong{"knot_nan", "knots = [30, 41.25", "knots = [30, nan", CompensationFault::kMalformed,
              "table.1: knots: number 2 is not finite"},
        Wrong{"knot_missing", "knots = [30, 41.25", "knots = [30", CompensationFault::kMalformed,
              "table.1: 72 knots, 73 values_mm (expected as many of one as of the other)"},
        Wrong{"value_infinite", "values_mm = [", "values_mm = [-inf, ", CompensationFault::kMalformed,
              "table.1: values_mm: number 1 is not finite"},
        Wrong{"value_text", "values_mm = [", "values_mm = [x", CompensationFault::kMalformed,
              "table.1: values_mm (expected a list of numbers)"},
        Wrong{"value_huge", "values_mm = [", "values_mm = [1e999, ", CompensationFault::kMalformed,
              "values_mm (expected a list of numbers)"},
        Wrong{"list_open", "columns = [3, 6]", "columns = [3, 6", CompensationFault::kMalformed,
              "table.1: columns (expected a list of numbers)"},
        Wrong{"list_comma", "columns = [3, 6]", "columns = [3, 6, ]", CompensationFault::kMalformed,
              "table.1: columns (expected a list of numbers)"},
        Wrong{"list_fraction", "columns = [3, 6]", "columns = [3.5, 6]", CompensationFault::kMalformed,
              "table.1: columns (expected a list of numbers)"},
        Wrong{"constant_of_two", "variable = \"leg_force\"", "variable = \"\"", CompensationFault::kMalformed,
              "20 knots (expected 1 without a variable)"},
        Wrong{"variable_of_one", "variable = \"\"", "variable = \"leg_force\"", CompensationFault::kMalformed,
              "1 knots (expected at least 2)"},
        Wrong{"period_negative", "period = 0", "period = -1", CompensationFault::kMalformed, "table.1: period -1"},
        Wrong{"period_short", "period = 5", "period = 4", CompensationFault::kMalformed,
              "knots 0 to 5 (expected within 0 to the period, 4)"},
        Wrong{"table_effect", "effect = \"learned:slider_joint:sliders_mm\"", "effect = \"\"",
              CompensationFault::kMalformed, "table.1: effect: no name"},
        Wrong{"table_key", "elements = [1, 2]\n", "", CompensationFault::kMalformed, "table.1.elements: missing"},
        Wrong{"table_extra", "elements = [1, 2]\n", "elements = [1, 2]\nunit = \"mm\"\n", CompensationFault::kMalformed,
              "no such key"},
        Wrong{"table_number", "[table.2]", "[table.99]", CompensationFault::kMalformed, "no such key"}),
    [](const ::testing::TestParamInfo<Wrong>& info) { return info.param.what; });

/// Texts that nobody wrote: bytes of the tables changed, dropped, doubled and exchanged, with a correct checksum. The
/// reader accepts what is still a file, or names what is wrong in one line; it never fails in another way.
TEST(TablesInFile, NoisyTablesAreReadOrRefusedInOneLine) {
  CompensationData written = data_of(wrong_machine({"leg_length"}, 22));
  written.tables = all_tables();
  const std::string text = compensation_text(written);
  const std::size_t begin = text.find("[table.1]"), length = text.find("[left_out]") - begin;
  const std::string alphabet = "0123456789.,-+eE[]= \"\\\n#naif_";
  std::mt19937_64 random(11);
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    accepted += read_or_refused(resealed(noisy(text, begin, length, alphabet, random)));
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 1900);
}

TEST(TablesInFile, HeaderHoldsEveryTable) {
  const std::string header = compensation_header(with_tables());
  EXPECT_NE(header.find("static const int32_t hexdbb_compensation_tables_1_elements[] = {1, 2};"), std::string::npos);
  EXPECT_NE(header.find("    " + std::to_string(all_tables().size()) + ", 0, hexdbb_compensation_tables,\n"),
            std::string::npos);
  EXPECT_EQ(compensation_header(everything()).find("hexdbb_compensation_tables"), std::string::npos);
}

}  // namespace
}  // namespace hexdbb::testing
