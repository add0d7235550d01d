/// A bench for the kernel core: ten emulated cards with ideal motors, pedal, E-stop and an app that
/// sends requests. It touches the kernel only through ilk_init and ilk_step.
///
/// One tick: the motors answer what the last frames told them, the cards latch their frames, the cards
/// hear the frames of the tick before, and the kernel steps. Every tick is also judged by a SafetyWatch.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "codec.hpp"
#include "configuration.hpp"
#include "interlock/kernel.h"
#include "watch.hpp"

namespace interlock::kernel_test {

/// Ways to spoil a frame on its way to the kernel.
enum class FrameFault {
  none,
  wrong_checksum,
  wrong_start,
  missing,    ///< the slot did not answer
  repeated,   ///< the last frame once more
  stale_echo  ///< built by a card that did not hear the last frame
};

/// An axis that follows its drive. Distances in counts, in the sense of the axis' position.
struct Motor {
  int64_t travelled = 0;
  uint32_t raw_at_start = 5000;
  int32_t speed = 1;   ///< counts per driven tick
  int32_t coast = 0;   ///< counts from the last driven tick until rest
  int32_t creep = 0;   ///< counts per tick, whatever the drive says
  int32_t dither = 0;  ///< counts that every second reading is off
  bool frozen = false;
  bool reversed = false;
  std::optional<int32_t> switch_at;  ///< the switch is triggered at and beyond this place
  int32_t hysteresis = 0;            ///< and opens so far before it
  std::optional<bool> switch_stuck;  ///< the switch reads this, wherever the axis is

  void advance(ilk_direction_t driven);
  bool switch_triggered(uint32_t limit_side);

 private:
  int32_t run_out_ = 0;
  bool closed_ = false;
};

struct Card {
  uint32_t heartbeat = 0;
  uint32_t time_us = 0;
  uint32_t status = 0;
  uint32_t heard_tick = 0;
  Frame last_sent{};
  FrameFault fault = FrameFault::none;
  uint32_t fault_ticks = 0;
};

// Requests; Bench::queue adds sequence number, CRC and, to MOVE and HOME without one, the number of this
// press.
ilk_request_t heartbeat(uint32_t holder);
ilk_request_t stop();
ilk_request_t reset();
ilk_request_t disable(uint32_t axis);
ilk_request_t enable(uint32_t axis);
ilk_request_t clear_fault(uint32_t axis);
ilk_request_t move(uint32_t axis, int32_t target, uint32_t drive = 100, uint32_t lease = 20);
ilk_request_t home(uint32_t axis);
ilk_request_t set_home(uint32_t axis);
ilk_request_t restore(uint32_t axis, int32_t position);
ilk_request_t with_crc(ilk_request_t request);

class Bench {
 public:
  explicit Bench(const ilk_config_t& config = standard_config());

  // The world; change it at will between ticks.
  uint32_t pedal_no_closed = 0;
  uint32_t pedal_nc_closed = 1;
  uint32_t estop_loop_closed = 1;
  uint32_t deadlines_missed = 0;
  uint32_t transaction_done = 1;
  uint32_t link_generation = 1;
  uint32_t boot_nonce = 0x600DF00Du;
  uint32_t holder = 1;
  bool app_alive = true;  ///< a HEARTBEAT follows the requests of every tick
  bool watched = true;    ///< every tick is judged by the watch
  std::array<Motor, ILK_SLOTS> motor;
  std::array<Card, ILK_SLOTS> card;

  void pedal(bool pressed);
  void spoil(uint32_t slot, FrameFault fault, uint32_t ticks);

  // Time.
  void tick();
  void ticks(uint32_t count);
  /// One tick whose inputs `edit` changes first.
  template <typename Edit>
  void tick_with(Edit edit) {
    transact();
    edit(inputs_);
    decide();
  }

  /// One tick in which the switch of the axis reads so, by one sample.
  void tick_with_switch(uint32_t slot, bool triggered);

