#include "refusal.hpp"

#include <algorithm>
#include <array>

#include "flip.hpp"
#include "interlock/kernel.h"
#include "stop_clock.hpp"

namespace interlock::campaign {
namespace {

constexpr std::uint32_t kTicks = 8;
constexpr std::uint32_t kUsPerMs = 1000;

/** The least number of ticks that is longer than so many milliseconds. */
std::uint32_t longer_than(std::uint32_t milliseconds, const ilk_config_t& config) {
  return milliseconds * kUsPerMs / config.common.period_us + 1u;
}

using Spoil = void (*)(ilk_config_t& config, ilk_axis_config_t& axis);

/** Each breaks one rule of the specification: maxima, ranges that are empty, bounds that must not be zero. */
constexpr std::array<Spoil, 28> kSpoils{
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.version++; },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.size_bytes -= 4; },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.period_us = 0; },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.pedal_channels = 0; },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.pedal_channels = 3; },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.app_timeout_ticks = 1; },
    [](ilk_config_t& config, ilk_axis_config_t&) {
      config.common.app_timeout_ticks = longer_than(150, config);
    },
    [](ilk_config_t& config, ilk_axis_config_t&) {
      config.common.lease_max_ticks = longer_than(150, config);
    },
    [](ilk_config_t& config, ilk_axis_config_t&) {
      config.common.pedal_debounce_ticks = longer_than(50, config);
    },
    [](ilk_config_t& config, ilk_axis_config_t&) {
      config.common.pedal_disagree_ticks = longer_than(50, config);
    },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.bad_frame_limit = 6; },
    [](ilk_config_t& config, ilk_axis_config_t&) { config.common.overrun_limit = 11; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.card = 99; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.limit_side = 3; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { std::swap(axis.min_counts, axis.max_counts); },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.coast_counts = 0; },
    [](ilk_config_t&, ilk_axis_config_t& axis) {
      axis.coast_counts = static_cast<std::uint32_t>(axis.max_counts - axis.min_counts) / 2u + 1u;
    },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.unhomed_travel_counts = 0; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.unhomed_max_drive = 0; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.unhomed_max_drive = axis.max_drive; },
    [](ilk_config_t& config, ilk_axis_config_t& axis) { axis.stall_ticks = longer_than(500, config); },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.drift_counts = axis.coast_counts - 1u; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.reverse_counts = axis.coast_counts - 1u; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.max_delta_counts = 0; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.dead_zone_drive = axis.max_drive / 5u + 1u; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.home_tolerance_counts = 1; },
    [](ilk_config_t&, ilk_axis_config_t& axis) { axis.stall_effort_ticks = 1; },
    [](ilk_config_t& config, ilk_axis_config_t&) { std::ranges::fill(config.axis, ilk_axis_config_t{}); },
};

/** Everything that an app can ask of one axis, and then all over again. */
ilk_request_t wish(std::uint32_t tick, std::uint32_t slot) {
  constexpr std::array kinds{ILK_REQUEST_HEARTBEAT, ILK_REQUEST_RESET, ILK_REQUEST_SET_HOME,
                             ILK_REQUEST_ENABLE,    ILK_REQUEST_MOVE,  ILK_REQUEST_HOME};
  ilk_request_t request{};
  request.sequence = tick + 1;
  request.kind = kinds[tick % kinds.size()];
  request.axis = slot;
  request.drive = 1;
  request.lease_ticks = 1;
  request.holder = 1;
  request.crc = ilk_request_crc(&request);
  return request;
}

}  // namespace

std::size_t spoilings() { return kSpoils.size() + 1; }

ilk_config_t spoilt(const ilk_config_t& config, std::size_t way, plant::Random& random) {
  ilk_config_t wrong = config;
  const std::uint32_t slot = random.below(ILK_SLOTS);
  const std::uint32_t bit = random.below(sizeof(ilk_config_t) * 8);
  if (way == kSpoils.size()) {
    flip(wrong, bit);
  } else {
    kSpoils[way](wrong, wrong.axis[slot]);
    wrong.crc = ilk_config_crc(&wrong);
  }
  return wrong;
}

bool stays_inert(const ilk_config_t& config, std::uint32_t slot) {
  ilk_state_t state{};
  ilk_inputs_t in{};
  ilk_outputs_t out{};
  in.link_generation = 1;
  in.transaction_done = 1;
  in.estop_loop_closed = 1;
  in.pedal_nc_closed = 1;
  ilk_init(&config, &state);
  for (std::uint32_t tick = 0; tick < kTicks; ++tick) {
    const ilk_request_t request = wish(tick, slot);
    ilk_step(&config, &state, &in, &request, 1, &out);
    if (state.system.mode != ILK_MODE_INIT || !is_zero_drive(out) || out.power != 0) {
      return false;
    }
  }
  return true;
}

std::optional<std::string_view> judge_refusals(const ilk_config_t& config, plant::Random& random) {
  for (std::size_t way = 0; way < spoilings(); ++way) {
    if (!stays_inert(spoilt(config, way, random), random.below(ILK_SLOTS))) {
      return "P13: left INIT with a configuration that has to be refused";
    }
  }
  return std::nullopt;
}

}  // namespace interlock::campaign
