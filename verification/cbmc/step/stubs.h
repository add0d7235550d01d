/**
 * @file
 * Stand-ins for the phases of a tick. Each shows that it is called at its place in the order, once, and with
 * the right arguments, and leaves behind whatever the harness chose of what the step reads afterwards.
 */
#ifndef ILK_PROOF_STEP_STUBS_H
#define ILK_PROOF_STEP_STUBS_H

#include "axis.h"
#include "frame.h"
#include "gate.h"
#include "integrity.h"
#include "mode.h"
#include "proof.h"
#include "valid.h"

/** The parts of a tick in their order. */
enum {
  AT_START,
  AT_INTEGRITY,
  AT_SLICE,
  AT_BASIS,
  AT_FRAMES,
  AT_SYSTEM,
  AT_AXES,
  AT_MODE,
  AT_REQUESTS,
  AT_DRIVE,
  AT_PACK,
  AT_SEAL
};

/** What the phases decide and leave behind, chosen by the harness. */
typedef struct {
  bool sound;
  bool damaged;
  bool basis_kept;
  uint32_t found_crc;
  ilk_state_t rebuilt;
  ilk_state_t observed;
  ilk_reading_t reading[ILK_SLOTS];
  bool valid[ILK_SLOTS];
  bool lost[ILK_SLOTS];
  bool faulted[ILK_SLOTS];
  uint32_t fault[ILK_SLOTS];
  uint32_t mode;
  uint32_t count;
  uint32_t mode_after;
  uint32_t axis_state[ILK_SLOTS];
  ilk_command_t wish[ILK_SLOTS];
  uint32_t gate[ILK_SLOTS];
  uint32_t seal;
} choice_t;

static choice_t chosen;

/** What has been called so far. */
static struct {
  uint32_t at;
  bool rebuilt;
  bool sliced;
  bool cleared;
  bool observed;
  bool changed;
  uint32_t unpacked;
  uint32_t cards;
  uint32_t axes;
  uint32_t wished;
  uint32_t gated;
  bool noted_drive[ILK_SLOTS];
  bool noted_arrival[ILK_SLOTS];
  uint32_t packed;
} seen;

static ilk_config_t config;
static ilk_state_t state;
static ilk_inputs_t in;
static ilk_outputs_t out;
static ilk_request_t requests[ILK_REQUESTS_PER_TICK];

/** The state as the phases left it: what differs at the end is the doing of the step itself. */
static ilk_state_t left;

static uint32_t slot_of(const ilk_axis_t* axis) {
  uint32_t slot = 0u;
  while ((slot < ILK_SLOTS) && (axis != &state.axis[slot])) {
    slot++;
  }
  SHOW(slot < ILK_SLOTS, "an axis of the state");
  GIVEN(slot < ILK_SLOTS);
  return slot;
}

bool some_soundness(const ilk_state_t* judged) {
  SHOW((seen.at == AT_START) && (judged == &state), "P14: phase 1: the state is judged before anything else");
  seen.at = AT_INTEGRITY;
  return chosen.sound;
}

void some_rebuild(ilk_state_t* rebuilt, const ilk_config_t* used, ilk_cause_t cause, uint32_t value) {
  SHOW((seen.at == AT_INTEGRITY) && !chosen.sound && !seen.rebuilt,
       "P14: an unsound state is rebuilt, at once");
  SHOW((rebuilt == &state) && (used == &config), "P14: in its place");
  SHOW((cause == ILK_CAUSE_INTEGRITY) && (value == left.seal),
       "P14: for INTEGRITY, telling the damaged seal");
  seen.rebuilt = true;
  state = chosen.rebuilt;
  left = chosen.rebuilt;
}

ilk_config_check_t some_slice(const ilk_config_t* looked_at, ilk_state_t* held) {
  SHOW((seen.at == AT_INTEGRITY) && (seen.rebuilt == !chosen.sound),
       "P14: phase 1: a slice of the configuration, after the state");
  SHOW((looked_at == &config) && (held == &state), "P14: of this configuration");
  seen.at = AT_SLICE;
  seen.sliced = true;
  const ilk_config_check_t check = {.damaged = chosen.damaged, .crc = chosen.found_crc};
  return check;
}

bool some_basis(const ilk_config_t* looked_at, ilk_state_t* held) {
  SHOW(seen.at == AT_SLICE, "P14: phase 1: what P1 to P3 rest on, before any of it is used");
  SHOW((looked_at == &config) && (held == &state), "P14: of this configuration");
  seen.at = AT_BASIS;
  return chosen.basis_kept;
}

ilk_reading_t some_reading(const uint32_t frame[ILK_FRAME_WORDS]) {
  const uint32_t slot = seen.unpacked;
  SHOW((slot < ILK_SLOTS) && (frame == in.frame[slot]), "P16: phase 2: each slot's own frame is read once");
  SHOW((seen.at == AT_BASIS) || (seen.at == AT_FRAMES), "phase 2 comes after phase 1");
  GIVEN(slot < ILK_SLOTS);
  seen.at = AT_FRAMES;
  seen.unpacked++;
  return chosen.reading[slot];
}

