/**
 * @file
 * What was agreed about the robot: the numbers by which outputs are judged. Whoever runs the oracle states
 * them; it never asks the kernel.
 */
#ifndef INTERLOCK_ORACLE_RULES_HPP
#define INTERLOCK_ORACLE_RULES_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace interlock::oracle {

inline constexpr std::size_t kSlots = 10;

enum class CardKind : std::uint8_t { kNone, kPwm, kNonPwm, kAnalog, kHighFrequency, kSensor };

/** End of the range at which an axis has its switch. */
enum class SwitchEnd : std::uint8_t { kNone, kLower, kUpper };

/** One slot. Distances in encoder counts, times in ticks, drive in the card's unit of spec/frames.md. */
struct AxisRules {
  CardKind card = CardKind::kNone;
  bool required = false;        /**< its loss ends motion */
  bool motor_direction = false; /**< as published: selects the sense of the direction bit */
  bool counter_falls = false;   /**< direction correction: the counter falls when the position rises */
  SwitchEnd switch_end = SwitchEnd::kNone;
  std::int32_t soft_min = 0;
  std::int32_t soft_max = 0;
  std::int32_t home_offset = 0; /**< position at the edge of the switch */
  std::int32_t coast = 0;
  std::int32_t deadband = 0;
  std::uint32_t max_drive = 0;
  std::uint32_t unhomed_max_drive = 0;
  std::uint32_t home_drive = 0;
  std::uint32_t max_amplitude = 0; /**< high-frequency cards */
  std::int32_t unhomed_travel = 0;
  std::int32_t stall_min = 0;
  std::uint32_t stall_ticks = 0;
  std::int32_t reverse = 0;
  std::int32_t drift = 0;
  std::uint32_t settle_ticks = 0;
  std::int32_t max_delta = 0; /**< a tick */
};

struct SystemRules {
  std::array<AxisRules, kSlots> axes{};
  std::uint32_t period_us = 1000;
  std::uint32_t pedal_channels = 2; /**< 1: the normally open contact alone */
  std::uint32_t app_timeout_ticks = 100;
  std::uint32_t lease_max_ticks = 100;
  std::uint32_t pedal_debounce_ticks = 10;
  std::uint32_t pedal_disagree_ticks = 50;
  std::uint32_t bad_frame_limit = 3;
  std::uint32_t overrun_limit = 3;
  std::uint32_t crc_slice_ticks = 10; /**< within which damage to the configuration is met */
};

/** True for cards that move something. */
constexpr bool has_axis(CardKind card) { return card != CardKind::kNone && card != CardKind::kSensor; }

/** True when the rules keep the maxima and relations that the specification states; a kernel that leaves INIT
 * with others breaks P13. */
bool are_permitted(const SystemRules& rules) noexcept;

}  // namespace interlock::oracle

#endif
