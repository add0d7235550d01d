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

ilk_config_t some_config(void);
ilk_state_t some_state(void);
ilk_inputs_t some_inputs(void);
ilk_outputs_t some_outputs(void);
ilk_request_t some_request(void);
uint32_t some_word(void);

/* --- Stand-ins for functions with a proof of their own ------------------------------------------------------ */

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

/** What a frame says, and for each frame whether its checksum is right. The step `reading` shows it of both sides. */
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

/** A product is a function of its factors. */
uint64_t __CPROVER_uninterpreted_product(uint32_t a, uint32_t b);

uint32_t stand_in_multiply(uint32_t a, uint32_t b) {
  const uint64_t product = __CPROVER_uninterpreted_product(a, b);
  return (product > UINT32_MAX) ? UINT32_MAX : (uint32_t)product;
}

uint64_t stand_in_farthest(const ilk_axis_config_t *c, uint32_t periods) {
  return __CPROVER_uninterpreted_product(c->max_delta_counts, periods);
}

uint32_t stand_in_frequency(uint32_t drive) {
  (void)drive;
  return some_word();
}

/* --- The cut ------------------------------------------------------------------------------------------------ */

static ilk_state_t end;

/** What the snapshot will say after this tick: that of any state that requests can lead to. */
static void some_future(void) {
  end = some_state();
  __CPROVER_assume(may_follow(&state, &end));
  see_after(&end);
}

/** Phases 1 to 5 have led to M; the rest of this tick is the business of B and C. */
void cut_after_observation(const ilk_config_t *c, const ilk_request_t r[], uint32_t count, ilk_state_t *s,
                           ilk_outputs_t *o) {
  (void)c, (void)r, (void)count, (void)s, (void)o;
  some_future();
  judge_inputs();
  relate(false, true, LEMMAS);
  relate(true, true, SHOWN);
  __CPROVER_assume(false);
}

/** Any state that satisfies M, whatever came before; all requests are answered. */
void cut_before_drive(const ilk_config_t *c, const ilk_request_t r[], uint32_t count, ilk_state_t *s,
                      ilk_outputs_t *o) {
  (void)c, (void)r, (void)count, (void)s, (void)o;
  state = some_state();
  some_memory();
  see_after(&state);
  relate(false, true, GIVEN);
}

/* --- The three steps ---------------------------------------------------------------------------------------- */

static void tick_begins(void) {
  config = some_config();
  in = some_inputs();
  __CPROVER_assume(config_is_valid());
  state = some_state();
  some_memory();
  see_before();
}

/** Init leads to R. */
void initially(void) {
  config = some_config();
  __CPROVER_assume(config_is_valid());
  __CPROVER_assume(ilk_init(&config, &state).error == ILK_CONFIG_ERROR_NONE);
  first_memory();
  relate(true, false, SHOWN);
}

void observation(void) {
  tick_begins();
  relate(false, false, GIVEN);
  begin_judging();
  ilk_step(&config, &state, &in, requests, 0u, &out);
}

#ifndef NAMED
#define NAMED ILK_SLOTS
#endif

/** Any request; those that name a slot of the robot, slot by slot, which a solver finds easier than an index. */
void one_request(void) {
  tick_begins();
  begin_judging();
  state = some_state();
  some_future();
  relate(false, true, GIVEN);
  const ilk_state_t was = state;
  requests[0] = some_request();
#if NAMED < ILK_SLOTS
  requests[0].axis = NAMED;
#else
  __CPROVER_assume(requests[0].axis >= ILK_SLOTS);
#endif
  out.verdict[0] = ilk_request_take(&config, &requests[0], &state);
  out.verdict_count = 1u;
  __CPROVER_assert(may_follow(&was, &state), "what may follow");
  __CPROVER_assume(may_follow(&state, &end));
  judge_request();
  relate(true, true, SHOWN);
}

void drive(void) {
  tick_begins();
  begin_judging();
  ilk_step(&config, &state, &in, requests, 0u, &out);
  __CPROVER_assert(after_is_seen(), "phases 7 and 8 change nothing that the snapshot tells");
  judge_drive();
  relate(true, false, SHOWN);
}

/** may_follow is reflexive and transitive. */
void following(void) {
  const ilk_state_t one = some_state();
  const ilk_state_t two = some_state();
  const ilk_state_t three = some_state();
  __CPROVER_assert(may_follow(&one, &one), "reflexive");
  __CPROVER_assert(!may_follow(&one, &two) || !may_follow(&two, &three) || may_follow(&one, &three), "transitive");
}

/** The stand-in for a frame's reading, and the judge's checksum, are what the kernel reads. */
void reading(void) {
  in = some_inputs();
  const ilk_reading_t real = ilk_frame_unpack(in.frame[0]);
  const ilk_reading_t told = stand_in_unpack(in.frame[0]);
  __CPROVER_assume(stand_in_checksum(in.frame[0]) == right_checksum(in.frame[0]));
  __CPROVER_assert(real.intact == told.intact, "intact");
  __CPROVER_assert((real.switch_triggered == told.switch_triggered) && (real.raw == told.raw) &&
                       (real.heartbeat == told.heartbeat) && (real.card_time_us == told.card_time_us) &&
                       (real.tick_echo == told.tick_echo) && (real.card_status == told.card_status),
                   "words");
}
