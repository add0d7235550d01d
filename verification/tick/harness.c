/**
 * @file
 * The tick of the kernel, as shipped, cut before its requests. See tick.h.
 */
#include "step.c"
#include "tick.h"

ilk_config_t config;
ilk_state_t state;
ilk_inputs_t in;
ilk_outputs_t out;
ilk_request_t requests[1];

ilk_config_t nondet_config(void);
ilk_state_t nondet_state(void);
ilk_inputs_t nondet_inputs(void);
ilk_request_t nondet_request(void);
uint32_t nondet_word(void);
ilk_verdict_record_t nondet_verdict(void);
ilk_config_verdict_t nondet_validity(void);

static uint32_t asked; /**< how many requests come: nothing but phase 6 may look */
static ilk_request_t many[ILK_REQUESTS_PER_TICK];
static ilk_verdict_record_t answers[ILK_REQUESTS_PER_TICK];

/* --- Stand-ins for functions with a proof of their own
 * ------------------------------------------------------ */

/** The digest of words is a function of them; no other property of it is needed. */
uint32_t stand_in_digest(const unsigned char bytes[], uint32_t words) {
  (void)bytes;
  (void)words;
  return 1u;
}

/** So is the CRC. The words that it is compared with are arbitrary. */
uint32_t stand_in_crc(uint32_t crc, const unsigned char bytes[], uint32_t words) {
  (void)crc;
  (void)bytes;
  (void)words;
  return 1u;
}

/** What a frame says, and for each frame whether its checksum is right. The step `reading` shows it of both
 * sides. */
ilk_reading_t stand_in_unpack(const uint32_t frame[ILK_FRAME_WORDS]) {
  const ilk_reading_t reading = {.intact = (frame[0] == 0xFEFEFE01u) && stand_in_checksum(frame),
                                 .switch_triggered = (frame[2] & 0x00080000u) == 0u,
                                 .raw = frame[3],
                                 .heartbeat = frame[9],
                                 .card_time_us = frame[10],
                                 .tick_echo = frame[11],
                                 .card_status = frame[12]};
  return reading;
}

static ilk_config_verdict_t validation;

/** What validation says of the configuration: anything, but the same whenever it is asked. */
ilk_config_verdict_t stand_in_validate(const ilk_config_t* c) {
  (void)c;
  return validation;
}

/** The frequency word is a function of the drive. */
uint32_t __CPROVER_uninterpreted_frequency(uint32_t drive);
uint32_t stand_in_frequency(uint32_t drive) { return __CPROVER_uninterpreted_frequency(drive); }

/** The number of a press is a function of nonce and tick. The step `numbers` shows what else is taken of it.
 */
uint32_t stand_in_consent(uint32_t boot_nonce, uint32_t tick) {
  const uint32_t number = number_of(boot_nonce, tick);
  __CPROVER_assume(tick == 0u || number != 0u);
  __CPROVER_assume(tick == 0u || !is_number_of_another(boot_nonce, tick, number));
  return number;
}

/* --- The cut
 * ------------------------------------------------------------------------------------------------ */

static ilk_state_t end;

/** Phase 6 is given what the tick was given. */
static void expect_handed_on(const ilk_config_t* c, const ilk_request_t r[], uint32_t count,
                             const ilk_outputs_t* o, const ilk_outputs_t* expected) {
  __CPROVER_assert(c == &config && r == requests && count == asked && o == expected,
                   "P11: the requests of the tick are answered, and no others");
}

/** What the snapshot will say after this tick: that of any state that requests can lead to. */
static void some_future(void) {
  end = nondet_state();
  __CPROVER_assume(may_follow(&state, &end));
  see_after(&end);
}

/** Phases 1 to 5 have led to M; the rest of this tick is the business of B and C. */
void cut_after_observation(const ilk_config_t* c, const ilk_request_t r[], uint32_t count, ilk_state_t* s,
                           ilk_outputs_t* o) {
  expect_handed_on(c, r, count, o, &out);
  __CPROVER_assert(s == &state, "of this robot");
  some_future();
  judge_inputs();
  relate(false, true, LEMMAS);
  relate(true, true, SHOWN);
  claim_home();
  __CPROVER_assume(false);
}

/** Any state that satisfies M, whatever came before; all requests are answered. */
void cut_before_drive(const ilk_config_t* c, const ilk_request_t r[], uint32_t count, ilk_state_t* s,
                      ilk_outputs_t* o) {
  expect_handed_on(c, r, count, o, &out);
  __CPROVER_assert(s == &state, "of this robot");
  state = nondet_state();
  some_memory();
  see_after(&state);
  relate(false, true, GIVEN);
}

