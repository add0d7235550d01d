/**
 * @file
 * From the speed that a controller wants to the drive that the kernel takes, and back.
 *
 * Drive is a magnitude from 0 to `max_drive` for every card; the kernel packs it into the card's words and
 * picks the direction itself. By card:
 *
 *     PWM, NON_PWM, ANALOG   drive = dead_zone + |v| / full_speed (max_drive - dead_zone)
 *     HIGH_FREQUENCY         |v| in revolutions per minute -> frequency word of that direction -> drive
 *
 * The resonance of a motor that is driven by frequency moves with its warmth, its load and from one motor to
 * the next, and its whole speed map with it.
 * It begins where the rules have it. By how much it moved shows in the frequency at which the published map
 * has the measured speed: the map follows it (`follow`).
 *
 * The three linear cards differ in the word that the kernel builds, not in the drive. A speed other than zero
 * gives at least `min_drive`, so that the axis moves; what is too fast gives `max_drive`: clamped, not masked
 * as in the published listing, where 0xEFFF loses a bit.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "control/control_error.hpp"
#include "interlock/types.h"

namespace interlock {

/** What the map of one axis is made from. */
struct DriveMapRules {
  ilk_card_t card = ILK_CARD_NONE;
  bool motor_direction = true; /**< as in the robot file; chooses the column of the published map */
  std::uint32_t max_drive = 0;
  std::uint32_t min_drive = 0;          /**< smallest drive that moves the axis */
  double dead_zone_drive = 0.0;         /**< linear cards: up to it nothing moves; 0 leaves it to the
                                             integral */
  double full_speed_counts_per_s = 0.0; /**< linear cards: at `max_drive` */
  double counts_per_revolution = 0.0;   /**< HIGH_FREQUENCY: of the motor in the published map */
  double resonance_hz = 0.0;            /**< HIGH_FREQUENCY: of the motor, above the published map */
};

/** From a wanted speed to the drive word of a card. */
class DriveMap {
 public:
  /** Refused for a card without a motor, a `min_drive` above `max_drive` and speeds that are not above 0. */
  static ControlResult<DriveMap> create(const DriveMapRules& rules) noexcept;

  /** The drive for a speed, positive towards larger positions. Zero for zero and for what is no number. */
  [[nodiscard]] std::uint32_t drive(double counts_per_s) const noexcept;

  /** Speed of the axis at a drive, with the sign of `direction`; a drive above `max_drive` counts as that. */
  [[nodiscard]] double speed(std::uint32_t drive, int direction) const noexcept;

  /**
   * Follows the resonance of a HIGH_FREQUENCY motor; nothing happens with other cards. Once every period:
   * `drive` as it was given for this one, zero drive included, and the speed as measured, if it is known.
   */
  void follow(std::uint32_t drive, std::optional<double> counts_per_s, double elapsed_s) noexcept;

  /** What the axis reaches in both directions. */
  [[nodiscard]] double full_speed() const noexcept;

 private:
  explicit DriveMap(const DriveMapRules& rules) noexcept : rules_(rules), shift_words_(stated_words()) {}

  [[nodiscard]] double stated_words() const noexcept;
  [[nodiscard]] double frequency_drive(double counts_per_s) const noexcept;
  [[nodiscard]] double frequency_speed(std::uint32_t drive, bool decreasing) const noexcept;

  DriveMapRules rules_;
  std::optional<double> driven_words_; /**< frequency word of the drive, as late as the speed is measured */
  double driven_s_ = 0.0;              /**< for so long */
  double shift_words_;                 /**< of the map, from the published one */
};

}  // namespace interlock
