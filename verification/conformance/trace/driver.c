/**
 * @file
 * Runs the kernel core against a small random world and tells Trace.tla what happened. The seed alone decides
 * the run.
 *
 * The world: a person at the pedal, an E-stop, an app that speaks, mumbles, falls silent and is replaced, a
 * card that drops frames, and a motor that moves, coasts, sticks, slips and drifts.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arith.h"
#include "interlock/kernel.h"
#include "told.h"

enum { GOOD, MISSING, CORRUPT, LATE, REPEATED, SPAN_TICKS = 60 };

static const char* const frame_name[] = {"GOOD", "MISSING", "CORRUPT", "LATE", "REPEATED"};
typedef struct {
  uint64_t dice;
  ilk_config_t config;
  ilk_state_t state;
  ilk_inputs_t in;
  ilk_outputs_t out;
  ilk_request_t request[2];
  uint32_t count;
  uint32_t counter;   /**< of the encoder */
  uint32_t heartbeat; /**< of the card */
  uint32_t sequence;
  int32_t place;  /**< where the axis truly is */
  int32_t speed;  /**< counts a tick */
  uint32_t span;  /**< ticks left of what the person and the motor are at */
  uint32_t pedal; /**< 0 released, 1 pressed, 2 split */
  bool sticks;
} world_t;

/** A number below `sides`, by a 64-bit linear congruential generator. */
static uint32_t roll(world_t* world, uint32_t sides) {
  world->dice = world->dice * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(world->dice >> 33) % sides;
}

static bool happens(world_t* world, uint32_t in_thousand) { return roll(world, 1000u) < in_thousand; }

static void configure(ilk_config_t* config) {
  *config = (ilk_config_t){.version = ILK_CONFIG_VERSION,
                           .size_bytes = sizeof *config,
                           .period_us = 1000u,
                           .pedal_channels = 2u,
                           .app_timeout_ticks = 8u,
                           .lease_max_ticks = 12u,
                           .pedal_debounce_ticks = 3u,
                           .pedal_disagree_ticks = 4u,
                           .bad_frame_limit = 3u,
                           .overrun_limit = 3u};
  config->axis[0] = (ilk_axis_config_t){.card = ILK_CARD_PWM,
                                        .required = 1u,
                                        .motor_direction = 1u,
                                        .limit_side = ILK_LIMIT_LOWER,
                                        .min_counts = -200,
                                        .max_counts = 200,
                                        .home_offset_counts = -190,
                                        .coast_counts = 6u,
                                        .backlash_counts = 1u,
                                        .noise_counts = 1u,
                                        .deadband_counts = 3u,
                                        .max_drive = 100u,
                                        .unhomed_max_drive = 10u,
                                        .unhomed_travel_counts = 40u,
                                        .home_drive = 10u,
                                        .home_travel_counts = 420u,
                                        .home_backoff_counts = 40u,
                                        .home_timeout_ticks = 400u,
                                        .home_rest_ticks = 3u,
                                        .home_speed_counts_per_s = 2000u,
                                        .stall_ticks = 15u,
                                        .stall_min_counts = 4u,
                                        .reverse_counts = 8u,
                                        .drift_counts = 8u,
                                        .settle_ticks = 5u,
                                        .max_delta_counts = 9u};
  config->crc = ilk_config_crc(config);
}

static void person(world_t* world) {
  if (world->span == 0u) {
    world->span = 5u + roll(world, SPAN_TICKS);
    world->pedal = happens(world, 30u) ? 2u : roll(world, 4u) != 0u;
    world->sticks = happens(world, 100u);
  }
  world->span--;
  world->in.pedal_no_closed = world->pedal == 0u ? 0u : 1u;
  world->in.pedal_nc_closed = world->pedal == 1u ? 0u : world->pedal == 2u && happens(world, 300u) ? 7u : 1u;
  world->in.estop_loop_closed = happens(world, 3u) ? roll(world, 3u) * 3u : 1u;
  world->in.deadline_missed = happens(world, 20u);
}

static void motor(world_t* world) {
  const ilk_command_t* command = &world->out.command[0];
  const int32_t wanted = (command->drive == 0u)                             ? 0
                         : (command->direction == ILK_DIRECTION_INCREASING) ? 4
                                                                            : -4;
  world->speed = world->sticks ? 0 : (world->speed + wanted) / 2;
  if (happens(world, 4u)) {
    world->speed = (int32_t)roll(world, 25u) - 12;
  }
  world->place += world->speed;
  world->counter += (uint32_t)world->speed;
}

