/**
 * @file
 * What a controller says in place of an output. Everything in this folder either answers or returns one of
 * these.
 */
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace interlock {

/** A number that no controller can work with. */
struct ControlError {
  /** Kinds of refusal. */
  enum class Code : std::uint8_t {
    not_finite,   /**< NaN or infinity, given or computed */
    out_of_range, /**< a rule or gain beyond where it means something */
  };

  Code code = Code::not_finite;
  std::string_view quantity; /**< a literal: "velocity gain" */

  /** One line for people: "velocity gain is out of range". */
  [[nodiscard]] std::string message() const;

  bool operator==(const ControlError&) const = default;
};

/** A value, or why the controllers refuse. */
template <typename Value>
using ControlResult = tl::expected<Value, ControlError>;

/** Nothing, when `value` is finite and within both ends. `quantity` is a literal. */
ControlResult<void> require_within(std::string_view quantity, double value, double lowest,
                                   double highest) noexcept;

}  // namespace interlock
