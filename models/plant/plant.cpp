#include "plant/plant.hpp"

#include <algorithm>

namespace interlock::plant {
namespace {

constexpr std::uint64_t kSwitchStream = 0x300;
constexpr std::uint64_t kContactStream = 0x400;
constexpr std::uint64_t kForceStream = 0x500;

wire::FrameView frame_of(const ilk_sim_exchange_t& exchange, std::size_t slot) {
  return wire::FrameView(exchange.frame[slot]);
}

std::optional<Station> make_station(const ilk_axis_config_t& axis, const Parameters& parameters,
                                    std::uint64_t seed, std::size_t slot) {
  if (axis.card == ILK_CARD_NONE) {
    return std::nullopt;
  }
  Random bounce(seed, kSwitchStream + slot);
  if (!drives_motor(axis.card)) {
    return Station{Card(axis.card, std::nullopt, seed, slot), std::nullopt,
                   ForceSensor(parameters.sensor[slot], Random(seed, kForceStream + slot)), false, bounce};
  }
  const AxisParameters& motor = parameters.axis[slot];
  return Station{Card(axis.card, Encoder(axis.direction_correction != 0, motor), seed, slot),
                 Axis(axis, motor), std::nullopt, axis.limit_side != ILK_LIMIT_NONE, bounce};
}

}  // namespace

Plant::Plant(const ilk_config_t& robot, const Parameters& parameters, std::uint64_t seed)
    : period_(robot.common.period_us),
      pedal_(parameters.pedal),
      estop_loop_(true, parameters.estop.bounce),
      contact_bounce_(seed, kContactStream) {
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    stations_[slot] = make_station(robot.axis[slot], parameters, seed, slot);
  }
}

ilk_sim_reply_t Plant::exchange(const ilk_sim_exchange_t& exchange) noexcept {
  run_due_commands();
  const Inputs inputs = read_inputs();
  note_inputs(inputs);
  ilk_sim_reply_t reply{};
  reply.magic = ILK_SIM_MAGIC;
  reply.tick = exchange.tick;
  reply.pedal_no_closed = inputs.pedal_no_closed;
  reply.pedal_nc_closed = inputs.pedal_nc_closed;
  reply.estop_loop_closed = inputs.estop_loop_closed;
  if (failing_transactions_ > 0) {
    --failing_transactions_;
  } else {
    for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
      transact(slot, exchange, reply);
    }
  }
  power_ = exchange.power == 1;
  std::copy(std::begin(exchange.lamp), std::end(exchange.lamp), lamps_.begin());
  note_amplifiers();
  record_exchange(exchange, inputs);
  return reply;
}

ilk_sim_reply_t Plant::tick(const ilk_sim_exchange_t& exchange) noexcept {
  const ilk_sim_reply_t reply = this->exchange(exchange);
  advance(period_);
  return reply;
}

void Plant::transact(std::size_t slot, const ilk_sim_exchange_t& exchange, ilk_sim_reply_t& reply) {
  if (!stations_[slot]) {
    return;
  }
  Station& station = *stations_[slot];
  Reading reading{.position_counts = station.position_counts()};
  if (station.has_switch) {
    reading.switch_triggered = station.axis->limit_switch().read(station.switch_bounce);
  }
  if (station.sensor) {
    reading.analog = station.sensor->read();
  }
  if (const auto answer = station.card.transact(reading, frame_of(exchange, slot))) {
    reply.frames_received |= 1u << slot;
    std::copy(answer->begin(), answer->end(), std::begin(reply.frame[slot]));
  }
}

Plant::Inputs Plant::read_inputs() {
  return {.pedal_no_closed = pedal_.normally_open().read(contact_bounce_),
          .pedal_nc_closed = pedal_.normally_closed().read(contact_bounce_),
          .estop_loop_closed = estop_loop_.read(contact_bounce_)};
}

