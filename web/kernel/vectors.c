/**
 * @file
 * What the native kernel does in single ticks from any sound state, for the kernel in the page to be compared
 * with. Writes the layout and the configuration, then for each vector: state, inputs, number of requests,
 * requests, and the answer: the state after the tick, the outputs, and which gate blocks each axis in that
 * state.
 */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "interlock/kernel.h"
#include "parts.h"
#include "world.h"

static void put(const void* words, size_t bytes) {
  if (fwrite(words, bytes, 1, stdout) != 1) {
    exit(EXIT_FAILURE);
  }
}

#define WORDS(type) ((uint32_t)(sizeof(type) / sizeof(uint32_t)))
#define AT(type, field) ((uint32_t)(offsetof(type, field) / sizeof(uint32_t)))

/** Sizes and places in words, in the order of `Layout` in kernelBench.ts. */
static void put_layout(void) {
  const uint32_t layout[] = {
      WORDS(ilk_config_t),
      WORDS(ilk_state_t),
      WORDS(ilk_inputs_t),
      WORDS(ilk_request_t),
      WORDS(ilk_outputs_t),
      WORDS(ilk_axis_config_t),
      WORDS(ilk_axis_t),
      AT(ilk_config_t, axis[0].max_drive),
      AT(ilk_config_t, axis[0].unhomed_max_drive),
      AT(ilk_state_t, system.tick),
      AT(ilk_state_t, system.mode),
      AT(ilk_state_t, system.cause),
      AT(ilk_state_t, system.consent),
      AT(ilk_state_t, system.last_sequence),
      AT(ilk_state_t, axis[0].homed),
      AT(ilk_inputs_t, frame),
      AT(ilk_outputs_t, gate),
      AT(ilk_outputs_t, verdict),
  };
  put(layout, sizeof layout);
}

static void put_gates(const ilk_config_t* config, const ilk_state_t* state) {
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    const ilk_command_t wanted = ilk_wanted_command(&config->axis[slot], &state->axis[slot]);
    const uint32_t gate =
        (uint32_t)ilk_output_gate(&config->axis[slot], &state->system, &state->axis[slot], &wanted);
    put(&gate, sizeof gate);
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
  put_gates(config, state);
}

/** From any state that passes the kernel's own check, reachable or not. */
static void put_vector(const ilk_config_t* config, uint32_t number) {
  static const ilk_outputs_t silence;
  static ilk_state_t state;
  static ilk_outputs_t out;
  static world_t world;
  world_begin(&world, (number * 2654435761u) | 1u);
  world_any_state(&world.dice, config, &state);
  world.heartbeat = state.system.tick + dice_below(&world.dice, 3u);
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
  put_layout();
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
