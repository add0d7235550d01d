#include "world.h"

#include "parts.h"

#define START_WORD 0xfefefe01u
#define SWITCH_OPEN_BIT 0x00080000u
#define STATUS_WAS_RESET 8u
#define RANGE_COUNTS 1000
#define BOOT_NONCE 0x5eed5eedu

uint32_t dice_word(dice_t *dice) {
  uint32_t word = dice->word;
  word ^= word << 13;
  word ^= word >> 17;
  word ^= word << 5;
  dice->word = word;
  return word;
}

uint32_t dice_below(dice_t *dice, uint32_t bound) { return (dice_word(dice) >> 8) % bound; }

bool dice_one_in(dice_t *dice, uint32_t chances) { return dice_below(dice, chances) == 0u; }

static void set_up_axis(ilk_axis_config_t *axis, ilk_card_t card, ilk_limit_side_t side) {
  axis->card = (uint32_t)card;
  axis->motor_direction = 1u;
  axis->limit_side = (uint32_t)side;
  axis->min_counts = -RANGE_COUNTS;
  axis->max_counts = RANGE_COUNTS;
  axis->coast_counts = 10u;
  axis->backlash_counts = 1u;
  axis->noise_counts = 1u;
  axis->deadband_counts = 2u;
  axis->dead_zone_drive = 10u;
  axis->max_drive = 1000u;
  axis->unhomed_max_drive = 100u;
  axis->unhomed_travel_counts = 100u;
  axis->full_speed_counts_per_s = 5000u;
  axis->stall_ticks = 50u;
  axis->stall_effort_ticks = 20u;
  axis->stall_min_counts = 2u;
  axis->reverse_counts = 20u;
  axis->drift_counts = 20u;
  axis->rest_ticks = 10u;
  axis->max_delta_counts = 8u;
  if (card == ILK_CARD_HIGH_FREQUENCY) {
    axis->max_amplitude = 200u;
    axis->home_amplitude = 80u;
  }
  if (side != ILK_LIMIT_NONE) {
    axis->home_offset_counts = (side == ILK_LIMIT_LOWER) ? -980 : 980;
    axis->home_drive = 50u;
    axis->home_slow_drive = 20u;
    axis->home_travel_counts = 2400u;
    axis->home_timeout_ticks = 3000u;
    axis->home_clear_counts = 30u;
    axis->home_tolerance_counts = 8u;
    axis->switch_hysteresis_counts = 2u;
    axis->home_speed_counts_per_s = 1000u;
    axis->home_slow_speed_counts_per_s = 500u;
  }
}

void world_config(ilk_config_t *config) {
  static const ilk_config_t blank = {0};
  *config = blank;
  config->common = (ilk_common_config_t){.version = ILK_CONFIG_VERSION,
                                         .size_bytes = (uint32_t)sizeof(ilk_config_t),
                                         .period_us = 1000u,
                                         .pedal_channels = 2u,
                                         .app_timeout_ticks = 30u,
                                         .lease_max_ticks = 20u,
                                         .pedal_debounce_ticks = 5u,
                                         .pedal_disagree_ticks = 8u,
                                         .power_up_ticks = 10u,
                                         .switch_debounce_ticks = 3u,
                                         .bad_frame_limit = 3u,
                                         .overrun_limit = 3u};
  set_up_axis(&config->axis[0], ILK_CARD_PWM, ILK_LIMIT_LOWER);
  set_up_axis(&config->axis[1], ILK_CARD_PWM, ILK_LIMIT_NONE);
  set_up_axis(&config->axis[2], ILK_CARD_NON_PWM, ILK_LIMIT_UPPER);
  set_up_axis(&config->axis[3], ILK_CARD_NON_PWM, ILK_LIMIT_LOWER);
  set_up_axis(&config->axis[4], ILK_CARD_ANALOG, ILK_LIMIT_UPPER);
  set_up_axis(&config->axis[5], ILK_CARD_HIGH_FREQUENCY, ILK_LIMIT_LOWER);
  set_up_axis(&config->axis[6], ILK_CARD_NON_PWM, ILK_LIMIT_LOWER);
  set_up_axis(&config->axis[7], ILK_CARD_PWM, ILK_LIMIT_UPPER);
  config->axis[3].motor_direction = 0u;
  config->axis[6].direction_correction = 1u;
  config->axis[7].direction_correction = 1u;
  config->axis[8].card = (uint32_t)ILK_CARD_SENSOR;
  config->axis[8].required = 1u;
  config->crc = ilk_config_crc(config);
}

