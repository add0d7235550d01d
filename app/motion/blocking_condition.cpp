#include "motion/blocking_condition.hpp"

namespace interlock {

std::optional<BlockingCondition> blocking_condition(const ilk_snapshot_t& snapshot,
                                                    std::uint32_t slot) noexcept {
  const ilk_axis_t& axis = snapshot.state.axis[slot];
  if (snapshot.state.system.mode != ILK_MODE_READY && snapshot.state.system.mode != ILK_MODE_MOTION) {
    return BlockingCondition{TaskReason::locked, snapshot.state.system.cause, slot};
  }
  switch (axis.state) {
    case ILK_AXIS_ENABLED:
    case ILK_AXIS_MOVING:
    case ILK_AXIS_HOMING:
      return std::nullopt;
    case ILK_AXIS_FAULTED:
      return BlockingCondition{TaskReason::axis_faulted, axis.fault, slot};
    default:
      return BlockingCondition{TaskReason::axis_disabled, 0, slot};
  }
}

}  // namespace interlock
