#include "recorder/full_rate.hpp"

#include <memory>

#include "interlock/recorded_block.h"
#include "link/card_frame.hpp"

namespace interlock::recorder {
namespace {

std::optional<AnalogWords> analog_of(const ilk_picture_t& picture, std::optional<std::uint32_t> sensor) {
  if (!sensor || picture.state.axis[*sensor].card_valid == 0) {
    return std::nullopt;
  }
  const auto& frame = picture.inputs.frame[*sensor];
  return AnalogWords{frame[card_frame::analog_word], frame[card_frame::analog_word + 1]};
}

AxisTick axis_of(const ilk_recorded_tick_t& tick, const AxisSpan& span) {
  const ilk_picture_t& picture = tick.picture;
  const ilk_axis_t& axis = picture.state.axis[span.slot];
  const ilk_command_t& command = picture.out.command[span.slot];
  const auto drive = static_cast<std::int32_t>(command.drive);
  AxisTick found;
  found.tick = picture.state.system.tick;
  found.begun_ns = tick.begun_ns;
  found.card_time_us = axis.card_time_us;
  found.drive = command.direction == ILK_DIRECTION_DECREASING ? -drive : drive;
  found.analog = analog_of(picture, span.sensor);
  if (axis.card_valid != 0) {
    found.position_counts = axis.position_counts;
  }
  if (axis.state == ILK_AXIS_MOVING) {
    found.setpoint_counts = axis.setpoint_counts;
  }
  return found;
}

/** The newest tick that the ring holds whole. */
std::optional<std::uint32_t> newest_tick(const Ring& ring) {
  RingPlace place{ring.head(), static_cast<std::uint32_t>(ILK_OPENING_WORDS)};
  std::optional<std::uint32_t> newest = ring.opening_tick(ring.head());
  while (const std::optional<TickHead> head = ring.next(place)) {
    newest = head->tick;
  }
  return newest;
}

}  // namespace

std::vector<AxisTick> full_rate(const Ring& ring, const AxisSpan& span) {
  const std::optional<std::uint32_t> last = span.until ? span.until : newest_tick(ring);
  if (!last || ring.head() == 0) {
    return {};
  }
  const auto ticks = static_cast<std::uint32_t>(std::uint64_t{span.seconds} * 1'000'000 /
                                                ring.run().config.common.period_us);
  std::vector<AxisTick> found;
  const auto tick = std::make_unique<ilk_recorded_tick_t>();
  const std::uint32_t newest = ring.head();
  for (std::uint32_t number = ring.block_before(*last, span.seconds); number <= newest; ++number) {
    const std::optional<BlockCopy> block = ring.copy(number);
    ilk_block_cursor_t cursor{};
    if (!block || !ilk_block_begin(&cursor, &ring.run().config, block->payload.data(),
                                   static_cast<std::uint32_t>(block->payload.size()), tick.get())) {
      continue;
    }
    while (ilk_block_next(&cursor, tick.get()) == ILK_TICK_READ) {
      const auto before_last = static_cast<std::int32_t>(*last - tick->picture.state.system.tick);
      if (before_last < 0) {
        return found;
      }
      if (static_cast<std::uint32_t>(before_last) < ticks) {
        found.push_back(axis_of(*tick, span));
      }
    }
  }
  return found;
}

}  // namespace interlock::recorder
