/**
 * @file
 * Generated from spec/catalog.toml by `make generate`. Do not edit.
 *
 * The texts of every code that an operator, a client or a log meets, by family and number.
 * The numbers themselves are the enumerations of interlock/catalog.h.
 */
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace interlock::catalog {

/** Families of codes, in the order of the catalog. */
enum class Family : std::uint8_t {
  mode, /**< System modes. */
  axis_state, /**< States of an axis. */
  request, /**< Requests of the app. `fields` are read by the kernel; `checks` are the verdicts that can refuse it, in order, after CHECKSUM, SEQUENCE, UNKNOWN and AXIS. */
  verdict, /**< The one answer to a request. */
  cause, /**< Why the system is LOCKED. */
  fault, /**< Why an axis is FAULTED. */
  gate, /**< The conditions between a wish and a driven axis, in the order in which they are checked. The first that does not hold blocks. */
  config_error, /**< The first rule that a refused configuration breaks. */
  card, /**< Kinds of motor cards. */
  limit_side, /**< The end of the axis at which its switch sits. */
  direction, /**< Sense of motion, as the position counts. */
  homing_phase, /**< Phases of homing. */
  homed, /**< How the position of an axis came to be known. */
  pedal, /**< What the pedal's channels say together. */
  lamp, /**< Lamps of the front panel. */
  colour, /**< Colours of a lamp. */
};

/** One code. Texts that a family does not carry are empty. */
struct Entry {
  std::uint32_t number;
  std::string_view name;
  std::string_view meaning;
  std::string_view cause;
  std::string_view next_step;
  std::string_view clears;
  std::span<const std::string_view> properties; /**< identifiers such as "P3" */
};

/** Every code of the family, by rising number. */
[[nodiscard]] std::span<const Entry> entries(Family family) noexcept;

/** The code of that number, or nullptr when the family has none. */
[[nodiscard]] const Entry* find(Family family, std::uint32_t number) noexcept;

/** The code of that name, or nullptr when the family has none. */
[[nodiscard]] const Entry* find(Family family, std::string_view name) noexcept;

/** The code of that number, or a safe entry named "UNKNOWN" that tells the operator what to do. */
[[nodiscard]] const Entry& entry(Family family, std::uint32_t number) noexcept;

/** The code's name, or "UNKNOWN_<number>". */
[[nodiscard]] std::string name(Family family, std::uint32_t number);

}  // namespace interlock::catalog