static bool is_reading_of(const ilk_reading_t* reading, uint32_t slot) {
  const ilk_reading_t* own = &chosen.reading[slot];
  return (reading->intact == own->intact) && (reading->switch_triggered == own->switch_triggered) &&
         (reading->raw == own->raw) && (reading->heartbeat == own->heartbeat) &&
         (reading->card_time_us == own->card_time_us) && (reading->tick_echo == own->tick_echo) &&
         (reading->card_status == own->card_status);
}

void some_card(ilk_axis_t* axis, const ilk_reading_t* reading, bool received, uint32_t tick) {
  const uint32_t slot = slot_of(axis);
  SHOW((seen.at == AT_FRAMES) && (((seen.cards >> slot) & 1u) == 0u), "phase 2 judges a card once");
  SHOW(is_reading_of(reading, slot), "P16: a card is judged by its own frame");
  SHOW(received == ((in.transaction_done == 1u) && (((in.frames_received >> slot) & 1u) == 1u)),
       "P1: received means that the transaction was done and the slot answered");
  SHOW(tick == left.tick, "P1: the echo is judged in this tick");
  seen.cards = seen.cards | (1u << slot);
  axis->card_valid = chosen.valid[slot] ? 1u : 0u;
  left.axis[slot].card_valid = axis->card_valid;
}

void some_system(const ilk_config_t* used, ilk_state_t* observed, const ilk_inputs_t* inputs) {
  SHOW((seen.at == AT_FRAMES) && (seen.unpacked == ILK_SLOTS), "phase 3 comes after phase 2");
  SHOW((used == &config) && (observed == &state) && (inputs == &in), "phase 3 sees this tick");
  seen.at = AT_SYSTEM;
  seen.observed = true;
  state.estop = chosen.observed.estop;
  state.app_alive = chosen.observed.app_alive;
  state.last_sequence = chosen.observed.last_sequence;
  left.estop = chosen.observed.estop;
  left.app_alive = chosen.observed.app_alive;
  left.last_sequence = chosen.observed.last_sequence;
}

static void observe(uint32_t slot) {
  SHOW((seen.at == AT_SYSTEM) || (seen.at == AT_AXES), "P6: phase 4 comes after phase 3");
  SHOW(((seen.axes >> slot) & 1u) == 0u, "phase 4 observes an axis once");
  seen.at = AT_AXES;
  seen.axes = seen.axes | (1u << slot);
}

bool some_axis(const ilk_config_t* used, const ilk_axis_config_t* own, ilk_axis_t* axis,
               const ilk_reading_t* reading, uint32_t tick) {
  const uint32_t slot = slot_of(axis);
  observe(slot);
  SHOW((used == &config) && (own == &config.axis[slot]), "an axis is judged by its own configuration");
  SHOW(is_motor_card(config.axis[slot].card), "an axis is what has a motor");
  SHOW(is_reading_of(reading, slot) && (tick == left.tick), "P6: by its own frame, now");
  axis->fault = chosen.fault[slot];
  left.axis[slot].fault = chosen.fault[slot];
  return chosen.faulted[slot];
}

void some_sensor(const ilk_config_t* used, ilk_axis_t* axis) {
  const uint32_t slot = slot_of(axis);
  observe(slot);
  SHOW((used == &config) && !is_motor_card(config.axis[slot].card), "a slot without a motor");
}

bool some_loss(const ilk_config_t* used, const ilk_axis_t* axis) {
  const uint32_t slot = slot_of(axis);
  SHOW((used == &config) && (((seen.axes >> slot) & 1u) == 1u),
       "a loss is judged when the axis was observed");
  return chosen.lost[slot];
}

void some_mode(const ilk_config_t* used, ilk_state_t* changed, const ilk_alarms_t* alarms,
               const ilk_inputs_t* inputs) {
  bool faulted = false;
  bool lost = false;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    faulted = faulted || (is_motor_card(config.axis[slot].card) && chosen.faulted[slot]);
    lost = lost || ((config.axis[slot].required != 0u) && chosen.lost[slot]);
  }
  SHOW((seen.at == AT_AXES) && (seen.axes == ((1u << ILK_SLOTS) - 1u)),
       "P6: phase 5 comes when every axis has been observed");
  SHOW((used == &config) && (changed == &state) && (inputs == &in), "phase 5 sees this tick");
  SHOW(alarms->new_fault == faulted, "a new fault of any axis is told to the mode");
  SHOW(alarms->required_card_lost == lost, "and the loss of any required card");
  SHOW((alarms->configuration_damaged == (chosen.damaged || !chosen.basis_kept)) &&
           (alarms->configuration_crc == chosen.found_crc),
       "P14: and what became of the configuration");
  seen.at = AT_MODE;
  seen.changed = true;
  state.mode = chosen.mode;
  left.mode = chosen.mode;
}

