// What each kind of fault does to plant, inputs, app and memory, and by when it has to have stopped the
// drive.
#include <algorithm>
#include <span>

#include "flip.hpp"
#include "world.hpp"

namespace interlock::campaign {
namespace {

namespace command = plant::command;

constexpr std::uint32_t kPairTicks = 4; /**< in which two faults that begin are a pair */
constexpr std::uint32_t kEdgeTicks = 2; /**< from a contact or a frame to zero drive on the wire */

std::int32_t signed_amount(const Fault& fault, std::uint32_t most) {
  const auto size = static_cast<std::int32_t>(1 + (fault.amount >> 1) % most);
  return (fault.amount & 1) != 0 ? size : -size;
}

bool sense_of(const Fault& fault) { return (fault.amount & 1) != 0; }

}  // namespace

void World::demand(std::uint32_t within, int axis, FaultKind kind) {
  clock_.demand(tick_ + within, axis, name_of(kind));
}

bool World::is_due(const Fault& fault) const {
  if (fault.driven_ticks > 0) {
    return is_driven_ && driven_ticks_ == fault.driven_ticks;
  }
  if (fault.kind == FaultKind::kConfigBitFlips) {
    // Not while deadlines are missed: by when that has to stop the drive may rest on the bit.
    return overrun_ticks_ == 0 && (is_driven_ || tick_ >= fault.tick + kFlipPatience);
  }
  return true;
}

void World::inject_what_is_due() {
  while (next_fault_ < plan_.faults.size() && plan_.faults[next_fault_].tick <= tick_) {
    const Fault& fault = plan_.faults[next_fault_++];
    if (fault.driven_ticks == 0 && is_due(fault)) {
      inject(fault);
    } else {
      waiting_.push_back(fault);
    }
  }
  // Of stops that wait for the same tick of a press one has a press for itself.
  bool stops = false;
  std::erase_if(waiting_, [&](const Fault& fault) {
    const bool is_stop = fault.driven_ticks > 0;
    const bool due = is_due(fault) && !(is_stop && stops);
    if (due) {
      inject(fault);
      stops = stops || is_stop;
    }
    return due;
  });
}

void World::note_swept_tick(FaultKind kind) {
  if (!is_driven_ || driven_ticks_ == 0 || driven_ticks_ > kMoveTicks) {
    return;
  }
  if (kind == FaultKind::kEstopPulled) {
    totals_.estop_ticks.set(driven_ticks_ - 1);
  } else if (kind == FaultKind::kPedalReleased) {
    totals_.pedal_ticks.set(driven_ticks_ - 1);
  }
}

/** Bits of the configuration come in their order and not by chance: they are no part of a pair. */
void World::note_pairs(FaultKind kind) {
  if (kind == FaultKind::kConfigBitFlips) {
    return;
  }
  std::erase_if(newest_faults_, [this](const auto& each) { return tick_ - each.first >= kPairTicks; });
  for (const auto& [tick, other] : newest_faults_) {
    const auto lower = static_cast<std::size_t>(std::min(kind, other));
    const auto higher = static_cast<std::size_t>(std::max(kind, other));
    totals_.kind_pairs.set(lower * kFaultKinds + higher);
  }
  newest_faults_.emplace_back(tick_, kind);
}

void World::inject(const Fault& fault) {
  totals_.faults_injected++;
  note_swept_tick(fault.kind);
  note_pairs(fault.kind);
  totals_.faults_by_kind[static_cast<std::size_t>(fault.kind)]++;
  switch (fault.kind) {
    case FaultKind::kPedalReleased:
    case FaultKind::kPedalBounces:
    case FaultKind::kPedalHalfPressed:
    case FaultKind::kPedalStuck:
    case FaultKind::kPedalUndefined:
      inject_pedal(fault);
      break;
    case FaultKind::kEstopPulled:
      act(command::PullEstop{true});
      act(command::PullEstop{false}, fault.ticks);
      demand(kEdgeTicks, kNoAxis, fault.kind);
      break;
    case FaultKind::kEstopUndefined:
      undefined_estop_ticks_ = std::max(undefined_estop_ticks_, fault.ticks);
      demand(kEdgeTicks, kNoAxis, fault.kind);
      break;
    case FaultKind::kFrameCorrupt:
    case FaultKind::kFrameDropped:
    case FaultKind::kFrameLate:
    case FaultKind::kFrameRepeated:
    case FaultKind::kCardDeaf:
    case FaultKind::kCardReset:
    case FaultKind::kCardUnplugged:
    case FaultKind::kTransactionFails:
      inject_card(fault);
      break;
    case FaultKind::kEncoderStuck:
    case FaultKind::kEncoderJumps:
    case FaultKind::kEncoderSlips:
    case FaultKind::kEncoderReversed:
    case FaultKind::kAxisDrifts:
    case FaultKind::kAxisJammed:
    case FaultKind::kAxisRunsAway:
    case FaultKind::kAxisPushed:
      inject_axis(fault);
      break;
    case FaultKind::kSwitchStuckOpen:
    case FaultKind::kSwitchStuckClosed:
    case FaultKind::kSwitchBounces:
      inject_switch(fault);
      break;
    case FaultKind::kAppSilent:
    case FaultKind::kAppLies:
    case FaultKind::kAppFloods:
    case FaultKind::kAppAttachesAnew:
    case FaultKind::kOtherHolder:
      inject_app(fault);
      break;
    case FaultKind::kClockOverruns:
      overrun_ticks_ = std::max(overrun_ticks_, fault.ticks);
      for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
        break_promise(slot, fault.ticks);
      }
      if (fault.ticks >= robot_.config.common.overrun_limit) {
        // The limit itself may be the damaged word: then the damage stops the drive, in its own time.
        const std::uint32_t until_met = config_damage_left_ > 0 ? met_within(config_bit_) : 0;
        demand(std::max(robot_.config.common.overrun_limit, until_met), kNoAxis, fault.kind);
      }
      break;
    case FaultKind::kStateBitFlips:
    case FaultKind::kConfigBitFlips:
      inject_memory(fault);
      break;
  }
}