void world_begin(world_t *world, uint32_t seed) {
  static const world_t blank = {0};
  *world = blank;
  world->dice.word = seed;
}

static void write_checksum(uint32_t frame[ILK_FRAME_WORDS]) {
  uint32_t sum = 0u;
  for (uint32_t word = 0u; word < ((uint32_t)ILK_FRAME_WORDS - 1u); word++) {
    sum += frame[word];
  }
  frame[ILK_FRAME_WORDS - 1] = 0xffffffffu - sum;
}

/** One tick less of what lasts; true while it does. */
static bool lasts(uint32_t *ticks) {
  const bool still = *ticks != 0u;
  *ticks -= still ? 1u : 0u;
  return still;
}

static void follow_command(world_t *world, uint32_t slot, const ilk_command_t *command) {
  const int32_t step = 1 + (int32_t)dice_below(&world->dice, 3u);
  if (dice_one_in(&world->dice, 20000u)) {
    world->jammed_ticks[slot] = 100u;
  }
  if (lasts(&world->jammed_ticks[slot])) {
    /* It does not follow. */
  } else if (dice_one_in(&world->dice, 40000u)) {
    world->place[slot] += dice_one_in(&world->dice, 2u) ? 40 : -40;
  } else if (dice_one_in(&world->dice, 40000u)) {
    world->misread_ticks[slot] = 1u + dice_below(&world->dice, 6u);
  } else if (dice_one_in(&world->dice, 40000u)) {
    world->reset_ticks[slot] = 100u;
  } else if (dice_one_in(&world->dice, 30000u)) {
    world->slipping_ticks[slot] = 10u;
  } else if (lasts(&world->slipping_ticks[slot])) {
    world->place[slot] -= 7;
  } else if (command->direction == (uint32_t)ILK_DIRECTION_INCREASING) {
    world->place[slot] += step;
  } else if (command->direction == (uint32_t)ILK_DIRECTION_DECREASING) {
    world->place[slot] -= step;
  } else {
    /* At rest. */
  }
}

static bool at_switch(const ilk_axis_config_t *axis, int32_t place) {
  const bool lower = (axis->limit_side == (uint32_t)ILK_LIMIT_LOWER) && (place <= -RANGE_COUNTS / 4);
  const bool upper = (axis->limit_side == (uint32_t)ILK_LIMIT_UPPER) && (place >= RANGE_COUNTS / 4);
  return lower || upper;
}

static void write_frame(world_t *world, const ilk_axis_config_t *axis, uint32_t slot, uint32_t tick,
                        uint32_t frame[ILK_FRAME_WORDS]) {
  const uint32_t place = (uint32_t)world->place[slot];
  for (uint32_t word = 0u; word < (uint32_t)ILK_FRAME_WORDS; word++) {
    frame[word] = 0u;
  }
  frame[0] = START_WORD;
  const bool misread = lasts(&world->misread_ticks[slot]);
  frame[2] = (at_switch(axis, world->place[slot]) != misread) ? 0u : SWITCH_OPEN_BIT;
  frame[3] = 5000u + ((axis->direction_correction != 0u) ? (0u - place) : place);
  frame[9] = world->heartbeat;
  frame[10] = tick * 1000u;
  frame[11] = tick - 2u;
  frame[12] = lasts(&world->reset_ticks[slot]) ? STATUS_WAS_RESET : 0u;
  write_checksum(frame);
  if (dice_one_in(&world->dice, 3000u)) {
    frame[dice_below(&world->dice, (uint32_t)ILK_FRAME_WORDS)] ^= 1u << dice_below(&world->dice, 32u);
  }
}