/** Changes nothing of the counters, which `verdicts` follows; of mode and axes, what requests may change. */
void some_answers(const ilk_config_t* used, ilk_state_t* by, const ilk_request_t asked[], uint32_t count,
                  ilk_outputs_t* into) {
  SHOW((used == &config) && (by == &state) && (asked == requests) &&
           (count == ((chosen.count < ILK_REQUESTS_PER_TICK) ? chosen.count : ILK_REQUESTS_PER_TICK)) &&
           (into == &out),
       "P11: phase 6 answers the requests of this tick, sixteen at most, by this state");
  SHOW(seen.at == ((state.mode == ILK_MODE_INIT) ? AT_INTEGRITY : AT_MODE),
       "phase 6 comes after phase 5: a request is judged by what this tick's frames say");
  seen.at = AT_REQUESTS;
  if (state.mode != ILK_MODE_INIT) {
    state.mode = chosen.mode_after;
    left.mode = chosen.mode_after;
    for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
      state.axis[slot].state = chosen.axis_state[slot];
      left.axis[slot].state = chosen.axis_state[slot];
    }
  }
}

ilk_command_t some_wish(const ilk_axis_config_t* own, const ilk_axis_t* axis) {
  const uint32_t slot = slot_of(axis);
  const bool for_the_gate = seen.wished < ILK_SLOTS;
  SHOW((slot < ILK_SLOTS) && (own == &config.axis[slot]) && (axis == &state.axis[slot]),
       "phase 7: each axis wishes by its own configuration");
  SHOW((seen.at == AT_REQUESTS) || (seen.at == AT_DRIVE), "phase 7 comes after phase 6");
  SHOW(for_the_gate ? (slot == seen.wished) && (slot == seen.gated) : seen.gated == ILK_SLOTS,
       "phase 7: each axis wishes once for its gate; whether it has arrived is asked after the last gate");
  GIVEN(slot < ILK_SLOTS);
  seen.at = AT_DRIVE;
  seen.wished += for_the_gate ? 1u : 0u;
  return chosen.wish[slot];
}

ilk_gate_t some_gate(const ilk_axis_config_t* own, const ilk_state_t* now, const ilk_axis_t* axis,
                     const ilk_command_t* wish) {
  const uint32_t slot = seen.gated;
  const ilk_command_t* wanted = &chosen.wish[slot];
  SHOW((slot < ILK_SLOTS) && ((slot + 1u) == seen.wished) && (seen.at == AT_DRIVE),
       "P1: each wish comes to the gate once");
  SHOW((own == &config.axis[slot]) && (now == &state) && (axis == &state.axis[slot]),
       "P1: the gate sees this state");
  SHOW((wish->direction == wanted->direction) && (wish->drive == wanted->drive) &&
           (wish->amplitude == wanted->amplitude),
       "P1: and the wish itself");
  GIVEN(slot < ILK_SLOTS);
  seen.gated++;
  return (ilk_gate_t)chosen.gate[slot];
}

void some_drive_note(const ilk_axis_config_t* own, ilk_axis_t* axis, uint32_t direction) {
  const uint32_t slot = slot_of(axis);
  SHOW((own == &config.axis[slot]) && (direction == chosen.wish[slot].direction) && !seen.noted_drive[slot],
       "P5: a driven tick is noted once, with its direction");
  seen.noted_drive[slot] = true;
}

void some_arrival_note(ilk_axis_t* axis) {
  const uint32_t slot = slot_of(axis);
  SHOW(!seen.noted_arrival[slot], "P5: an arrival is noted once");
  seen.noted_arrival[slot] = true;
}

void some_frame(const ilk_axis_config_t* own, const ilk_command_t* command, uint32_t tick,
                uint32_t frame[ILK_FRAME_WORDS]) {
  const uint32_t slot = seen.packed;
  SHOW((slot < ILK_SLOTS) && (own == &config.axis[slot]) && (command == &out.command[slot]) &&
           (frame == out.frame[slot]) && (tick == left.tick),
       "P16: phase 8: each slot's own command is packed once, with this tick");
  SHOW((seen.gated == ILK_SLOTS) && (seen.at < AT_SEAL), "P1: phase 8 comes after the last gate");
  seen.at = AT_PACK;
  seen.packed++;
}

/** Stands for `clear_unused_verdicts`. */
void some_clearing(ilk_outputs_t* of) {
  SHOW((of == &out) && (seen.at == AT_PACK) && (seen.packed == ILK_SLOTS),
       "P11: what no answer used is cleared when every frame is packed");
  seen.cleared = true;
}

void some_seal(ilk_state_t* sealed) {
  SHOW((sealed == &state) && (seen.at == AT_PACK) && (seen.packed == ILK_SLOTS) && seen.cleared,
       "P14: sealing is the last thing");
  seen.at = AT_SEAL;
  state.seal = chosen.seal;
  left.seal = chosen.seal;
}

#endif
