// The compensation file: nothing lost in a round trip, nothing wrong accepted.
#include <gtest/gtest.h>

#include <fstream>

#include "compensation_texts.hpp"

namespace hexdbb::testing {
namespace {

TEST(CompensationFile, ReadsAsTheSameBits) {
  const CompensationData data = everything();
  const std::string text = compensation_text(data);
  const CompensationData again = parse_compensation(text, "a.hexcomp");
  EXPECT_EQ(compensation_text(again), text);
  ASSERT_EQ(again.effects.size(), data.effects.size());
  for (std::size_t e = 0; e < data.effects.size(); ++e) {
    EXPECT_EQ(again.effects[e].name, data.effects[e].name);
    ASSERT_EQ(again.effects[e].values.size(), data.effects[e].values.size());
    for (std::size_t v = 0; v < data.effects[e].values.size(); ++v) {
      EXPECT_EQ(again.effects[e].values[v].value, data.effects[e].values[v].value);
      EXPECT_EQ(again.effects[e].values[v].element, data.effects[e].values[v].element);
      EXPECT_EQ(again.effects[e].values[v].parameter, data.effects[e].values[v].parameter);
    }
  }
  EXPECT_EQ(again.left_out.size(), data.left_out.size());
  EXPECT_TRUE(is_same_machine(again.machine, data.machine));
  EXPECT_EQ(again.name, "SP-120 \"left\" \\ hall 2 ");
  EXPECT_EQ(again.model_sha256, data.model_sha256);
  EXPECT_EQ(again.reference_temperature_c, data.reference_temperature_c);
}

TEST(CompensationFile, ChecksumIsTheStandardOne) { EXPECT_EQ(crc32("123456789"), 0xcbf43926u); }

TEST(CompensationFile, CutShortAnywhereIsTruncated) {
  const std::string text = compensation_text(with_tables());
  for (std::size_t length = 0; length < text.size(); ++length) {
    ASSERT_EQ(fault_of(text.substr(0, length)), CompensationFault::kTruncated) << length;
  }
}

TEST(CompensationFile, AnyByteChangedIsRefused) {
  for (const std::string& each : {compensation_text(everything()), compensation_text(with_tables())}) {
    for (std::size_t at = 0; at < each.size(); at += each.size() < 10000 ? 1 : 37) {
      std::string other = each;
      other[at] = static_cast<char>(other[at] ^ 1);
      ASSERT_NE(fault_of(other), CompensationFault::kNone) << at;
    }
  }
  const std::string text = compensation_text(everything());
  EXPECT_EQ(fault_of(replaced(text, "1.longer = ", "1.longer = -")), CompensationFault::kAltered);
  EXPECT_EQ(fault_of(text + "\n"), CompensationFault::kAltered);
}

/// As `TablesInFile.NoisyTablesAreReadOrRefusedInOneLine`, for all parts of a file and with bytes that are no text. Half
/// of the texts have a correct checksum, as another program would write it.
TEST(CompensationFile, NoiseIsReadOrRefusedInOneLine) {
  const std::string text = compensation_text(data_of(wrong_machine(kGeometricNames, 23)));
  std::string alphabet = "0123456789.,-+eE[]= \"\\\n\r\t#naif_\x1b\x7f\x80\xff";
  alphabet.push_back('\0');
  std::mt19937_64 random(12);
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::string other = noisy(text, 0, text.size(), alphabet, random);
    accepted += read_or_refused(trial % 2 ? resealed(other) : other);
  }
  EXPECT_GT(accepted, 20);
  EXPECT_LT(accepted, 1000);
}

TEST(CompensationFile, ALaterVersionIsNamed) {
  std::string message;
  const std::string text = replaced(compensation_text(everything()), "compensation/1", "compensation/4");
  EXPECT_EQ(fault_of(resealed(text), &message), CompensationFault::kLaterVersion);
  EXPECT_EQ(message, "a.hexcomp: of a later version: hexdbb.compensation/4 (expected at most 3)");
}

TEST(CompensationFile, OfAnotherMachineIsNamed) {
  const std::string path = ::testing::TempDir() + "other_machine.hexcomp";
  std::ofstream(path) << compensation_text(everything());
  Machine ours;
  EXPECT_NO_THROW(load_compensation(path, ours));
  ours.leg_length_mm = six_of(401.0);
  try {
    load_compensation(path, ours);
    FAIL();
  } catch (const CompensationError& error) {
    EXPECT_EQ(error.fault(), CompensationFault::kOtherMachine);
    EXPECT_EQ(std::string(error.what()), path + ": of another machine: leg_length_mm is 400 (expected 401)");
  }
}

TEST(CompensationFile, ThatDoesNotExistIsNamed) {
  try {
    load_compensation("/no/such/file.hexcomp");
    FAIL();
  } catch (const CompensationError& error) {
    EXPECT_EQ(error.fault(), CompensationFault::kCannotRead);
  }
}

class WrongContent : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongContent, IsRefusedByName) {
  const Wrong& wrong = GetParam();
  std::string message;
  EXPECT_EQ(fault_of(resealed(replaced(compensation_text(everything()), wrong.old, wrong.with)), &message),
            wrong.fault);
  EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    CompensationFile, WrongContent,
    ::testing::Values(
        Wrong{"effect", "[effect.leg_length]", "[effect.leg_lengths]", CompensationFault::kUnknownEffect,
              "effect.leg_lengths: no such effect"},
        Wrong{"setup", "[effect.leg_length]", "[effect.ball_offset]", CompensationFault::kUnknownEffect,
              "effect.ball_offset: belongs to the measurement"},
        Wrong{"element", "1.longer", "7.longer", CompensationFault::kUnknownEffect, "no value 7.longer"},
        Wrong{"parameter", "1.longer", "1.shorter", CompensationFault::kUnknownEffect, "no value 1.shorter"},
        Wrong{"missing_value", "1.longer", "# 1.longer", CompensationFault::kMalformed, "expected 6 values"},
        Wrong{"twice", "2.longer", "1.longer", CompensationFault::kMalformed, "expected every key once"},
        Wrong{"number", "1.longer = ", "1.longer = x", CompensationFault::kMalformed, "expected a finite number"},
        Wrong{"infinite", "leg_length_mm = 400", "leg_length_mm = inf", CompensationFault::kMalformed, "finite number"},
        Wrong{"impossible", "leg_length_mm = 400", "leg_length_mm = 40", CompensationFault::kMalformed,
              "can be assembled"},
        Wrong{"no_limit", "max_correction_mm = 2", "max_correction_mm = 0", CompensationFault::kMalformed, "above 0"},
        Wrong{"missing_key", "leg_length_mm = 400\n", "", CompensationFault::kMalformed, "leg_length_mm: missing"},
        Wrong{"unknown_key", "[limits]", "speed = 1\n[limits]", CompensationFault::kMalformed, "no such key"},
        Wrong{"no_string", "model_sha256 = \"", "model_sha256 = ", CompensationFault::kMalformed, "expected a string"},
        Wrong{"no_equals", "[limits]", "limits", CompensationFault::kMalformed, "key = value"},
        Wrong{"schema", "hexdbb.compensation", "hexdbb.machine", CompensationFault::kMalformed, "not a compensation"},
        Wrong{"spike", "[effect.leg_length]\n", "[effect.reversal_spike]\n", CompensationFault::kUnknownEffect,
              "no value 1.longer"}),
    [](const ::testing::TestParamInfo<Wrong>& info) { return info.param.what; });