/** The hand lets go soon of a pedal under which nothing can move. */
static void move_hand(world_t *world, const ilk_state_t *state, ilk_inputs_t *in) {
  const bool may_move =
      (state->system.mode == (uint32_t)ILK_MODE_MOTION) || (state->system.pedal_armed != 0u);
  if (world->pressed && !may_move && (world->pedal_ticks > 20u)) {
    world->pedal_ticks = 20u;
  }
  if (world->pedal_ticks == 0u) {
    world->pressed = !world->pressed;
    world->pedal_ticks = 20u + dice_below(&world->dice, world->pressed ? 900u : 40u);
  }
  world->pedal_ticks--;
  in->pedal_no_closed = world->pressed ? 1u : 0u;
  in->pedal_nc_closed = world->pressed ? 0u : 1u;
  if (dice_one_in(&world->dice, 4000u)) {
    world->loose_ticks = dice_below(&world->dice, 12u);
  }
  if (lasts(&world->loose_ticks)) {
    in->pedal_no_closed = dice_one_in(&world->dice, 2u) ? 2u : in->pedal_nc_closed;
  }
}

static void work_estop(world_t *world, ilk_inputs_t *in) {
  if (dice_one_in(&world->dice, 8000u)) {
    world->estop_ticks = 1u + dice_below(&world->dice, 20u);
  }
  in->estop_loop_closed = lasts(&world->estop_ticks) ? 0u : 1u;
}

void world_inputs(world_t *world, const ilk_config_t *config, const ilk_state_t *state,
                  const ilk_outputs_t *out, ilk_inputs_t *in) {
  world->heartbeat++;
  in->link_generation = 1u;
  in->boot_nonce = BOOT_NONCE;
  if (dice_one_in(&world->dice, 3000u)) {
    world->late_ticks = dice_below(&world->dice, 5u);
  }
  in->deadlines_missed = lasts(&world->late_ticks) ? 1u : 0u;
  in->transaction_done = dice_one_in(&world->dice, 2000u) ? 0u : 1u;
  if (dice_one_in(&world->dice, 5000u)) {
    world->deaf_ticks = dice_below(&world->dice, 6u);
    world->deaf_slots = dice_one_in(&world->dice, 8u) ? UINT32_MAX : (1u << dice_below(&world->dice, 10u));
  }
  in->frames_received = lasts(&world->deaf_ticks) ? ~world->deaf_slots : UINT32_MAX;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    follow_command(world, slot, &out->command[slot]);
    write_frame(world, &config->axis[slot], slot, state->system.tick, in->frame[slot]);
  }
  move_hand(world, state, in);
  work_estop(world, in);
}

/** What an axis in that state may be asked for next. */
static uint32_t sensible_kind(dice_t *dice, const ilk_state_t *state, const ilk_axis_t *axis) {
  uint32_t kind = (uint32_t)ILK_REQUEST_MOVE;
  if (axis->state == (uint32_t)ILK_AXIS_FAULTED) {
    kind = (uint32_t)ILK_REQUEST_CLEAR_FAULT;
  } else if (state->system.mode == (uint32_t)ILK_MODE_READY) {
    static const ilk_request_kind_t kinds[4] = {ILK_REQUEST_ENABLE, ILK_REQUEST_ENABLE, ILK_REQUEST_SET_HOME,
                                                ILK_REQUEST_RESTORE};
    kind = (uint32_t)kinds[dice_below(dice, 4u)];
  } else if (axis->state == (uint32_t)ILK_AXIS_DISABLED) {
    kind = (uint32_t)ILK_REQUEST_ENABLE;
  } else if (dice_one_in(dice, (axis->homed == (uint32_t)ILK_HOMED_NOT) ? 5u : 400u)) {
    kind = (uint32_t)ILK_REQUEST_HOME;
  } else {
    kind = (uint32_t)ILK_REQUEST_MOVE;
  }
  return kind;
}

