/**
 * @file
 * The kernel in the page: what it would answer, and which gates stand between an axis and its drive.
 *
 * kernel/src is compiled unchanged. This file holds one configuration and one state, which the page writes
 * word for word, and asks the kernel's own functions about copies of them. It decides nothing and drives
 * nothing.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "interlock/kernel.h"
#include "parts.h"

#define EXPORT(name) __attribute__((export_name(name)))

#define START_WORD 0xfefefe01u
#define FRAME_SUM 0xffffffffu
#define SWITCH_OPEN_BIT 0x00080000u
/** Besides the debounced ones: ticks in which a release and a press begin to count. */
#define PEDAL_TICKS_BESIDES 4u

static ilk_config_t configuration;
static ilk_state_t state;

EXPORT("configuration") ilk_config_t* page_configuration(void) { return &configuration; }
EXPORT("configuration_bytes") uint32_t page_configuration_bytes(void) {
  return (uint32_t)sizeof configuration;
}
EXPORT("state") ilk_state_t* page_state(void) { return &state; }
EXPORT("state_bytes") uint32_t page_state_bytes(void) { return (uint32_t)sizeof state; }

/** 1 when the configuration that was written is one that the kernel would start with. */
EXPORT("configuration_is_valid") uint32_t page_configuration_is_valid(void) {
  return flag_of((configuration.crc == ilk_config_crc(&configuration)) &&
                 (ilk_config_validate(&configuration).error == (uint32_t)ILK_CONFIG_ERROR_NONE));
}

/** 1 when the state that was written passes the check with which the kernel begins each tick, and is of this
 * configuration. */
EXPORT("state_is_sound") uint32_t page_state_is_sound(void) {
  return flag_of(ilk_state_is_sealed(&state) && (state.system.config_crc == configuration.crc));
}

static ilk_request_t request_after(const ilk_state_t* before, ilk_request_kind_t kind, uint32_t slot) {
  ilk_request_t request = {0};
  request.sequence = before->system.last_sequence + 1u;
  request.kind = (uint32_t)kind;
  request.axis = slot;
  request.holder = before->system.holder;
  request.consent = before->system.consent;
  return request;
}

/** The app's request: of a MOVE it asks for no more than the axis may. `slot` is that of an axis. */
static ilk_request_t wish_after(const ilk_state_t* before, ilk_request_kind_t kind, uint32_t slot,
                                int32_t target_counts) {
  const ilk_axis_config_t* rules = &configuration.axis[slot];
  ilk_request_t request = request_after(before, kind, slot);
  request.target_counts = target_counts;
  if (kind == ILK_REQUEST_MOVE) {
    request.drive = ilk_drive_bound(rules, &before->axis[slot]);
    request.amplitude = rules->max_amplitude;
    request.lease_ticks = 1u;
  }
  request.crc = ilk_request_crc(&request);
  return request;
}

/** A frame that says what the last valid one said, fresh. */
static void repeat_frame(const ilk_state_t* before, uint32_t slot, uint32_t frame[ILK_FRAME_WORDS]) {
  const ilk_axis_t* axis = &before->axis[slot];
  uint32_t sum = 0u;
  for (uint32_t word = 0u; word < (uint32_t)ILK_FRAME_WORDS; word++) {
    frame[word] = 0u;
  }
  frame[0] = START_WORD;
  frame[2] = (axis->switch_triggered != 0u) ? 0u : SWITCH_OPEN_BIT;
  frame[3] = axis->raw;
  frame[9] = axis->heartbeat + 1u;
  frame[10] = axis->card_time_us + configuration.common.period_us;
  frame[11] = before->system.tick - 2u;
  frame[12] = axis->card_status;
  for (uint32_t word = 0u; word < ((uint32_t)ILK_FRAME_WORDS - 1u); word++) {
    sum += frame[word];
  }
  frame[ILK_FRAME_WORDS - 1] = FRAME_SUM - sum;
}

/** The next tick's inputs when nothing changes but the pedal: a card that was lost stays so, all others
 * answer. */
