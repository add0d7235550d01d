/**
 * @file
 * Single ticks from any state that passes the kernel's own check. Without EXPECTED, prints the digest of
 * each; with it, compares each with the table that another machine made and prints the numbers of those that
 * differ. With TOLD prints all words of that one.
 */
#include "counts.h"
#include "digest.h"
#include "platform.h"
#include "told.h"
#include "world.h"

#ifndef VECTORS
#error "VECTORS is the number of ticks"
#endif
#ifdef EXPECTED
static const uint32_t expected[VECTORS][2] = {
#include EXPECTED
};
#endif

/** One tick. False when the kernel took a sound state for a damaged one, whose ticks begin anew, or the
 * reverse. */
static bool run_vector(const ilk_config_t *config, uint32_t number, digest_t *digest, counts_t *counts) {
  static const ilk_outputs_t silence;
  static ilk_state_t state;
  static ilk_inputs_t in;
  static ilk_outputs_t out;
  static ilk_request_t requests[ILK_REQUESTS_PER_TICK];
  static world_t world;
  world_begin(&world, (number * 2654435761u) | 1u);
  const bool sound = world_any_state(&world.dice, config, &state);
  world.heartbeat = state.system.tick;
  world.pressed = dice_one_in(&world.dice, 5u);
  world_inputs(&world, config, &state, &silence, &in);
  const uint32_t count = world_requests(&world, config, &state, requests);
  ilk_step(config, &state, &in, requests, count, &out);
  digest_tick(digest, &state, &out);
  count_tick(counts, &state, &out);
#ifdef TOLD
  if (number == (uint32_t)TOLD) {
    say_tick(&in, requests, count, &state, &out);
  }
#endif
  return sound == (state.system.tick > 1u);
}

#ifdef EXPECTED
static uint32_t compare(uint32_t number, digest_t digest) {
  uint32_t mismatches = 0u;
  if ((digest.even != expected[number][0]) || (digest.odd != expected[number][1])) {
    mismatches = 1u;
    say("mismatch ");
    say_number(number);
    say("\n");
  }
  return mismatches;
}
#else
static uint32_t compare(uint32_t number, digest_t digest) {
  (void)number;
  say("{0x");
  say_hex(digest.even);
  say("u, 0x");
  say_hex(digest.odd);
  say("u},\n");
  return 0u;
}
#endif

uint32_t run_image(void) {
  static ilk_config_t config;
  static counts_t counts;
  uint32_t mismatches = 0u;
  digest_t all = DIGEST_START;
  world_config(&config);
  for (uint32_t number = 0u; number < (uint32_t)VECTORS; number++) {
    digest_t digest = DIGEST_START;
    if (!run_vector(&config, number, &digest, &counts)) {
      mismatches++;
      say("unsound ");
      say_number(number);
      say("\n");
    }
    mismatches += compare(number, digest);
    digest_words(&all, &digest.even, 2u);
  }
#ifdef EXPECTED
  say_counts(&counts);
  say("vectors ");
  say_number((uint32_t)VECTORS);
  say("\ndigest ");
  say_hex(all.even);
  say_hex(all.odd);
  say("\n");
#endif
  return mismatches;
}