static void fill_request(world_t *world, const ilk_config_t *config, const ilk_state_t *state,
                         ilk_request_t *request) {
  dice_t *dice = &world->dice;
  const uint32_t slot = dice_below(dice, (uint32_t)ILK_SLOTS);
  const ilk_axis_config_t *axis = &config->axis[slot];
  request->kind = sensible_kind(dice, state, &state->axis[slot]);
  request->axis = slot;
  request->target_counts = (int32_t)dice_below(dice, 2400u) - 1200;
  request->drive = dice_below(dice, 2u) * dice_below(dice, axis->max_drive + 20u) + dice_below(dice, 100u);
  request->amplitude = dice_below(dice, axis->max_amplitude + 1u);
  request->lease_ticks = dice_below(dice, 22u);
  request->consent = state->system.consent ^ (dice_one_in(dice, 100u) ? 1u : 0u);
  request->holder = 1u + (dice_one_in(dice, 4000u) ? 1u : 0u);
  if (state->system.mode == (uint32_t)ILK_MODE_LOCKED) {
    request->kind = (uint32_t)ILK_REQUEST_RESET;
  }
  if (dice_one_in(dice, 300u)) {
    request->kind = dice_below(dice, 13u);
    request->axis = dice_below(dice, 12u);
  }
}

uint32_t world_requests(world_t *world, const ilk_config_t *config, const ilk_state_t *state,
                        ilk_request_t requests[ILK_REQUESTS_PER_TICK]) {
  dice_t *dice = &world->dice;
  if (dice_one_in(dice, 6000u)) {
    world->silent_ticks = 40u;
  }
  uint32_t count = 0u;
  if (!lasts(&world->silent_ticks)) {
    count = 1u + dice_below(dice, 5u);
  }
  for (uint32_t index = 0u; index < count; index++) {
    ilk_request_t *request = &requests[index];
    fill_request(world, config, state, request);
    if (index == 0u) {
      request->kind = (uint32_t)ILK_REQUEST_HEARTBEAT;
    }
    world->sequence++;
    request->sequence = dice_one_in(dice, 700u) ? 1u : world->sequence;
    request->crc = ilk_request_crc(request);
    if (dice_one_in(dice, 500u)) {
      request->drive ^= 1u;
    }
  }
  return count;
}

/** Any words, most of them small, and more often than not near to what the rules compare them with. */
static void any_axis(dice_t *dice, const ilk_axis_config_t *config, uint32_t tick, ilk_axis_t *axis) {
  const uint32_t wiring = axis->wiring;
  uint32_t *words = &axis->state;
  for (uint32_t word = 0u; word < (uint32_t)(sizeof(ilk_axis_t) / sizeof(uint32_t)); word++) {
    words[word] = dice_one_in(dice, 3u) ? dice_word(dice) : dice_below(dice, 60u);
  }
  /* Another wiring than the configuration's locks at once, and nothing else of the state would matter. */
  axis->wiring = dice_one_in(dice, 200u) ? dice_word(dice) : wiring;
  axis->state = dice_below(dice, ILK_AXIS_COUNT);
  axis->fault =
      (axis->state == (uint32_t)ILK_AXIS_FAULTED) ? (1u + dice_below(dice, ILK_FAULT_COUNT - 1u)) : 0u;
  axis->fault_tick = tick - dice_below(dice, 2u);
  axis->runaway = dice_one_in(dice, 40u) ? 1u : 0u;
  axis->lease_ticks = dice_below(dice, 20u);
  axis->homing_phase = dice_below(dice, ILK_HOMING_COUNT);
  axis->homed = dice_below(dice, ILK_HOMED_COUNT);
  axis->driven_direction = dice_below(dice, ILK_DIRECTION_COUNT);
  axis->stall_direction = dice_below(dice, ILK_DIRECTION_COUNT);
  axis->reverse_direction = dice_below(dice, ILK_DIRECTION_COUNT);
  axis->bad_frames = dice_below(dice, 4u);
  axis->card_seen = dice_below(dice, 2u);
  axis->card_status = 0u;
  axis->heartbeat = tick;
  axis->periods = dice_below(dice, 3u);
  axis->position_counts = (int32_t)dice_below(dice, 2200u) - 1100;
  axis->setpoint_counts = dice_one_in(dice, 2u)
                              ? (axis->position_counts + (int32_t)dice_below(dice, 100u) - 50)
                              : ((int32_t)dice_below(dice, 2000u) - 1000);
  axis->raw = 5000u + dice_below(dice, 12u);
  axis->rest = (ilk_stillness_t){.origin_raw = axis->raw, .ticks = dice_below(dice, config->rest_ticks + 1u)};
  axis->calm = axis->rest;
  axis->stall_driven_ticks = dice_below(dice, config->stall_ticks + 2u);
  axis->effort_high = 0u;
  axis->effort_low = dice_below(dice, 21000u);
  axis->stall_mark_raw = axis->raw - dice_below(dice, 12u);
  axis->effort_mark_raw = axis->raw - dice_below(dice, 12u);
  axis->reverse_mark_raw = axis->raw - dice_below(dice, 12u);
  axis->drift_mark_raw = axis->raw - dice_below(dice, 12u);
  axis->path_raw = axis->raw - dice_below(dice, 6u);
  axis->path_is_homing = dice_below(dice, 2u);
  axis->unhomed_travel_counts = dice_below(dice, 120u);
  axis->homing_travel_counts = dice_one_in(dice, 2u) ? 2400u : dice_below(dice, 2420u);
  axis->homing_ticks = dice_below(dice, 3010u);
  axis->homing_mark_raw = axis->raw - dice_below(dice, 60u);
  axis->first_edge_raw = axis->homing_mark_raw + dice_below(dice, 10u);
  axis->switch_run_ticks = dice_below(dice, 4u);
  axis->switch_reading = dice_below(dice, 2u);
  axis->implausible_ticks = dice_below(dice, 3u);
  axis->drive = dice_below(dice, config->unhomed_max_drive + 20u);
  axis->amplitude = dice_below(dice, config->max_amplitude + 2u);
}

