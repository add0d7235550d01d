/**
 * @file
 * What ends a task whatever it wanted: a locked kernel, or an axis out of motion.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "interlock/link.h"
#include "motion/task.hpp"

namespace interlock {

struct Obstacle {
  TaskReason reason = TaskReason::none;
  std::uint32_t code = 0;
  std::uint32_t slot = 0; /**< of the axis in the way */
};

/** What keeps the axis from being moved by anybody; an axis that is homing is none. */
std::optional<Obstacle> obstacle_of(const ilk_snapshot_t& snapshot, std::uint32_t slot) noexcept;

}  // namespace interlock
