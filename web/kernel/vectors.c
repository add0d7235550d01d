/**
 * @file
 * What the native kernel does in single ticks from any sound state, for the kernel in the page to be compared
 * with. Writes the configuration, then for each vector: state, inputs, number of requests, requests, and the
 * answer: the state after the tick, and the outputs.
 */
#include <stdio.h>
#include <stdlib.h>

#include "interlock/kernel.h"
#include "world.h"

static void put(const void* words, size_t bytes) {
  if (fwrite(words, bytes, 1, stdout) != 1) {
    exit(EXIT_FAILURE);
  }
}

/** One tick of the native kernel from that state, which it leaves as it is after the tick. */
static void put_tick(const ilk_config_t* config, ilk_state_t* state, world_t* world, ilk_outputs_t* out) {
  static ilk_inputs_t in;
  static ilk_request_t requests[ILK_REQUESTS_PER_TICK];
  world_inputs(world, config, state, out, &in);
  const uint32_t count = world_requests(world, config, state, requests);
  put(state, sizeof *state);
  put(&in, sizeof in);
  put(&count, sizeof count);
  put(requests, sizeof requests);
  ilk_step(config, state, &in, requests, count, out);
  put(state, sizeof *state);
  put(out, sizeof *out);
}

/** From any state that passes the kernel's own check, reachable or not. */
static void put_vector(const ilk_config_t* config, uint32_t number) {
  static const ilk_outputs_t silence;
  static ilk_state_t state;
  static ilk_outputs_t out;
  static world_t world;
  world_begin(&world, (number * 2654435761u) | 1u);
  world_any_state(&world.dice, config, &state);
  world.heartbeat = dice_word(&world.dice);
  world.pressed = dice_one_in(&world.dice, 5u);
  out = silence;
  put_tick(config, &state, &world, &out);
}

int main(int count, char* arguments[]) {
  static ilk_config_t config;
  static ilk_state_t state;
  static ilk_outputs_t out;
  static world_t world;
  if (count != 2) {
    (void)fputs("usage: vectors COUNT\n", stderr);
    return 2;
  }
  const unsigned long vectors = strtoul(arguments[1], NULL, 10);
  world_config(&config);
  put(&config, sizeof config);
  world_begin(&world, 1u);
  (void)ilk_init(&config, &state);
  for (uint32_t number = 0u; number < vectors; number++) {
    if ((number & 1u) == 0u) {
      put_vector(&config, number);
    } else {
      put_tick(&config, &state, &world, &out);
    }
  }
  return 0;
}
