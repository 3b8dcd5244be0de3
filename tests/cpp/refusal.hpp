// Message with which a call is refused.
#pragma once

#include <stdexcept>
#include <string>

namespace hexdbb::testing {

/// Return the text of the std::invalid_argument that `call` throws; empty where it throws nothing.
template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace hexdbb::testing
