/**
 * @file
 * A long random run of the kernel. Prints what happened, so that an idle run is noticed, and one digest over
 * every word of every tick. With EACH_TICK also the digest after each tick, with TOLD all words of that tick.
 */
#include "counts.h"
#include "digest.h"
#include "platform.h"
#include "told.h"
#include "world.h"

#ifndef TRACE_TICKS
#error "TRACE_TICKS is the number of ticks"
#endif
#define TRACE_SEED 0x1badb002u

static void say_digest(const digest_t *digest) {
  say("digest ");
  say_hex(digest->even);
  say_hex(digest->odd);
  say("\n");
}

uint32_t run_image(void) {
  static ilk_config_t config;
  static ilk_state_t state;
  static ilk_inputs_t in;
  static ilk_outputs_t out;
  static ilk_request_t requests[ILK_REQUESTS_PER_TICK];
  static world_t world;
  static counts_t counts;
  digest_t digest = DIGEST_START;
  world_config(&config);
  world_begin(&world, TRACE_SEED);
  (void)ilk_init(&config, &state);
  for (uint32_t tick = 0u; tick < (uint32_t)TRACE_TICKS; tick++) {
    world_inputs(&world, &config, &state, &out, &in);
    const uint32_t wishes = world_requests(&world, &config, &state, requests);
    ilk_step(&config, &state, &in, requests, wishes, &out);
    digest_tick(&digest, &state, &out);
    count_tick(&counts, &state, &out);
#ifdef EACH_TICK
    say_digest(&digest);
#endif
#ifdef TOLD
    if (tick == (uint32_t)TOLD) {
      say_tick(&in, requests, wishes, &state, &out);
    }
#endif
  }
  say_counts(&counts);
  say("ticks ");
  say_number((uint32_t)TRACE_TICKS);
  say("\n");
  say_digest(&digest);
  return 0u;
}
