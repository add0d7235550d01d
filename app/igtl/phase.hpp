/**
 * @file
 * The workphases of a needle placement, by which the protocol of the prostate robots is told apart.
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace interlock::igtl {

enum class Phase : std::uint8_t {
  undefined, /**< after connecting */
  start_up,
  planning,
  calibration,
  targeting,
  move_to_target,
  manual,
  stop,
  emergency
};

/** As it travels: "MOVE_TO_TARGET". */
std::string_view phase_name(Phase phase) noexcept;

/** The phase that a request names, exactly as `phase_name` spells it; "UNDEFINED" cannot be asked for. */
std::optional<Phase> requested_phase(std::string_view name) noexcept;

}  // namespace interlock::igtl
