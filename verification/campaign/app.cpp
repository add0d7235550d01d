#include "app.hpp"

#include <algorithm>

#include "interlock/kernel.h"

namespace interlock::campaign {
namespace {

constexpr std::uint64_t kAppStream = 2;
constexpr std::uint32_t kPatience = 60;       /**< ticks pressed without MOTION after which the foot lifts */
constexpr std::uint32_t kLongestHold = 2500;  /**< ticks of a press */
constexpr std::uint32_t kHastyHold = 40;      /**< the same of a hasty foot */
constexpr std::uint32_t kSteadyHold = 20'000; /**< a whole case */
constexpr std::uint32_t kActionInterval = 10; /**< ticks between two requests for an axis outside of MOTION */

void count_down(std::uint32_t& ticks) {
  if (ticks > 0) {
    ticks--;
  }
}

}  // namespace

App::App(const ilk_config_t& config, std::uint64_t seed, Manner manner)
    : config_(config),
      random_(seed, kAppStream),
      manner_(manner),
      is_hasty_(random_.chance(0.25)),
      stands_at_zero_(manner == Manner::kSteady) {}

void App::attach_anew() {
  generation_++;
  sequence_ = 0;
}

void App::send(ilk_request_t request, bool intact) {
  if (count_ == kMostRequests) {
    return;
  }
  request.crc = ilk_request_crc(&request) ^ (intact ? 0u : 1u << random_.below(32));
  requests_[count_] = request;
  count_++;
}

ilk_request_t App::draft(ilk_request_kind_t kind, std::uint32_t slot) {
  ilk_request_t request{};
  request.sequence = ++sequence_;
  request.kind = kind;
  request.axis = slot;
  request.holder = holder_;
  request.consent = consent_;
  return request;
}

void App::ask(ilk_request_kind_t kind, std::uint32_t slot) { send(draft(kind, slot)); }

std::uint32_t App::choose_hold() {
  return manner_ != Manner::kUsual ? kSteadyHold : 1 + random_.below(is_hasty_ ? kHastyHold : kLongestHold);
}

/** Who holds for a whole case waits until each axis is ready that can be. */
bool App::may_press(const ilk_state_t& shown) const {
  return shown.system.mode == ILK_MODE_READY &&
         (manner_ == Manner::kUsual || std::ranges::none_of(shown.axis, [](const ilk_axis_t& axis) {
            return axis.state == ILK_AXIS_DISABLED;
          }));
}

void App::move_foot(const ilk_state_t& shown) {
  const bool in_motion = shown.system.mode == ILK_MODE_MOTION;
  if (in_motion && !was_in_motion_) {
    foot_ticks_ = choose_hold();
  }
  if (was_in_motion_ && !in_motion) {
    foot_ticks_ = 0;
  }
  was_in_motion_ = in_motion;
  if (shown.system.mode == ILK_MODE_LOCKED && foot_down_) {
    foot_ticks_ = 0;
  }
  if (foot_ticks_ > 0) {
    foot_ticks_--;
  } else {
    foot_down_ = !foot_down_ && may_press(shown);
    foot_ticks_ = foot_down_ ? kPatience : config_.common.pedal_debounce_ticks + 8 + random_.below(40);
  }
}

void App::prepare_axis(std::uint32_t tick, const ilk_state_t& shown, std::uint32_t slot) {
  const ilk_axis_t& axis = shown.axis[slot];
  const ilk_axis_config_t& bounds = config_.axis[slot];
  if ((tick + slot) % kActionInterval != 0) {
    return;
  }
  const bool may_guess = manner_ == Manner::kUsual || stands_at_zero_;
  const bool is_unplaced = axis.homed == ILK_HOMED_NOT && may_guess;
  if (axis.state == ILK_AXIS_FAULTED) {
    if (manner_ != Manner::kSteady) {
      ask(ILK_REQUEST_CLEAR_FAULT, slot);
    }
  } else if (is_unplaced && manner_ == Manner::kUsual && random_.chance(0.02)) {
    ilk_request_t request = draft(ILK_REQUEST_RESTORE, slot);
    request.target_counts =
        bounds.min_counts + static_cast<std::int32_t>(random_.below(
                                static_cast<std::uint32_t>(bounds.max_counts - bounds.min_counts)));
    send(request);
  } else if (is_unplaced && random_.chance(stands_at_zero_                       ? 1.0
                                           : bounds.limit_side == ILK_LIMIT_NONE ? 0.7
                                                                                 : 0.3)) {
    ask(ILK_REQUEST_SET_HOME, slot);
  } else if (axis.state == ILK_AXIS_DISABLED) {
    ask(ILK_REQUEST_ENABLE, slot);
  }
}

void App::choose_target(const ilk_state_t& shown, std::uint32_t slot) {
  const ilk_axis_config_t& bounds = config_.axis[slot];
  const ilk_axis_t& axis = shown.axis[slot];
  Intent& intent = intents_[slot];
  if (axis.homed != ILK_HOMED_NOT) {
    const ilk_reach_t reach = ilk_reach(&bounds, &axis);
    const auto lowest = static_cast<std::int32_t>(reach.low);
    const auto highest = static_cast<std::int32_t>(reach.high);
    intent.target =
        lowest + static_cast<std::int32_t>(random_.below(static_cast<std::uint32_t>(highest - lowest) + 1));
    intent.target = random_.chance(0.1) ? lowest : random_.chance(0.1) ? highest : intent.target;
    intent.drive =
        random_.chance(0.5) ? bounds.max_drive : bounds.max_drive / 8 + random_.below(bounds.max_drive / 2);
  } else {
    const auto room = static_cast<std::int32_t>(ilk_unhomed_travel_left(&bounds, &axis));
    intent.target = axis.position_counts + (random_.coin() ? room : -room);
    intent.drive = bounds.unhomed_max_drive;
  }
}

void App::drive_axis(std::uint32_t tick, const ilk_state_t& shown, std::uint32_t slot) {
  const ilk_axis_t& axis = shown.axis[slot];
  Intent& intent = intents_[slot];
  if (!intent.takes_part || tick < intent.renew_tick ||
      (axis.state != ILK_AXIS_ENABLED && axis.state != ILK_AXIS_MOVING)) {
    return;
  }
  if (intent.homes || (manner_ == Manner::kHoming && random_.chance(0.01))) {
    intent.homes = false;
    choose_target(shown, slot);
    ask(ILK_REQUEST_HOME, slot);
    return;
  }
  const std::int64_t way = std::int64_t{intent.target} - axis.position_counts;
  if (std::abs(way) <= std::int64_t{config_.axis[slot].deadband_counts} || random_.chance(0.05)) {
    choose_target(shown, slot);
  }
  if (axis.homed == ILK_HOMED_NOT) {
    intent.drive = config_.axis[slot].unhomed_max_drive;
  }
  ilk_request_t request = draft(ILK_REQUEST_MOVE, slot);
  request.target_counts = intent.target;
  request.drive = intent.drive;
  request.amplitude = config_.axis[slot].max_amplitude;
  request.lease_ticks = 1 + random_.below(config_.common.lease_max_ticks);
  intent.renew_tick = tick + 1 + random_.below(config_.common.lease_max_ticks);
  send(request);
}

void App::tell_a_lie(const ilk_state_t& shown) {
  constexpr std::uint32_t extremes[] = {0, 1, 0x7FFFFFFF, 0x80000000u, 0xFFFFFFFFu};
  const auto wild = [this, &extremes] {
    return random_.coin() ? extremes[random_.below(std::size(extremes))] : random_.below(0xFFFFFFFF);
  };
  ilk_request_t request{};
  request.sequence = random_.chance(0.9) ? ++sequence_ : sequence_ - random_.below(3);
  request.kind = random_.below(ILK_REQUEST_COUNT + 2);
  request.axis = random_.below(ILK_SLOTS + 1);
  const std::uint32_t slot = std::min<std::uint32_t>(request.axis, ILK_SLOTS - 1);
  const ilk_axis_config_t& bounds = config_.axis[slot];
  const std::int32_t near_limit = (random_.coin() ? bounds.min_counts : bounds.max_counts);
  const auto offset = static_cast<std::int32_t>(random_.below(2 * bounds.coast_counts + 3)) -
                      static_cast<std::int32_t>(bounds.coast_counts) - 1;
  const std::int32_t plausible =
      random_.coin() ? near_limit + offset
                     : shown.axis[slot].position_counts + static_cast<std::int32_t>(random_.below(401)) - 200;
  request.target_counts = random_.chance(0.8) ? plausible : static_cast<std::int32_t>(wild());
  request.drive =
      random_.chance(0.8) ? bounds.max_drive / (random_.coin() ? 1 : 10) + random_.below(2) : wild();
  request.amplitude = bounds.max_amplitude + (random_.chance(0.1) ? random_.below(80) : 0);
  request.lease_ticks = random_.chance(0.8) ? 1 + random_.below(config_.common.lease_max_ticks + 1) : wild();
  request.consent = random_.chance(0.9) ? consent_ : wild();
  request.holder = random_.chance(0.95) ? holder_ : wild();
  send(request, !random_.chance(0.1));
}

void App::act(std::uint32_t tick, const ilk_state_t& shown) {
  count_ = 0;
  consent_ = shown.system.consent;
  const bool enters = shown.system.mode == ILK_MODE_MOTION && !was_in_motion_;
  move_foot(shown);
  if (enters) {
    stands_at_zero_ = false;
    for (std::uint32_t slot = 0; slot < ILK_SLOTS; slot++) {
      const bool is_homed = shown.axis[slot].homed != ILK_HOMED_NOT;
      const bool has_switch = config_.axis[slot].limit_side != ILK_LIMIT_NONE;
      if (manner_ == Manner::kHoming) {
        intents_[slot] = {has_switch, has_switch && (!is_homed || random_.coin())};
      } else {
        // A stop in a homing takes the axis its place, and it stalls sooner or later: each second one stays.
        const bool stays = manner_ == Manner::kSteady && slot % 2 == 0;
        intents_[slot] = {stays || random_.chance(0.8),
                          has_switch && !stays && random_.chance(is_homed ? 0.02 : 0.6)};
      }
      intents_[slot].renew_tick = tick + random_.below(20);
      choose_target(shown, slot);
    }
  }
  if (silent_ticks_ == 0) {
    if (tick >= next_heartbeat_) {
      ask(ILK_REQUEST_HEARTBEAT);
      heartbeat_tick_ = tick;
      next_heartbeat_ = tick + 1 + random_.below(config_.common.app_timeout_ticks / 3);
    }
    if (shown.system.mode == ILK_MODE_LOCKED && tick % 7 == 0) {
      ask(ILK_REQUEST_RESET);
    }
    for (std::uint32_t slot = 0; slot < ILK_SLOTS; slot++) {
      if (shown.system.mode == ILK_MODE_READY) {
        prepare_axis(tick, shown, slot);
      } else if (shown.system.mode == ILK_MODE_MOTION) {
        drive_axis(tick, shown, slot);
      }
    }
    if (shown.system.mode == ILK_MODE_MOTION && manner_ == Manner::kUsual && random_.chance(0.0005)) {
      ask(random_.coin() ? ILK_REQUEST_STOP : ILK_REQUEST_DISABLE, random_.below(ILK_SLOTS));
    }
    for (std::uint32_t lies = lying_ticks_ > 0 ? 2 : 0; lies > 0; lies--) {
      tell_a_lie(shown);
    }
    while (flooding_ticks_ > 0 && count_ < kMostRequests) {
      tell_a_lie(shown);
    }
  }
  count_down(silent_ticks_);
  count_down(lying_ticks_);
  count_down(flooding_ticks_);
  if (lifted_ticks_ > 0) {
    lifted_ticks_--;
    foot_down_ = false;
  }
}

}  // namespace interlock::campaign
