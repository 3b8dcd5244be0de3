// Compensation data of a motion controller: in memory, as a text file, and as a C header of constants.
//
// A file is a subset of TOML: sections, numbers, strings, comments. It ends with the CRC-32 (IEEE 802.3) of every byte
// above its [check] section, by which a truncated or edited file is detected. Numbers are in the engine's units (mm,
// rad, s, N, K) and are written with as many digits as restore the same bits.
//
// Version 1 holds effects of the catalogue by name and value. Version 2 adds tables (compensation_tables.hpp); data
// without a table are written as version 1, which earlier readers take. The records that the model was fitted to stand in
// comments, because readers of both versions refuse keys that they do not know.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "hexdbb/compensation_tables.hpp"
#include "hexdbb/prediction.hpp"

namespace hexdbb {

/// Limits of a compensator.
struct CompensationLimits {
  double max_correction_mm = 1.0;    // of one slider; a pose that needs more is refused
  double reversal_travel_mm = 0.01;  // over which a correction changes with the direction of travel
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
  std::string name;                        // of the machine
  std::string model_sha256;                // of the model file it was made from
  std::vector<std::string> record_sha256;  // of the records that the model's values were fitted to
  double reference_temperature_c = std::numeric_limits<double>::quiet_NaN();  // at which no growth is corrected
  Machine machine;
  CompensationLimits limits;
  std::vector<CompensatedEffect> effects;
  std::vector<CompensationTable> tables;
  std::vector<LeftOut> left_out;
};

/// Reason for which compensation data are refused; the numbers of hexdbb.h.
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

/// Its message is one line: the source's name, what is wrong, what was expected.
class CompensationError : public std::runtime_error {
 public:
  CompensationError(CompensationFault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}
  CompensationFault fault() const noexcept { return fault_; }

 private:
  CompensationFault fault_;
};

/// Select the effects of a model that can be compensated, with a reason for each that cannot. An effect can be
/// compensated where it pushes sliders, legs or joints and depends on pose, slider position, direction of travel,
/// velocity, load or measured temperature (the latter only where `reference_temperature_c`, that of the record's first
/// sample, is a number). `tables` are those of effects that the engine does not have; an effect of which one table cannot
/// be compensated is left out as a whole.
CompensationData compensation_of(const Model& model, const std::string& name, const std::string& model_sha256,
                                 const CompensationLimits& limits, double reference_temperature_c,
                                 const std::vector<CompensationTable>& tables = {});

/// Return the text of a compensation file.
std::string compensation_text(const CompensationData& data);

/// Return a C header that holds the data as a hexdbb_constants named hexdbb_compensation.
std::string compensation_header(const CompensationData& data);

/// Parse the text of a compensation file; messages name it by `source`. Throws CompensationError.
CompensationData parse_compensation(const std::string& text, const std::string& source);

/// Read a compensation file. Throws CompensationError.
CompensationData read_compensation(const std::string& path);

/// Return whether a machine of these dimensions can be assembled.
bool is_possible(const Machine& machine) noexcept;

/// Return whether no dimension differs by more than 1e-9 of its size.
bool is_same_machine(const Machine& one, const Machine& other) noexcept;

/// Throw CompensationError (kOtherMachine), naming the first dimension that differs, unless the machines are the same.
void require_machine(const Machine& of_data, const Machine& of_controller, const std::string& source);

/// Throw CompensationError unless every table can be evaluated: port and variable known (kUnknownEffect), elements and
/// columns in range, counts that agree, finite numbers, rising knots (kMalformed).
void require_tables(const std::vector<CompensationTable>& tables, const std::string& source);

/// Return the model of the data: the machine and its effects with their values, tables checked but not in it. Throws
/// CompensationError (kUnknownEffect, kMalformed).
Model compensation_model(const CompensationData& data, const std::string& source);

/// Compute the CRC-32 (IEEE 802.3, as in zlib).
std::uint32_t crc32(const std::string& bytes) noexcept;

}  // namespace hexdbb