void Plant::note_inputs(const Inputs& inputs) {
  // A contact that bounces is no event: what the foot or the hand did decides which way an edge may go.
  const bool reads_pressed = inputs.pedal_no_closed && !inputs.pedal_nc_closed;
  if (!seen_pressed_ && reads_pressed && (pedal_.is_pressed() || pedal_.has_stuck_contact())) {
    seen_pressed_ = true;
    record_.note(Event::kPedalPressed, ticks());
  } else if (seen_pressed_ && !reads_pressed && (!pedal_.is_pressed() || pedal_.has_stuck_contact())) {
    seen_pressed_ = false;
    record_.note(Event::kPedalReleased, ticks());
  }
  if (!seen_estop_ && !inputs.estop_loop_closed && estop_pulled()) {
    seen_estop_ = true;
    record_.note(Event::kEstopPulled, ticks());
  } else if (seen_estop_ && inputs.estop_loop_closed && !estop_pulled()) {
    seen_estop_ = false;
    record_.note(Event::kEstopReleased, ticks());
  }
}

void Plant::record_exchange(const ilk_sim_exchange_t& exchange, const Inputs& inputs) {
  RecordEntry entry{.tick = ticks(),
                    .kernel_tick = exchange.tick,
                    .pedal_no_closed = inputs.pedal_no_closed,
                    .pedal_nc_closed = inputs.pedal_nc_closed,
                    .estop_loop_closed = inputs.estop_loop_closed};
  bool driven = false;
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    entry.drive[slot] = wire::first_drive_word(frame_of(exchange, slot));
    driven = driven || entry.drive[slot] != 0;
    if (const auto& station = stations_[slot]) {
      entry.amplifier[slot] = station->card.amplifier_on();
      entry.counter[slot] =
          station->card.encoder() ? station->card.encoder()->count(station->position_counts()) : 0;
    }
  }
  record_.add(entry);
  if (driven) {
    record_.note(Event::kLastNonzeroDrive, ticks());
  }
  last_exchange_ = time_;
  silence_noted_ = false;
}

void Plant::note_amplifiers() {
  const bool on = std::any_of(stations_.begin(), stations_.end(),
                              [](const auto& station) { return station && station->card.amplifier_on(); });
  if (amplifiers_on_ && !on) {
    record_.note(Event::kAmplifiersOff, ticks());
  }
  amplifiers_on_ = on;
}

void Plant::note_silence() {
  if (last_exchange_ && !silence_noted_ && time_ - *last_exchange_ >= kCardWatchdog) {
    record_.note(Event::kKernelSilent, *last_exchange_ / period_);
    silence_noted_ = true;
  }
}

Microseconds Plant::until_next_watchdog(Microseconds longest) const {
  Microseconds shortest = longest;
  for (const auto& station : stations_) {
    if (station) {
      shortest = std::min(shortest, station->card.watchdog_left().value_or(longest));
    }
  }
  return shortest;
}

void Plant::advance(Microseconds elapsed) noexcept {
  run_due_commands();
  while (elapsed.count() > 0) {
    const Microseconds next = until_next_watchdog(elapsed);
    step(next);
    elapsed -= next;
  }
}

void Plant::step(Microseconds elapsed) {
  for (auto& station : stations_) {
    if (!station) {
      continue;
    }
    if (station->axis) {
      station->axis->supply(power_);
      station->axis->drive(station->card.command());
      station->axis->advance(elapsed);
    }
    station->card.advance(elapsed);
  }
  touch(elapsed);
  pedal_.advance(elapsed);
  estop_loop_.advance(elapsed);
  time_ += elapsed;
  note_amplifiers();
  note_silence();
}

void Plant::touch(Microseconds elapsed) {
  if (!surroundings_) {
    return;
  }
  AxisPositions positions{};
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    positions[slot] = stations_[slot] ? stations_[slot]->tool_counts() : 0.0;
  }
  surroundings_->advance(positions, elapsed);
  for (const SensorLoad& load : surroundings_->loads()) {
    stations_[load.slot]->sensor->load(load.input, load.counts);
  }
}

}  // namespace interlock::plant