/* --- The three steps
 * ---------------------------------------------------------------------------------------- */

static void tick_begins(void) {
  config = nondet_config();
  validation = nondet_validity();
  in = nondet_inputs();
  asked = nondet_word();
  requests[0] = nondet_request();
  __CPROVER_assume(config_is_valid());
  state = nondet_state();
  some_memory();
  see_before();
  __CPROVER_assume(((GIVEN)&PRESS) == 0u || may_be_this_tick());
}

/** Init leads to R. */
void initially(void) {
  config = nondet_config();
  validation = nondet_validity();
  __CPROVER_assume(config_is_valid());
  __CPROVER_assume(ilk_init(&config, &state).error == ILK_CONFIG_ERROR_NONE);
  first_memory();
  relate(true, false, SHOWN);
}

void observation(void) {
  tick_begins();
  relate(false, false, GIVEN);
  begin_judging();
  ilk_step(&config, &state, &in, requests, asked, &out);
}

#ifndef NAMED
#define NAMED 0
#endif

/** Any request that names this slot: one of the robot, the one behind the last, or the largest number. */
void one_request(void) {
  tick_begins();
  begin_judging();
  state = nondet_state();
  some_future();
  relate(false, true, GIVEN);
  const ilk_state_t was = state;
  requests[0] = nondet_request();
  requests[0].axis = NAMED;
  out.verdict[0] = ilk_request_take(&config, &requests[0], &state);
  out.verdict_count = 1u;
  __CPROVER_assert(may_follow(&was, &state), "what may follow");
  __CPROVER_assume(may_follow(&state, &end));
  judge_request();
  relate(true, true, SHOWN);
}

/** In any state, whether it satisfies M or not. */
void refusal(void) {
  config = nondet_config();
  validation = nondet_validity();
  state = nondet_state();
  requests[0] = nondet_request();
  requests[0].axis = NAMED;
  const ilk_state_t was = state;
  const ilk_verdict_record_t record = ilk_request_take(&config, &requests[0], &state);
  __CPROVER_assert((was.system.mode != ILK_MODE_INIT) || (record.verdict != ILK_VERDICT_ACCEPTED),
                   "P13: nothing is accepted in INIT");
  __CPROVER_assert((record.verdict == ILK_VERDICT_ACCEPTED) || is_inert(&was, &state),
                   "P11: a refused request changes nothing but counters");
}

static uint32_t answered_count;

/** Answers anything; the requests come in order, each once. */
ilk_verdict_record_t stand_in_take(const ilk_config_t* c, const ilk_request_t* request, ilk_state_t* s) {
  const uint32_t index = (uint32_t)(request - many);
  __CPROVER_assert((c == &config) && (s == &state) && (index == answered_count), "in order, each once");
  answers[index] = nondet_verdict();
  answered_count++;
  return answers[index];
}

/** Phase 6 takes requests one by one: what the induction over them rests on. */
void all_requests(void) {
  const uint32_t count = nondet_word();
  const uint32_t taken = (count < ILK_REQUESTS_PER_TICK) ? count : ILK_REQUESTS_PER_TICK;
  answered_count = 0u;
  answer_requests(&config, many, count, &state, &out);
  __CPROVER_assert((answered_count == taken) && (out.verdict_count == taken),
                   "P11: one verdict for each taken");
  for (uint32_t i = 0u; i < ILK_REQUESTS_PER_TICK; i++) {
    __CPROVER_assert(
        (i >= taken) ||
            ((out.verdict[i].verdict == answers[i].verdict) &&
             (out.verdict[i].sequence == answers[i].sequence) && (out.verdict[i].tick == answers[i].tick) &&
             (out.verdict[i].kind == answers[i].kind) && (out.verdict[i].axis == answers[i].axis)),
        "P11: in the order of the requests");
  }
}

void drive(void) {
  tick_begins();
  begin_judging();
  ilk_step(&config, &state, &in, requests, asked, &out);
  __CPROVER_assert(after_is_seen(), "phases 7 and 8 change nothing that the snapshot tells");
  judge_drive();
  relate(true, false, SHOWN);
}

/** may_follow is reflexive and transitive. */
void following(void) {
  const ilk_state_t one = nondet_state();
  const ilk_state_t two = nondet_state();
  const ilk_state_t three = nondet_state();
  __CPROVER_assert(may_follow(&one, &one), "reflexive");
  __CPROVER_assert(!may_follow(&one, &two) || !may_follow(&two, &three) || may_follow(&one, &three),
                   "transitive");
}