bool World::another_holds_the_pedal() const {
  const auto upcoming = std::span(plan_.faults).subspan(next_fault_);
  return tick_ < pedal_held_until_ || std::ranges::any_of(
                                          upcoming,
                                          [this](const Fault& fault) {
                                            const bool holds = fault.kind == FaultKind::kPedalStuck ||
                                                               fault.kind == FaultKind::kPedalBounces ||
                                                               fault.kind == FaultKind::kPedalHalfPressed;
                                            return holds && fault.tick <= tick_ + kEdgeTicks;
                                          });
}

void World::inject_pedal(const Fault& fault) {
  const bool two_channels = robot_.config.common.pedal_channels == 2;
  const bool normally_open = !two_channels || sense_of(fault);
  // A contact that another fault holds may read pressed whatever this one does.
  if (fault.kind != FaultKind::kPedalStuck && fault.kind != FaultKind::kPedalUndefined &&
      !another_holds_the_pedal()) {
    demand(kEdgeTicks, kNoAxis, fault.kind);
  }
  switch (fault.kind) {
    case FaultKind::kPedalReleased:
      app_.lift_foot(fault.ticks);
      return;
    case FaultKind::kPedalBounces:
      for (std::uint32_t tick = 0; tick < fault.ticks; tick++) {
        act(command::StickPedalContact{normally_open, tick % 2 == 0 ? !normally_open : normally_open}, tick);
      }
      break;
    case FaultKind::kPedalHalfPressed:
      act(command::StickPedalContact{normally_open, !normally_open});
      break;
    case FaultKind::kPedalStuck:
      act(command::StickPedalContact{normally_open, normally_open});
      break;
    default:
      undefined_pedal_ticks_ = std::max(undefined_pedal_ticks_, fault.ticks);
      return;
  }
  act(command::StickPedalContact{normally_open, std::nullopt}, fault.ticks);
  pedal_held_until_ = std::max(pedal_held_until_, tick_ + fault.ticks + 1);
}

void World::inject_card(const Fault& fault) {
  const auto spoil = [&](plant::FrameFault kind) {
    act(command::SpoilFrames{fault.slot, kind, fault.ticks});
  };
  switch (fault.kind) {
    case FaultKind::kFrameCorrupt:
      spoil(plant::FrameFault::kCorrupt);
      break;
    case FaultKind::kFrameDropped:
      spoil(plant::FrameFault::kDrop);
      break;
    case FaultKind::kFrameLate:
      spoil(plant::FrameFault::kDelay);
      break;
    case FaultKind::kFrameRepeated:
      spoil(plant::FrameFault::kRepeat);
      break;
    case FaultKind::kCardDeaf:
      // A deaf card drives on until its own watchdog stops it.
      spoil(plant::FrameFault::kDeaf);
      break_promise(fault.slot, fault.ticks);
      break;
    case FaultKind::kCardReset:
      act(command::ResetCard{fault.slot});
      break_promise(fault.slot, 1);
      break;
    case FaultKind::kCardUnplugged:
      act(command::PowerCard{fault.slot, false});
      act(command::PowerCard{fault.slot, true}, fault.ticks);
      break_promise(fault.slot, fault.ticks);
      demand(kEdgeTicks, static_cast<int>(fault.slot), fault.kind);
      return;
    default:
      act(command::FailTransactions{fault.ticks});
      failing_ticks_ = fault.ticks;
      for (std::size_t slot = 0; slot < ILK_SLOTS; slot++) {
        break_promise(slot, fault.ticks);
      }
      demand(kEdgeTicks, kNoAxis, fault.kind);
      return;
  }
  demand(fault.kind == FaultKind::kCardDeaf ? 2 * kEdgeTicks : kEdgeTicks, static_cast<int>(fault.slot),
         fault.kind);
}