static void any_system(dice_t *dice, const ilk_config_t *config, ilk_system_t *system) {
  system->tick = 100u + dice_below(dice, 100000u);
  system->frames_sent = ILK_LATENCY_TICKS;
  system->mode = dice_one_in(dice, 2u) ? (uint32_t)ILK_MODE_MOTION : (1u + dice_below(dice, 3u));
  const bool locked = system->mode == (uint32_t)ILK_MODE_LOCKED;
  system->mode = dice_one_in(dice, 100u) ? (uint32_t)ILK_MODE_INIT : system->mode;
  system->cause = locked ? (1u + dice_below(dice, ILK_CAUSE_COUNT - 1u)) : (uint32_t)ILK_CAUSE_NONE;
  system->consent = dice_word(dice);
  system->powered_ticks = dice_below(dice, config->common.power_up_ticks + 1u);
  system->pedal = dice_below(dice, ILK_PEDAL_COUNT);
  system->pedal_armed = dice_below(dice, 2u);
  system->pedal_pressed_ticks = dice_below(dice, 6u);
  system->pedal_released_ticks = dice_below(dice, 6u);
  system->pedal_disagree_ticks = dice_below(dice, 10u);
  system->app_age_ticks = dice_below(dice, 32u);
  system->overruns_in_row = dice_below(dice, 4u);
  system->bus_bad_ticks = dice_below(dice, 4u);
  system->config_slice = dice_below(dice, (uint32_t)ILK_SLOTS);
  system->config_partial_crc = dice_word(dice);
  system->link_generation = 1u;
  system->holder = dice_below(dice, 3u);
}

static void flip_a_bit(dice_t *dice, ilk_state_t *state) {
  uint32_t *words = &state->system.tick;
  words[dice_below(dice, (uint32_t)(sizeof(ilk_state_t) / sizeof(uint32_t)))] ^= 1u << dice_below(dice, 32u);
}

bool world_any_state(dice_t *dice, const ilk_config_t *config, ilk_state_t *state) {
  (void)ilk_init(config, state);
  any_system(dice, config, &state->system);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    any_axis(dice, &config->axis[slot], state->system.tick, &state->axis[slot]);
  }
  ilk_state_seal(state);
  const bool sound = !dice_one_in(dice, 200u);
  if (!sound) {
    flip_a_bit(dice, state);
  }
  return sound;
}