/** What the other steps take for granted of a configuration follows from its validation. */
void validity(void) {
  config = nondet_config();
  validation = nondet_validity();
  __CPROVER_assume(ilk_config_validate(&config).error == (uint32_t)ILK_CONFIG_ERROR_NONE);
  __CPROVER_assert(config_is_valid(), "P13: what a valid configuration guarantees");
}

/** Two presses of one start have two numbers, neither of them 0. */
void numbers(void) {
  const uint32_t nonce = nondet_word();
  const ilk_state_t one = nondet_state();
  ilk_state_t first = one;
  ilk_state_t second = one;
  second.system.tick = nondet_word();
  ilk_mode_enter(ILK_MODE_MOTION, nonce, &first);
  ilk_mode_enter(ILK_MODE_MOTION, nonce, &second);
  __CPROVER_assume(first.system.tick != 0u && second.system.tick != 0u);
  __CPROVER_assert(first.system.consent != 0u, "P9: no number is 0");
  __CPROVER_assert(first.system.tick == second.system.tick || first.system.consent != second.system.consent,
                   "P9: no number is that of another press");
}

/** The stand-in for a frame's reading, and the judge's checksum, are what the kernel reads. */
void reading(void) {
  in = nondet_inputs();
  const ilk_reading_t real = ilk_frame_unpack(in.frame[0]);
  const ilk_reading_t told = stand_in_unpack(in.frame[0]);
  __CPROVER_assume(stand_in_checksum(in.frame[0]) == right_checksum(in.frame[0]));
  __CPROVER_assert(real.intact == told.intact, "intact");
  __CPROVER_assert((real.switch_triggered == told.switch_triggered) && (real.raw == told.raw) &&
                       (real.heartbeat == told.heartbeat) && (real.card_time_us == told.card_time_us) &&
                       (real.tick_echo == told.tick_echo) && (real.card_status == told.card_status),
                   "words");
}

/** Without a valid configuration (P13): INIT from the start, in every tick, whatever is asked. */
void no_configuration(void) {
  config = nondet_config();
  validation = nondet_validity();
  const uint32_t error = ilk_init(&config, &state).error;
  __CPROVER_assert(state.system.mode == ((error == ILK_CONFIG_ERROR_NONE) ? ILK_MODE_LOCKED : ILK_MODE_INIT),
                   "P13: INIT is left by a valid configuration alone");
  state = nondet_state();
  in = nondet_inputs();
  __CPROVER_assume((state.system.mode == ILK_MODE_INIT) && ilk_state_is_sealed(&state));
  ilk_step(&config, &state, &in, requests, 0u, &out);
  __CPROVER_assert((state.system.mode == ILK_MODE_INIT) && ilk_state_is_sealed(&state),
                   "P13: INIT stays INIT");
  __CPROVER_assert(out.power == 0u, "P2: no power in INIT");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    __CPROVER_assert((out.command[slot].drive == 0u) && is_still(out.frame[slot]), "P1: no drive in INIT");
  }
}

/* --- P18: two robots that differ in the other axes
 * ------------------------------------------------------------ */

static ilk_state_t twin;
ilk_inputs_t twin_in;
static ilk_outputs_t twin_out;

/** Frames of the other axes say something else. */
static void begin_twin_inputs(void) {
  in = nondet_inputs();
  twin_in = nondet_inputs();
  const uint32_t others = twin_in.frames_received & ~1u;
  const ilk_inputs_t others_in = twin_in;
  twin_in = in;
  twin_in.frames_received = (in.frames_received & 1u) | others;
  for (uint32_t slot = 1u; slot < ILK_SLOTS; slot++) {
    for (uint32_t word = 0u; word < ILK_FRAME_WORDS; word++) {
      twin_in.frame[slot][word] = others_in.frame[slot][word];
    }
  }
}

/** What the axes do together: whether the bus says anything, why the robot locked, how many were refused. */
static void take_what_is_common(const ilk_system_t* from, ilk_system_t* to) {
  to->bus_bad_ticks = from->bus_bad_ticks;
  to->cause = from->cause;
  to->cause_tick = from->cause_tick;
  to->cause_value = from->cause_value;
  to->causes_seen = from->causes_seen;
  to->requests_accepted = from->requests_accepted;
  to->requests_refused = from->requests_refused;
}

