// Compensation data: what a motion controller loads, as data in memory, as a text file, and as a C header of constants.
//
// A file is a small part of TOML, written and read here alone: sections, numbers, strings, comments. It ends with the
// CRC-32 (IEEE 802.3) of every byte above its [check] section, so that a file that was cut short or changed by hand is
// told apart from a good one. Numbers are in the engine's units (mm, rad, s, N, K) and written so that reading gives
// the same bits again.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// What a compensator may do.
struct CompensationLimits {
  double max_correction_mm = 1.0;    // of one slider; a pose that needs more is refused
  double reversal_travel_mm = 0.01;  // over which what depends on direction goes from one side to the other
};

struct CompensationValue {
  std::string element;    // "1" .. "6", "12"
  std::string parameter;  // "longer"
  double value;           // engine units
};

struct CompensatedEffect {
  std::string name;
  std::vector<CompensationValue> values;
};

struct LeftOut {
  std::string effect;
  std::string reason;
};

struct CompensationData {
  std::string name;                                                           // of the machine
  std::string model_sha256;                                                   // of the model file it was made from
  double reference_temperature_c = std::numeric_limits<double>::quiet_NaN();  // at which no growth is corrected
  Machine machine;
  CompensationLimits limits;
  std::vector<CompensatedEffect> effects;
  std::vector<LeftOut> left_out;
};

/// Why compensation data are refused; the numbers of hexdbb.h.
enum class CompensationFault : int {
  kNone = 0,
  kCannotRead = 20,
  kMalformed = 21,
  kTruncated = 22,
  kAltered = 23,
  kLaterVersion = 24,
  kOtherMachine = 25,
  kUnknownEffect = 26,
};

/// One line: the source's name, what is wrong, what was expected.
class CompensationError : public std::runtime_error {
 public:
  CompensationError(CompensationFault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}
  CompensationFault fault() const noexcept { return fault_; }

 private:
  CompensationFault fault_;
};

/// What of a model can be compensated, and why the rest cannot: an effect that pushes sliders, legs or joints and
/// depends on pose, slider position, direction, velocity, load or measured temperature (the latter only where
/// `reference_temperature_c`, that of the record's first sample, is a number).
CompensationData compensation_of(const Model& model, const std::string& name, const std::string& model_sha256,
                                 const CompensationLimits& limits, double reference_temperature_c);

/// The text of a file.
std::string compensation_text(const CompensationData& data);

/// A C header that holds the data as a hexdbb_constants called hexdbb_compensation.
std::string compensation_header(const CompensationData& data);

/// Throws CompensationError; `source` is how messages name the text.
CompensationData parse_compensation(const std::string& text, const std::string& source);

/// Throws CompensationError.
CompensationData read_compensation(const std::string& path);

/// Whether such a machine can stand at all.
bool is_possible(const Machine& machine) noexcept;

/// Whether no dimension differs by more than 1e-9 of its size.
bool is_same_machine(const Machine& one, const Machine& other) noexcept;

/// Throws CompensationError (kOtherMachine) naming the first dimension that differs.
void require_machine(const Machine& of_data, const Machine& of_controller, const std::string& source);

/// Model of the data: the machine and its effects with their values. Throws CompensationError (kUnknownEffect,
/// kMalformed).
Model compensation_model(const CompensationData& data, const std::string& source);

/// CRC-32 (IEEE 802.3, as in zlib).
std::uint32_t crc32(const std::string& bytes) noexcept;

}  // namespace hexdbb