void World::inject_axis(const Fault& fault) {
  const std::size_t slot = fault.slot;
  const ilk_axis_config_t& axis = robot_.config.axis[slot];
  switch (fault.kind) {
    case FaultKind::kEncoderStuck:
      act(command::StickEncoder{slot, true});
      act(command::StickEncoder{slot, false}, fault.ticks);
      break;
    case FaultKind::kEncoderJumps: {
      const std::int32_t counts = signed_amount(fault, 20 * axis.max_delta_counts);
      act(command::JumpCounter{slot, counts});
      break;
    }
    case FaultKind::kEncoderSlips:
      for (std::uint32_t tick = 0; tick < fault.ticks; tick += 3) {
        act(command::JumpCounter{slot, signed_amount(fault, 2)}, tick);
      }
      break;
    case FaultKind::kEncoderReversed:
      act(command::ReverseMotor{slot, true});
      act(command::ReverseMotor{slot, false}, fault.ticks);
      break;
    case FaultKind::kAxisDrifts:
      act(command::RunAway{slot, signed_amount(fault, 10) / 20.0});
      act(command::RunAway{slot, 0}, fault.ticks);
      break;
    case FaultKind::kAxisJammed:
      act(command::JamAxis{slot, true});
      act(command::JamAxis{slot, false}, fault.ticks);
      return;
    case FaultKind::kAxisRunsAway:
      act(command::RunAway{slot, static_cast<double>(signed_amount(fault, 2 * axis.max_delta_counts))});
      act(command::RunAway{slot, 0}, fault.ticks);
      break;
    default:
      act(command::PushAxis{slot, signed_amount(fault, 200)});
      break;
  }
  break_promise(slot, fault.ticks);
}

void World::inject_switch(const Fault& fault) {
  const std::size_t slot = fault.slot;
  switch (fault.kind) {
    case FaultKind::kSwitchStuckOpen:
      act(command::StickSwitch{slot, false});
      break;
    case FaultKind::kSwitchStuckClosed:
      act(command::StickSwitch{slot, true});
      break;
    default:
      for (std::uint32_t tick = 0; tick < fault.ticks; tick++) {
        act(command::StickSwitch{slot, tick % 2 == 0}, tick);
      }
      break;
  }
  act(command::StickSwitch{slot, std::nullopt}, fault.ticks);
}

void World::inject_app(const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::kAppSilent: {
      app_.fall_silent(fault.ticks);
      if (fault.ticks > robot_.config.common.app_timeout_ticks + 1) {
        demand(robot_.config.common.app_timeout_ticks + 1, kNoAxis, fault.kind);
      }
      break;
    }
    case FaultKind::kAppLies:
      app_.lie(fault.ticks);
      break;
    case FaultKind::kAppFloods:
      app_.flood(fault.ticks);
      break;
    case FaultKind::kAppAttachesAnew:
      app_.attach_anew();
      break;
    default:
      app_.hand_over();
      break;
  }
}

void World::inject_memory(const Fault& fault) {
  if (fault.kind == FaultKind::kStateBitFlips) {
    state_bit_ = fault.amount % kStateBits;
    totals_.state_bits.set(*state_bit_);
    totals_.bit_flips++;
    demand(0, kNoAxis, fault.kind);
    return;
  }
  if (config_damage_left_ > 0) {
    return;
  }
  config_bit_ = fault.amount % kConfigBits;
  flip(config_, config_bit_);
  config_damage_left_ = fault.ticks;
  totals_.config_bits.set(config_bit_);
  if (is_driven_) {
    totals_.config_bits_driven.set(config_bit_);
  }
  totals_.bit_flips++;
  demand(met_within(config_bit_), kNoAxis, fault.kind);
}

}  // namespace interlock::campaign
