/**
 * @file
 * Runs the kernel core against a small random world and prints what happened as the TLA+ sequence that
 * Trace.tla reads: one tuple a tick, inputs first, then what the kernel did. The seed alone decides the run.
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

enum { GOOD, MISSING, CORRUPT, LATE, REPEATED, SPAN_TICKS = 60 };

static const char* const frame_name[] = {"GOOD", "MISSING", "CORRUPT", "LATE", "REPEATED"};
static const char* const contact_name[] = {"OPEN", "CLOSED", "INVALID"};
static const char* const pedal_name[] = {"RELEASED", "PRESSED", "DISAGREE"};
static const char* const mode_name[] = {"INIT", "LOCKED", "READY", "MOTION"};
static const char* const cause_name[] = {"NONE", "BOOT", "ESTOP", "BUS", "PEDAL", "INTEGRITY", "OVERRUN"};
static const char* const state_name[] = {"DISABLED", "ENABLED", "MOVING", "HOMING", "FAULTED"};
static const char* const fault_name[] = {"NONE", "STALL",     "REVERSE",       "DRIFT",
                                         "JUMP", "CARD_LOST", "HOMING_TRAVEL", "HOMING_TIMEOUT"};
static const char* const direction_name[] = {"NONE", "INCREASING", "DECREASING"};
static const char* const phase_name[] = {"NONE", "BACK_OFF", "SEEK", "REST"};
static const char* const kind_name[] = {"NONSENSE",    "HEARTBEAT", "STOP", "RESET",    "DISABLE", "ENABLE",
                                        "CLEAR_FAULT", "MOVE",      "HOME", "SET_HOME", "RESTORE"};
static const char* const verdict_name[] = {
    "ACCEPTED", "CHECKSUM", "SEQUENCE", "UNKNOWN", "AXIS",  "MODE",  "PEDAL_DOWN", "CAUSE_PRESENT", "FAULTED",
    "CARD",     "NO_FAULT", "DISABLED", "BUSY",    "LEASE", "DRIVE", "RANGE",      "NO_SWITCH"};
static const char* const gate_name[] = {"OPEN",       "MODE",       "PEDAL",          "ESTOP",
                                        "CARD",       "ENABLE",     "LEASE",          "SETPOINT",
                                        "HARD_LIMIT", "SOFT_LIMIT", "UNHOMED_TRAVEL", "DRIVE"};

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

static const char* yes(bool holds) { return holds ? "TRUE" : "FALSE"; }

static const char* contact(uint32_t word) { return contact_name[word > 2u ? 2u : word]; }

static uint32_t least(uint32_t a, uint32_t b) { return a < b ? a : b; }

static int32_t since(const world_t* world, uint32_t mark) {
  return travel_between(&world->config.axis[0], mark, world->state.axis[0].raw);
}

static void print_system(const world_t* world) {
  const ilk_state_t* s = &world->state;
  const ilk_config_t* c = &world->config;
  printf("<<\"%s\",\"%s\",{", mode_name[s->mode], cause_name[s->cause]);
  const char* comma = "";
  for (uint32_t cause = 1u; cause < ILK_CAUSE_COUNT; cause++) {
    if (((s->causes_seen >> cause) & 1u) != 0u) {
      printf("%s\"%s\"", comma, cause_name[cause]);
      comma = ",";
    }
  }
  printf("},\"%s\",%s,%u,%u,%u,%s,%u,%s,%u,%u,%u,%s>>", pedal_name[s->pedal], yes(s->pedal_armed != 0u),
         s->pedal_pressed_ticks, s->pedal_released_ticks,
         least(s->pedal_disagree_ticks, c->pedal_disagree_ticks + 1u), yes(s->estop != 0u),
         least(s->app_age_ticks, c->app_timeout_ticks), yes(s->app_alive != 0u), s->holder,
         least(s->overruns_in_row, c->overrun_limit), least(s->bus_bad_ticks, c->bad_frame_limit),
         yes(s->config_sound != 0u));
}

static void print_axis(const world_t* world) {
  const ilk_axis_t* a = &world->state.axis[0];
  const uint32_t limit = world->config.bad_frame_limit;
  printf(
      "<<\"%s\",\"%s\",%s,%s,%s,%s,%u,%u,%d,%d,%d,%u,%u,\"%s\",%d,%u,%d,\"%s\",%s,%d,\"%s\",%d,%u,\"%s\",%u,%"
      "d,%u>>",
      state_name[a->state], fault_name[a->fault], yes(a->homed != 0u), yes(a->switch_triggered != 0u),
      yes(a->card_valid != 0u), yes(a->card_seen != 0u), least(a->bad_frames, limit),
      least(a->ticks_since_frame, limit), a->position_counts, a->delta_counts, a->setpoint_counts, a->drive,
      a->lease_ticks, direction_name[a->driven_direction], a->press_travel_counts,
      least(a->stall_driven_ticks, world->config.axis[0].stall_ticks), since(world, a->stall_mark_raw),
      direction_name[a->stall_direction], yes(a->setpoint_changed != 0u), since(world, a->reverse_mark_raw),
      direction_name[a->reverse_direction], since(world, a->drift_mark_raw), a->undriven_ticks,
      phase_name[a->homing_phase], a->homing_ticks, since(world, a->homing_mark_raw), a->rest_ticks);
}

static void tick(world_t* world, long number) {
  const char* door[2] = {"", ""};
  world->count = 0u;
  person(world);
  motor(world);
  const bool attached = happens(world, 2u);
  if (attached) {
    world->in.link_generation++;
    world->sequence = 0u;
  }
  const uint32_t frame = card(world);
  if (happens(world, 900u)) {
    door[0] = ask(world, ILK_REQUEST_HEARTBEAT);
  }
  if (happens(world, 400u)) {
    const uint32_t place = world->count;
    door[place] = ask(world, wish(world));
  }
  const bool pass_ends = world->state.config_slice == (uint32_t)ILK_SLOTS - 1u;
  const int32_t moved = signed_of(world->counter - world->state.axis[0].raw);
  ilk_step(&world->config, &world->state, &world->in, world->request, world->count, &world->out);
  printf("%s<<<<\"%s\",\"%s\",\"%s\",%s,%s,\"%s\",\"%s\",%d,%s>>,<<", number == 0 ? "" : ",\n",
         contact(world->in.pedal_no_closed), contact(world->in.pedal_nc_closed),
         contact(world->in.estop_loop_closed), yes(world->in.deadline_missed != 0u), yes(attached),
         pass_ends ? "AGREES" : "NONE", frame_name[frame], world->state.axis[0].card_seen != 0u ? moved : 0,
         yes(world->place <= -190));
  for (uint32_t i = 0u; i < world->count; i++) {
    const ilk_request_t* request = &world->request[i];
    printf("%s<<\"%s\",\"%s\",%u,%d,%u,%u,%u,\"%s\">>", i == 0u ? "" : ",", door[i], kind_name[request->kind],
           request->axis, request->target_counts, request->drive, request->lease_ticks, request->holder,
           verdict_name[world->out.verdict[i].verdict]);
  }
  printf(">>,");
  print_system(world);
  printf(",");
  print_axis(world);
  printf(",<<\"%s\",\"%s\",%u>>>>", gate_name[world->out.gate[0]],
         direction_name[world->out.command[0].direction], world->out.command[0].drive);
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
  printf("---- MODULE TraceData ----\nEXTENDS Integers\nTrace == <<\n");
  for (long number = 0; number < strtol(arguments[2], NULL, 10); number++) {
    tick(&world, number);
  }
  printf("\n>>\n====\n");
  return 0;
}