/** Any two states that are alike: the other axes are anywhere. */
static void some_twins(void) {
  state = nondet_state();
  const ilk_state_t others = nondet_state();
  twin = state;
  take_what_is_common(&others.system, &twin.system);
  for (uint32_t slot = 1u; slot < ILK_SLOTS; slot++) {
    twin.axis[slot] = others.axis[slot];
    twin.axis[slot].wiring = state.axis[slot].wiring; /* of the configuration, which both have */
  }
}

static bool has_same_words(const void* one, const void* two, uint32_t bytes) {
  const uint32_t* a = (const uint32_t*)one;
  const uint32_t* b = (const uint32_t*)two;
  bool same = true;
  for (uint32_t word = 0u; word < bytes / sizeof(uint32_t); word++) {
    same = same && (a[word] == b[word]);
  }
  return same;
}

/** The robot and the axis of slot 0 are in the same state. */
static bool is_alike(const ilk_state_t* one, const ilk_state_t* two) {
  ilk_system_t system = two->system;
  take_what_is_common(&one->system, &system);
  return has_same_words(&one->system, &system, sizeof system) &&
         has_same_words(&one->axis[0], &two->axis[0], sizeof one->axis[0]);
}

static ilk_state_t middle;

/** The second twin has come as far as the first, whose state the cut has kept. */
void cut_of_seeing(const ilk_config_t* c, const ilk_request_t r[], uint32_t count, ilk_state_t* s,
                   ilk_outputs_t* o) {
  expect_handed_on(c, r, count, o, (s == &state) ? &out : &twin_out);
  if (s == &state) {
    middle = state;
  } else {
    GOAL(middle.system.mode != twin.system.mode);
    GOAL(middle.system.mode == ILK_MODE_MOTION && twin.system.mode == ILK_MODE_MOTION &&
         middle.axis[1].state == ILK_AXIS_FAULTED && twin.axis[1].state == ILK_AXIS_HOMING);
    __CPROVER_assert(middle.system.mode != twin.system.mode || is_alike(&middle, &twin),
                     "P18: what an axis sees leads to the same at equal modes");
  }
}

/** Both go on from any two states that are alike, whatever came before. */
void cut_of_driving(const ilk_config_t* c, const ilk_request_t r[], uint32_t count, ilk_state_t* s,
                    ilk_outputs_t* o) {
  expect_handed_on(c, r, count, o, (s == &state) ? &out : &twin_out);
  if (s == &state) {
    some_twins();
    middle = twin;
  } else {
    twin = middle;
  }
}

static void step_twins(void) {
  config = nondet_config();
  validation = nondet_validity();
  asked = nondet_word();
  requests[0] = nondet_request();
  begin_twin_inputs();
  some_twins();
  ilk_step(&config, &state, &in, requests, asked, &out);
  ilk_step(&config, &twin, &twin_in, requests, asked, &twin_out);
}

void twins_see(void) { step_twins(); }

void twins_drive(void) {
  step_twins();
  GOAL(out.command[0].drive != 0u && out.command[1].drive != twin_out.command[1].drive);
  __CPROVER_assert(is_alike(&state, &twin), "P18: a tick leads to the same");
  __CPROVER_assert(has_same_words(&out.command[0], &twin_out.command[0], sizeof out.command[0]) &&
                       out.gate[0] == twin_out.gate[0] && out.power == twin_out.power,
                   "P18: the same command");
  __CPROVER_assert(has_same_words(out.frame[0], twin_out.frame[0], sizeof out.frame[0]),
                   "P18: the same frame");
}

/** The same request to both: to the axis itself, to another one, to one that is not there. */
void twins_are_asked(void) {
  config = nondet_config();
  some_twins();
  requests[0] = nondet_request();
  requests[0].axis = NAMED;
  const bool of_other = requests[0].kind <= (uint32_t)ILK_REQUEST_RESET || NAMED != 0;
  const uint32_t one = ilk_request_take(&config, &requests[0], &state).verdict;
  const uint32_t two = ilk_request_take(&config, &requests[0], &twin).verdict;
  GOAL(one == ILK_VERDICT_ACCEPTED && two == ILK_VERDICT_ACCEPTED);
  GOAL(one != two);
  __CPROVER_assert(one == two || of_other, "P18: the axis answers the same");
  __CPROVER_assert(one != two || state.system.mode != twin.system.mode || is_alike(&state, &twin),
                   "P18: a request leads to the same at equal modes and verdicts");
}
