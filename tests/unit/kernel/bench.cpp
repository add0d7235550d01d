#include "bench.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

extern "C" {
#include "parts.h"
}

namespace interlock::kernel_test {

namespace {

void require(bool reached, const char* where) {
  if (!reached) throw std::logic_error(std::string("the bench did not reach: ") + where);
}

ilk_request_t request(ilk_request_kind_t kind, uint32_t axis = 0) {
  ilk_request_t made{};
  made.kind = kind;
  made.axis = axis;
  return made;
}

int32_t sign(ilk_direction_t direction) {
  switch (direction) {
    case ILK_DIRECTION_INCREASING:
      return 1;
    case ILK_DIRECTION_DECREASING:
      return -1;
    default:
      return 0;
  }
}

}  // namespace

void Motor::advance(ilk_direction_t driven) {
  travelled += creep;
  if (frozen) return;
  const int32_t way = reversed ? -sign(driven) : sign(driven);
  if (way != 0) {
    travelled += way * speed;
    run_out_ = way * coast;
  } else if (run_out_ != 0) {
    const int32_t step = run_out_ / 2 != 0 ? run_out_ / 2 : run_out_;
    travelled += step;
    run_out_ -= step;
  }
}

bool Motor::switch_triggered(uint32_t limit_side) {
  if (switch_at) {
    const int64_t beyond = limit_side == ILK_LIMIT_UPPER ? travelled - *switch_at : *switch_at - travelled;
    closed_ = beyond >= (closed_ ? -hysteresis : 0);
  }
  return switch_stuck.value_or(switch_at && closed_);
}

ilk_request_t heartbeat(uint32_t holder) {
  ilk_request_t made = request(ILK_REQUEST_HEARTBEAT);
  made.holder = holder;
  return made;
}
ilk_request_t stop() { return request(ILK_REQUEST_STOP); }
ilk_request_t reset() { return request(ILK_REQUEST_RESET); }
ilk_request_t disable(uint32_t axis) { return request(ILK_REQUEST_DISABLE, axis); }
ilk_request_t enable(uint32_t axis) { return request(ILK_REQUEST_ENABLE, axis); }
ilk_request_t clear_fault(uint32_t axis) { return request(ILK_REQUEST_CLEAR_FAULT, axis); }
ilk_request_t home(uint32_t axis) { return request(ILK_REQUEST_HOME, axis); }
ilk_request_t set_home(uint32_t axis) { return request(ILK_REQUEST_SET_HOME, axis); }

ilk_request_t move(uint32_t axis, int32_t target, uint32_t drive, uint32_t lease) {
  ilk_request_t made = request(ILK_REQUEST_MOVE, axis);
  made.target_counts = target;
  made.drive = drive;
  made.lease_ticks = lease;
  return made;
}

ilk_request_t restore(uint32_t axis, int32_t position) {
  ilk_request_t made = request(ILK_REQUEST_RESTORE, axis);
  made.target_counts = position;
  return made;
}

ilk_request_t with_crc(ilk_request_t request) {
  const std::array<uint32_t, 9> words = {
      request.sequence, request.kind,      request.axis,        static_cast<uint32_t>(request.target_counts),
      request.drive,    request.amplitude, request.lease_ticks, request.consent,
      request.holder};
  request.crc = crc32_of_words(words);
  return request;
}

Bench::Bench(const ilk_config_t& config)
    : config_(config),
      watch_(config,
             ilk_init(&config_, &state_).error == ILK_CONFIG_ERROR_NONE ? ILK_MODE_LOCKED : ILK_MODE_INIT) {}

void Bench::pedal(bool pressed) {
  pedal_no_closed = pressed ? 1 : 0;
  pedal_nc_closed = pressed ? 0 : 1;
}

void Bench::spoil(uint32_t slot, FrameFault fault, uint32_t ticks) {
  card[slot].fault = fault;
  card[slot].fault_ticks = ticks;
}

void Bench::latch(uint32_t slot) {
  Card& sender = card[slot];
  const ilk_axis_config_t& axis = watch_.config().axis[slot];
  const bool odd = state_.system.tick % 2 == 1;
  const auto counts = static_cast<uint32_t>(motor[slot].travelled + (odd ? motor[slot].dither : 0));
  const bool corrected = axis.direction_correction == 1;

  sender.heartbeat += 1;
  sender.time_us += config_.common.period_us;
  Frame frame{};
  frame[incoming::start] = start_word;
  frame[incoming::pairs] = motor[slot].switch_triggered(axis.limit_side) ? 0 : incoming::switch_open_bit;
  frame[incoming::encoder] = motor[slot].raw_at_start + (corrected ? 0u - counts : counts);
  frame[incoming::adc_1_2] = 0x12345678u;
  frame[incoming::adc_3_4] = 0x9ABCDEF0u;
  frame[incoming::heartbeat] = sender.heartbeat;
  frame[incoming::time_us] = sender.time_us;
  frame[incoming::tick_echo] = sender.heard_tick;
  frame[incoming::status] = sender.status;
  write_checksum(frame);

  inputs_.frames_received |= 1u << slot;
  const FrameFault fault = sender.fault_ticks > 0 ? sender.fault : FrameFault::none;
  sender.fault_ticks -= sender.fault_ticks > 0 ? 1 : 0;
  switch (fault) {
    case FrameFault::none:
      break;
    case FrameFault::wrong_checksum:
      frame.back() ^= 1u;
      break;
    case FrameFault::wrong_start:
      frame[incoming::start] = start_word + 1;
      write_checksum(frame);
      break;
    case FrameFault::missing:
      inputs_.frames_received &= ~(1u << slot);
      break;
    case FrameFault::repeated:
      frame = sender.last_sent;
      break;
    case FrameFault::stale_echo:
      frame[incoming::tick_echo] -= 1;
      write_checksum(frame);
      break;
  }
  sender.last_sent = frame;
  std::copy(frame.begin(), frame.end(), inputs_.frame[slot]);
}

void Bench::transact() {
  inputs_ = {};
  inputs_.link_generation = link_generation;
  inputs_.boot_nonce = boot_nonce;
  inputs_.deadlines_missed = deadlines_missed;
  inputs_.transaction_done = transaction_done;
  inputs_.pedal_no_closed = pedal_no_closed;
  inputs_.pedal_nc_closed = pedal_nc_closed;
  inputs_.estop_loop_closed = estop_loop_closed;
  for (uint32_t slot = 0; slot < ILK_SLOTS; ++slot) {
    const ilk_axis_config_t& axis = watch_.config().axis[slot];
    if (axis.card == ILK_CARD_NONE) continue;
    motor[slot].advance(wire_direction(axis, out_.frame[slot]));
    latch(slot);
    if (start_and_checksum_right(out_.frame[slot])) card[slot].heard_tick = out_.frame[slot][outgoing::tick];
  }
}

void Bench::decide() {
  if (app_alive && queue_.size() < ILK_REQUESTS_PER_TICK) queue(heartbeat(holder));
  const auto count = static_cast<uint32_t>(queue_.size());
  queue_.resize(std::max<std::size_t>(queue_.size(), ILK_REQUESTS_PER_TICK));
  ilk_step(&config_, &state_, &inputs_, queue_.data(), count, &out_);
  if (watched) watch_.judge(inputs_, queue_, count, state_, out_);
  queue_.clear();
}

void Bench::tick() {
  transact();
  decide();
}

void Bench::ticks(uint32_t count) {
  for (uint32_t done = 0; done < count; ++done) tick();
}

void Bench::tick_with_switch(uint32_t slot, bool triggered) {
  const std::optional<bool> before = motor[slot].switch_stuck;
  motor[slot].switch_stuck = triggered;
  tick();
  motor[slot].switch_stuck = before;
}

uint32_t Bench::queue(ilk_request_t request) {
  const bool moves = request.kind == ILK_REQUEST_MOVE || request.kind == ILK_REQUEST_HOME;
  if (moves && request.consent == 0) request.consent = state_.system.consent;
  request.sequence = ++last_sequence;
  queue_.push_back(with_crc(request));
  return request.sequence;
}

void Bench::queue_record(const ilk_request_t& record) { queue_.push_back(record); }

ilk_verdict_t Bench::ask(const ilk_request_t& request) {
  const uint32_t sequence = queue(request);
  tick();
  return verdict_of(sequence);
}

ilk_verdict_t Bench::verdict_of(uint32_t sequence) const {
  for (uint32_t index = 0; index < out_.verdict_count; ++index) {
    if (out_.verdict[index].sequence == sequence) {
      return static_cast<ilk_verdict_t>(out_.verdict[index].verdict);
    }
  }
  throw std::logic_error("no verdict for the request in this tick");
}

ilk_direction_t Bench::driven_direction(uint32_t slot) const {
  return wire_direction(watch_.config().axis[slot], out_.frame[slot]);
}

bool Bench::wire_is_zero() const {
  return std::all_of(std::begin(out_.frame), std::end(out_.frame),
                     [](const auto& frame) { return drive_words_zero(frame); });
}

void Bench::reseal() { ilk_state_seal(&state_); }

void Bench::to_ready() {
  pedal(false);
  ticks(5);
  require(ask(reset()) == ILK_VERDICT_ACCEPTED && mode() == ILK_MODE_READY, "READY");
  rest();
}

void Bench::arm() {
  pedal(false);
  ticks(config_.common.pedal_debounce_ticks + 1);
  require(state_.system.pedal_armed == 1, "an armed pedal");
}

void Bench::press() {
  arm();
  pedal(true);
  ticks(config_.common.pedal_debounce_ticks);
  require(mode() == ILK_MODE_MOTION, "MOTION");
}

void Bench::release() {
  pedal(false);
  tick();
}

void Bench::to_motion() {
  to_ready();
  press();
}

void Bench::enable_axis(uint32_t slot) {
  require(ask(enable(slot)) == ILK_VERDICT_ACCEPTED && axis_state(slot) == ILK_AXIS_ENABLED,
          "an enabled axis");
}

void Bench::reference(uint32_t slot) {
  require(ask(set_home(slot)) == ILK_VERDICT_ACCEPTED && axis(slot).homed == ILK_HOMED_BY_HAND,
          "a homed axis");
}

void Bench::push(uint32_t slot, int32_t counts) {
  const auto stride = static_cast<int32_t>(config_.axis[slot].max_delta_counts);
  for (int32_t left = counts; left != 0;) {
    const int32_t step = std::clamp(left, -stride, stride);
    motor[slot].travelled += step;
    left -= step;
    tick();
  }
}

void Bench::to_motion_homed(uint32_t slot, int32_t position) {
  to_ready();
  reference(slot);
  push(slot, position);
  rest();
  enable_axis(slot);
  press();
}

void Bench::keep_moving(uint32_t slot, int32_t target, uint32_t count, uint32_t drive) {
  for (uint32_t done = 0; done < count; ++done) {
    queue(move(slot, target, drive));
    tick();
  }
}

Bench ready_bench(const ilk_config_t& config) {
  Bench bench(config);
  bench.to_ready();
  return bench;
}

Bench motion_bench(uint32_t slot, const ilk_config_t& config) {
  Bench bench = ready_bench(config);
  bench.enable_axis(slot);
  bench.press();
  return bench;
}

Bench homed_bench(uint32_t slot, int32_t position, const ilk_config_t& config) {
  Bench bench(config);
  bench.to_motion_homed(slot, position);
  return bench;
}

Bench faulted_bench(uint32_t slot) {
  Bench bench = ready_bench();
  bench.motor[slot].travelled += 100;
  bench.tick();
  require(bench.fault(slot) == ILK_FAULT_JUMP, "a fault");
  bench.rest();
  return bench;
}

}  // namespace interlock::kernel_test
