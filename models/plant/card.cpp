#include "plant/card.hpp"

#include <algorithm>

namespace interlock::plant {
namespace {

constexpr std::uint64_t kNoiseStream = 0x100;
constexpr std::uint64_t kBitErrorStream = 0x200;

}  // namespace

Card::Card(std::uint32_t type, const std::optional<Encoder>& encoder, std::uint64_t seed, std::size_t slot)
    : type_(type),
      encoder_(encoder),
      reading_noise_(seed, kNoiseStream + slot),
      bit_errors_(seed, kBitErrorStream + slot) {}

std::optional<wire::Frame> Card::transact(const Reading& reading, wire::FrameView heard) {
  if (!powered_) {
    return std::nullopt;
  }
  const wire::Frame latched = wire::pack({
      .switch_triggered = reading.switch_triggered,
      .counter = encoder_ ? encoder_->read(reading.position_counts, reading_noise_) : 0,
      .analog = reading.analog,
      .heartbeat = heartbeat_++,
      .time_us = static_cast<std::uint32_t>(uptime_.count()),
      .tick_echo = heard_tick_.value_or(0),
      .amplifier_on = amplifier_on(),
      .watchdog_tripped = watchdog_tripped_,
      .last_frame_bad = last_frame_bad_,
      .was_reset = was_reset_,
  });
  const std::optional<wire::Frame> sent = spoiled(latched);
  last_latched_ = latched;
  if (sent) {
    last_sent_ = sent;
  }
  hear(heard);
  return sent;
}

std::optional<wire::Frame> Card::spoiled(const wire::Frame& latched) {
  if (spoiled_left_ == 0) {
    return latched;
  }
  --spoiled_left_;
  switch (fault_) {
    case FrameFault::kCorrupt: {
      wire::Frame frame = latched;
      const std::uint32_t bit = bit_errors_.below(wire::kFrameWords * 32);
      frame[bit / 32] ^= 1u << (bit % 32);
      return frame;
    }
    case FrameFault::kDelay:
      return last_latched_;
    case FrameFault::kRepeat:
      return last_sent_;
    default:
      return std::nullopt;
  }
}

void Card::hear(wire::FrameView frame) {
  if (deaf_left_ > 0) {
    --deaf_left_;
    return;
  }
  last_frame_bad_ = !wire::is_sound(frame);
  if (last_frame_bad_ || heard_tick_ == wire::tick_counter(frame)) {
    return;
  }
  heard_tick_ = wire::tick_counter(frame);
  command_ = wire::read_command(type_, frame);
  silence_ = Microseconds{0};
  watchdog_tripped_ = false;
}

void Card::advance(Microseconds elapsed) {
  uptime_ += elapsed;
  silence_ += elapsed;
  if (heard_tick_ && silence_ >= kCardWatchdog) {
    command_ = {};
    watchdog_tripped_ = true;
  }
}

std::optional<Microseconds> Card::watchdog_left() const {
  if (!amplifier_on()) {
    return std::nullopt;
  }
  return kCardWatchdog - silence_;
}

void Card::restart(double position_counts) {
  if (encoder_) {
    encoder_->restart(position_counts);
  }
  command_ = {};
  silence_ = Microseconds{0};
  uptime_ = Microseconds{0};
  heartbeat_ = 0;
  heard_tick_.reset();
  watchdog_tripped_ = false;
  last_frame_bad_ = false;
  was_reset_ = true;
  last_latched_.reset();
  last_sent_.reset();
}

void Card::power(bool on, double position_counts) {
  if (on && !powered_) {
    restart(position_counts);
  }
  powered_ = on;
}

void Card::spoil(FrameFault fault, std::uint32_t count) {
  if (fault == FrameFault::kDeaf) {
    deaf_left_ = count;
  } else {
    fault_ = fault;
    spoiled_left_ = count;
  }
}

void Card::clear_faults(double position_counts) {
  power(true, position_counts);
  spoiled_left_ = 0;
  deaf_left_ = 0;
  if (encoder_) {
    encoder_->stick(false, position_counts);
  }
}

}  // namespace interlock::plant
