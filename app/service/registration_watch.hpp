/**
 * @file
 * Watches the axes on whose positions a registration rests: those that play a role in the kinematics.
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "robot/robot.hpp"

namespace interlock {

/** Sees when the position of an axis ceases to mean what it meant. */
class RegistrationWatch {
 public:
  /** Both must outlive it. */
  RegistrationWatch(const Robot& robot, const ilk_config_t& config);

  /** Looks at the newest view. Why a registration has expired by what it shows, as a sentence; empty: nothing
   * of that kind. Homing that finds the switch where it was expires none. */
  std::string see(const ControlView& view);

 private:
  struct Watched {
    const Axis* axis;
    std::optional<std::uint32_t> homed = std::nullopt; /**< as it was seen last */
    std::uint32_t last_origin = 0; /**< where its counter stands at position 0, as it was seen last */
    std::uint32_t origin = 0;      /**< since when nothing has expired */
    bool is_rehomed = false;       /**< it was homed, and homes again */
  };

  std::string look(Watched& watched, const ilk_axis_t& now) const;

  const ilk_config_t& config_;
  std::vector<Watched> axes_;
};

}  // namespace interlock