static uint32_t card(world_t* world) {
  const uint32_t kind = happens(world, 30u) ? 1u + roll(world, 4u) : GOOD;
  uint32_t* frame = world->in.frame[0];
  uint32_t sum = 0u;
  world->heartbeat += (kind == REPEATED) ? 0u : 1u;
  memset(frame, 0, sizeof world->in.frame[0]);
  frame[0] = 0xfefefe01u;
  frame[2] = (world->place <= -190) ? 0u : 0x00080000u;
  frame[3] = world->counter;
  frame[9] = (kind == REPEATED) ? world->state.axis[0].heartbeat : world->heartbeat;
  frame[11] = world->state.tick - ((kind == LATE) ? 3u : 2u);
  for (uint32_t word = 0u; word < ILK_FRAME_WORDS - 1u; word++) {
    sum += frame[word];
  }
  frame[ILK_FRAME_WORDS - 1] = 0xffffffffu - sum - ((kind == CORRUPT) ? 1u : 0u);
  world->in.transaction_done = 1u;
  world->in.frames_received = (kind == MISSING) ? 0u : 1u;
  return (kind == LATE && world->state.tick < 2u) ? (uint32_t)GOOD : kind;
}

/** Adds a request; gives what the kernel's door must say of it. */
static const char* ask(world_t* world, uint32_t kind) {
  ilk_request_t* request = &world->request[world->count++];
  const char* door = "INTACT";
  *request = (ilk_request_t){.sequence = ++world->sequence,
                             .kind = kind,
                             .axis = happens(world, 10u) ? 9u : 0u,
                             .target_counts = (int32_t)roll(world, 420u) - 210,
                             .drive = 1u + roll(world, 12u),
                             .lease_ticks = roll(world, 14u),
                             .holder = 1u + happens(world, 3u)};
  if (world->state.axis[0].homed == 0u && happens(world, 700u)) {
    request->target_counts = world->state.axis[0].position_counts + (int32_t)roll(world, 60u) - 30;
  }
  if (happens(world, 10u)) {
    request->sequence = world->state.last_sequence;
    world->sequence--;
    door = "SEQUENCE";
  }
  request->crc = ilk_request_crc(request);
  if (happens(world, 10u)) {
    request->crc ^= 1u;
    door = "CHECKSUM";
  }
  return door;
}

static uint32_t wish(world_t* world) {
  const ilk_state_t* state = &world->state;
  uint32_t kind = happens(world, 950u) ? ILK_REQUEST_MOVE : roll(world, 11u);
  if (state->mode == ILK_MODE_LOCKED) {
    kind = ILK_REQUEST_RESET;
  } else if (state->axis[0].state == ILK_AXIS_FAULTED) {
    kind = ILK_REQUEST_CLEAR_FAULT;
  } else if (state->axis[0].state == ILK_AXIS_DISABLED) {
    kind = ILK_REQUEST_ENABLE;
  } else if (state->axis[0].homed == 0u && happens(world, 100u)) {
    kind = ILK_REQUEST_HOME;
  }
  return happens(world, 20u) ? roll(world, 11u) : kind;
}

static void tick(world_t* world, bool first) {
  const char* door[2] = {"", ""};
  world->count = 0u;
  person(world);
  motor(world);
  told_tick_t told = {.attached = happens(world, 2u)};
  if (told.attached) {
    world->in.link_generation++;
    world->sequence = 0u;
  }
  told.reading[0].frame = frame_name[card(world)];
  if (happens(world, 900u)) {
    door[0] = ask(world, ILK_REQUEST_HEARTBEAT);
  }
  if (happens(world, 400u)) {
    const uint32_t place = world->count;
    door[place] = ask(world, wish(world));
  }
  told.config_pass = world->state.config_slice == (uint32_t)ILK_SLOTS - 1u ? "AGREES" : "NONE";
  told.reading[0].moved =
      world->state.axis[0].card_seen != 0u ? signed_of(world->counter - world->state.axis[0].raw) : 0;
  told.reading[0].at_switch = world->place <= -190;
  ilk_step(&world->config, &world->state, &world->in, world->request, world->count, &world->out);
  told_tick(stdout, &world->config, &told, &world->in, world->request, door, world->count, &world->state,
            &world->out, first);
}

int main(int count, char** arguments) {
  if (count != 3) {
    (void)fprintf(stderr, "usage: trace_driver SEED TICKS\n");
    return 2;
  }
  static world_t world;
  world.dice = strtoull(arguments[1], NULL, 10);
  configure(&world.config);
  const ilk_config_verdict_t verdict = ilk_init(&world.config, &world.state);
  if (verdict.error != ILK_CONFIG_ERROR_NONE) {
    (void)fprintf(stderr, "the kernel refuses the configuration of the trace: error %u\n", verdict.error);
    return 1;
  }
  told_begin(stdout, &world.config, &world.state, true);
  for (long number = 0; number < strtol(arguments[2], NULL, 10); number++) {
    tick(&world, number == 0);
  }
  told_end(stdout);
  return 0;
}