  // Requests.
  /// Sends the request in the next tick; returns its sequence number.
  uint32_t queue(ilk_request_t request);
  /// Sends the record as it is in the next tick.
  void queue_record(const ilk_request_t& record);
  /// Sends the request, ticks once and returns the verdict.
  ilk_verdict_t ask(const ilk_request_t& request);
  ilk_verdict_t verdict_of(uint32_t sequence) const;
  uint32_t last_sequence = 0;

  // What can be seen.
  ilk_verdict_t verdict(uint32_t index) const {
    return static_cast<ilk_verdict_t>(out_.verdict[index].verdict);
  }
  const ilk_system_t& system() const { return state_.system; }
  bool homed(uint32_t slot) const { return axis(slot).homed != ILK_HOMED_NOT; }
  bool powered() const { return out_.power == 1; }
  ilk_mode_t mode() const { return static_cast<ilk_mode_t>(state_.system.mode); }
  ilk_cause_t cause() const { return static_cast<ilk_cause_t>(state_.system.cause); }
  const ilk_state_t& state() const { return state_; }
  /// Number of the last tick; the state counts the steps done.
  uint32_t now() const { return state_.system.tick - 1; }
  const ilk_outputs_t& out() const { return out_; }
  const ilk_inputs_t& inputs() const { return inputs_; }
  const ilk_axis_t& axis(uint32_t slot) const { return state_.axis[slot]; }
  ilk_axis_state_t axis_state(uint32_t slot) const { return static_cast<ilk_axis_state_t>(axis(slot).state); }
  ilk_fault_t fault(uint32_t slot) const { return static_cast<ilk_fault_t>(axis(slot).fault); }
  ilk_gate_t gate(uint32_t slot) const { return static_cast<ilk_gate_t>(out_.gate[slot]); }
  int32_t position(uint32_t slot) const { return axis(slot).position_counts; }
  bool driven(uint32_t slot) const { return !drive_words_zero(out_.frame[slot]); }
  ilk_direction_t driven_direction(uint32_t slot) const;
  bool wire_is_zero() const;
  const ilk_config_t& config() const { return config_; }

  // For tests of integrity: damage, done on purpose.
  ilk_config_t& damage_config() { return config_; }
  ilk_state_t& damage_state() { return state_; }

  /// Writes the seal anew over what was changed on purpose.
  void reseal();

  // Ways to somewhere. Each throws std::logic_error when the kernel does not get there.
  /// READY, power up, every axis at rest.
  void to_ready();
  void arm();
  /// From READY: releases, presses, holds.
  void press();
  void release();
  void to_motion();
  void enable_axis(uint32_t slot);
  /// In READY: the axis is homed where it stands, at position 0.
  void reference(uint32_t slot);
  /// Moves a disabled axis by hand, slowly.
  void push(uint32_t slot, int32_t counts);
  /// READY, axis homed, pushed to `position`, enabled; then MOTION.
  void to_motion_homed(uint32_t slot, int32_t position = 0);
  /// Waits in READY or MOTION until every axis that nothing moves rests.
  void rest() { ticks(20); }
  /// Renews the same MOVE in each of `count` ticks.
  void keep_moving(uint32_t slot, int32_t target, uint32_t count, uint32_t drive = 100);

 private:
  void transact();
  void decide();
  void latch(uint32_t slot);

  ilk_config_t config_;
  ilk_state_t state_{};
  ilk_inputs_t inputs_{};
  ilk_outputs_t out_{};
  std::vector<ilk_request_t> queue_;
  SafetyWatch watch_;
};

/// READY, power up, everything at rest.
Bench ready_bench(const ilk_config_t& config = standard_config());
/// MOTION; the axis is enabled and not homed.
Bench motion_bench(uint32_t slot, const ilk_config_t& config = standard_config());
/// MOTION; the axis is enabled and was homed by hand, then pushed to `position`.
Bench homed_bench(uint32_t slot, int32_t position = 0, const ilk_config_t& config = standard_config());
/// READY; the axis has a JUMP fault and rests since.
Bench faulted_bench(uint32_t slot);

}  // namespace interlock::kernel_test