static void quiet_inputs(const ilk_state_t* before, bool pressed, ilk_inputs_t* in) {
  in->link_generation = before->system.link_generation;
  in->boot_nonce = 1u;
  in->deadlines_missed = 0u;
  in->transaction_done = 1u;
  in->frames_received = 0u;
  in->pedal_no_closed = flag_of(pressed);
  in->pedal_nc_closed = flag_of(!pressed);
  in->estop_loop_closed = flag_of(before->system.estop == 0u);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const bool lost = before->axis[slot].bad_frames >= configuration.common.bad_frame_limit;
    if (has_card(&configuration.axis[slot]) && !lost) {
      in->frames_received |= 1u << slot;
    }
    repeat_frame(before, slot, in->frame[slot]);
  }
}

/** One tick of the kernel in which the app is alive and perhaps asks for something. */
static void tick_with(ilk_state_t* now, bool pressed, const ilk_request_t* wish, ilk_outputs_t* out) {
  static ilk_inputs_t in;
  ilk_request_t requests[2] = {request_after(now, ILK_REQUEST_HEARTBEAT, 0u)};
  uint32_t count = 1u;
  requests[0].crc = ilk_request_crc(&requests[0]);
  quiet_inputs(now, pressed, &in);
  if (wish != NULL) {
    requests[1] = *wish;
    requests[1].sequence = requests[0].sequence + 1u;
    requests[1].crc = ilk_request_crc(&requests[1]);
    count = 2u;
  }
  ilk_step(&configuration, now, &in, requests, count, out);
}

/** Lets the operator release the pedal if that is needed, wait until power is up, then press it, until MOTION
 * begins or cannot. */
static void press_pedal(ilk_state_t* now, ilk_outputs_t* out) {
  const ilk_common_config_t* common = &configuration.common;
  const uint32_t most = common->power_up_ticks + (2u * common->pedal_debounce_ticks) + PEDAL_TICKS_BESIDES;
  for (uint32_t tick = 0u; (tick < most) && (now->system.mode == (uint32_t)ILK_MODE_READY); tick++) {
    const bool powered = now->system.powered_ticks >= common->power_up_ticks;
    tick_with(now, powered && (now->system.pedal_armed != 0u), NULL, out);
  }
}

/**
 * What the kernel would say to a MOVE or a HOME of the axis once the pedal is held, if nothing else changes
 * until then.
 *
 * The kernel itself runs ahead on a copy of the state: cards answer as they did, the app stays alive, the
 * E-stop stays as it is.
 *
 * @return bits 0 to 7 the verdict, 8 to 15 the gate in that tick, 16 to 23 the mode in which it was judged
 */
EXPORT("foresee") uint32_t page_foresee(uint32_t kind, uint32_t slot, int32_t target_counts) {
  static ilk_state_t ahead;
  static ilk_outputs_t out;
  if ((slot >= (uint32_t)ILK_SLOTS) || !has_axis(&configuration.axis[slot])) {
    return (uint32_t)ILK_VERDICT_AXIS;
  }
  ahead = state;
  press_pedal(&ahead, &out);
  const ilk_request_t wish = wish_after(&ahead, (ilk_request_kind_t)kind, slot, target_counts);
  tick_with(&ahead, true, &wish, &out);
  return out.verdict[1].verdict | (out.gate[slot] << 8u) | (ahead.system.mode << 16u);
}

/** What the kernel says to a request in the state that was written: its verdict. */
EXPORT("judge") uint32_t page_judge(uint32_t kind, uint32_t slot, int32_t target_counts) {
  const bool known = slot < (uint32_t)ILK_SLOTS;
  ilk_request_t request = wish_after(&state, (ilk_request_kind_t)kind, known ? slot : 0u, target_counts);
  request.axis = slot;
  request.crc = ilk_request_crc(&request);
  static ilk_state_t asked;
  asked = state;
  return ilk_request_take(&configuration, &request, &asked).verdict;
}

