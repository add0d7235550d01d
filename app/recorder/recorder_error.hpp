/**
 * @file
 * How the recorder's parts fail: in words for people.
 */
#pragma once

#include <cstring>
#include <string>
#include <tl/expected.hpp>

namespace interlock::recorder {

template <typename Value>
using Recorded = tl::expected<Value, std::string>;

/** "WHAT: reason of errno NUMBER". */
inline tl::unexpected<std::string> failed_with(const std::string& what, int number) {
  return tl::unexpected(what + ": " + std::strerror(number));
}

}  // namespace interlock::recorder
