#include "modes/identification/mode.hpp"

#include "motion/realtime_channel.hpp"

namespace interlock {

IdentificationMode::IdentificationMode(const RobotPlan& plan)
    : HeldMode(typeid(IdentificationTask), plan), plan_(plan), measurement_(plan.period_us) {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    leases_[slot] = SetpointLease(slot, plan.axis[slot], plan.lease_ticks());
  }
}

std::uint32_t IdentificationMode::prepare(std::uint32_t /*tick*/) noexcept {
  const auto& task = work<IdentificationTask>();
  slot_ = task.slot;
  desired_ = {};
  measurement_.begin(plan_.axis[slot_].rules, task.range);
  return 1u << slot_;
}

void IdentificationMode::begin(const ilk_snapshot_t& /*snapshot*/) noexcept {
  desired_ = {};
  measurement_.interrupt();
}

void IdentificationMode::go_on(const ilk_snapshot_t& snapshot) noexcept {
  if (insertion_held_ && plan_.insertion_slot == slot_) {
    begin(snapshot);
    wait_for(TaskReason::breathing);
    return;
  }
  wait_for(TaskReason::none);
  const std::uint32_t now = snapshot.state.system.tick;
  const ilk_axis_t& axis = snapshot.state.axis[slot_];
  // A lease runs down from the tick in which the kernel took it.
  const std::uint32_t leased_for = leases_[slot_].ticks() - axis.lease_ticks;
  desired_ = measurement_.see({now, axis.position_counts, snapshot.command[slot_].drive, now - leased_for});
  set_step(measurement_.step());
  switch (measurement_.state()) {
    case AxisMeasurement::State::measures:
      break;
    case AxisMeasurement::State::done:
      finish(TaskReason::measured, now);
      break;
    case AxisMeasurement::State::stands:
      fail(TaskReason::axis_stands, 0, slot_, now);
      break;
    case AxisMeasurement::State::held_back:
      fail(TaskReason::blocked, snapshot.gate[slot_], slot_, now);
      break;
  }
}

void IdentificationMode::drive(const ilk_snapshot_t& snapshot, KernelRequests& requests) noexcept {
  for (std::uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (slot == slot_ && executes()) {
      leases_[slot].hold(status().task, snapshot.state.system.tick, desired_.target_counts, desired_.drive,
                         requests);
    } else {
      leases_[slot].let_go(status().task, snapshot, requests);
    }
  }
}

void IdentificationMode::report(ControlView& view) const noexcept {
  HeldMode::report(view);
  view.measured = measurement_.found();
}

void IdentificationMode::on_unsent(const KernelRequest& request) noexcept {
  if (request.origin.task == status().task && request.origin.slot < ILK_SLOTS) {
    leases_[request.origin.slot].on_unsent();
  }
}

}  // namespace interlock