static ilk_gate_t gate_of(const ilk_state_t* supposed, uint32_t slot) {
  const ilk_axis_config_t* rules = &configuration.axis[slot];
  const ilk_axis_t* axis = &supposed->axis[slot];
  const ilk_command_t wanted = ilk_wanted_command(rules, axis);
  return ilk_output_gate(rules, &supposed->system, axis, &wanted);
}

/** 0 to 12: the gate that blocks the axis in the state that was written, OPEN when it may be driven. */
EXPORT("gate") uint32_t page_gate(uint32_t slot) {
  return (slot < (uint32_t)ILK_SLOTS) ? (uint32_t)gate_of(&state, slot) : (uint32_t)ILK_GATE_ENABLE;
}

/** Puts a move to the target in place of whatever the axis does. */
static void suppose_move(ilk_axis_t* axis, const ilk_axis_config_t* rules, int32_t target_counts) {
  axis->state = (uint32_t)ILK_AXIS_MOVING;
  axis->setpoint_counts = target_counts;
  axis->drive = ilk_drive_bound(rules, axis);
  axis->amplitude = rules->max_amplitude;
  axis->lease_ticks = 1u;
}

/** Supposes that a gate was opened by what opens it. False when that would tell nothing of the gates behind.
 */
static bool suppose_open(ilk_state_t* supposed, uint32_t slot, ilk_gate_t gate,
                         const int32_t* target_counts) {
  ilk_axis_t* axis = &supposed->axis[slot];
  bool opened = true;
  switch (gate) {
    case ILK_GATE_MODE:
      supposed->system.mode = (uint32_t)ILK_MODE_MOTION;
      axis->unhomed_travel_counts = 0u;
      break;
    case ILK_GATE_PEDAL:
      supposed->system.pedal = (uint32_t)ILK_PEDAL_PRESSED;
      break;
    case ILK_GATE_ESTOP:
      supposed->system.estop = 0u;
      break;
    case ILK_GATE_CARD:
      axis->card_valid = 1u;
      break;
    case ILK_GATE_ENABLE:
      axis->state = (uint32_t)ILK_AXIS_ENABLED;
      break;
    case ILK_GATE_LEASE:
      opened = target_counts != NULL;
      if (opened) {
        suppose_move(axis, &configuration.axis[slot], *target_counts);
      }
      break;
    default:
      /* What opens the gates of the wish itself is another wish. */
      opened = false;
      break;
  }
  return opened;
}

/**
 * The gates of the axis in their order: asks the kernel's gate, supposes that the one which blocks was
 * opened, and asks again.
 *
 * @param has_target 1: a move to `target_counts` waits, so that the gates behind LEASE can be judged
 * @return bits 0 to 15: gate n is closed; bits 16 to 31: gate n was judged
 */
EXPORT("walk_gates") uint32_t page_walk_gates(uint32_t slot, uint32_t has_target, int32_t target_counts) {
  static ilk_state_t supposed;
  uint32_t closed = 0u;
  uint32_t last_judged = (uint32_t)ILK_GATE_COUNT - 1u;
  if (slot >= (uint32_t)ILK_SLOTS) {
    return 0u;
  }
  supposed = state;
  /* A switch whose card was not read counts as triggered: nobody knows how it stands. */
  const bool switch_unknown = state.axis[slot].card_valid == 0u;
  for (uint32_t step = 0u; step < (uint32_t)ILK_GATE_COUNT; step++) {
    const ilk_gate_t gate = gate_of(&supposed, slot);
    if (gate == ILK_GATE_OPEN) {
      break;
    }
    if (switch_unknown && (gate >= ILK_GATE_HARD_LIMIT)) {
      last_judged = (uint32_t)ILK_GATE_SETPOINT;
      break;
    }
    closed |= 1u << (uint32_t)gate;
    if (!suppose_open(&supposed, slot, gate, (has_target != 0u) ? &target_counts : NULL)) {
      last_judged = (uint32_t)gate;
      break;
    }
  }
  return closed | (((2u << last_judged) - 1u) << 16u);
}