TEST(CompensationFile, AnEffectThatNoControllerKnowsIsRefusedBeforeItIsEvaluated) {
  CompensationData data = everything();
  data.effects = {{"joint_friction", {}}};
  for (int k = 1; k <= kLegs; ++k) data.effects[0].values.push_back({std::to_string(k), "deflection", 0.01});
  try {
    Compensator compensator(data, "a.hexcomp");
    FAIL();
  } catch (const CompensationError& error) {
    EXPECT_EQ(error.fault(), CompensationFault::kUnknownEffect);
  }
}

TEST(CompensationFile, HeaderHoldsEveryValue) {
  const CompensationData data = everything();
  const std::string header = compensation_header(data);
  std::size_t values = 0;
  for (const CompensatedEffect& effect : data.effects) {
    for (const CompensationValue& value : effect.values) {
      const std::string line = "{\"" + effect.name + "\", \"" + value.element + "\", \"" + value.parameter + "\", ";
      EXPECT_NE(header.find(line), std::string::npos) << line;
      ++values;
    }
  }
  EXPECT_NE(header.find("    " + std::to_string(values) + ", /* values */"), std::string::npos);
}

TEST(CompensationFile, RecordsOfTheModelAreReadBackFromTheirComments) {
  CompensationData data = everything();
  data.record_sha256 = {"0123abcd", "a \"quoted\" one"};
  const CompensationData again = parse_compensation(compensation_text(data), "a.hexcomp");
  EXPECT_EQ(again.record_sha256, data.record_sha256);
  EXPECT_NE(compensation_header(again).find("0123abcd"), std::string::npos);
}

TEST(CompensationFile, NoNameLeavesTheCommentOfTheHeader) {
  CompensationData data = everything();
  for (const std::string name :
       {"x */ int evil = 1; /*", "x *\\\n/ int evil = 1; /*", "*\n/ int evil = 1;", "x \\", "\xc2"}) {
    data.name = data.model_sha256 = name;
    data.record_sha256 = {name};
    const std::string header = compensation_header(data);
    const std::size_t end = header.find("*/");
    EXPECT_EQ(header.compare(end, 32, "*/\n#ifndef HEXDBB_COMPENSATION_C"), 0) << name;
    EXPECT_EQ(header.substr(2, end).find("/*"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace hexdbb::testing
