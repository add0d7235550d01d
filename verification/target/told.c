#include "told.h"

#include "platform.h"

static void say_words(const char *name, const uint32_t words[], uint32_t bytes) {
  for (uint32_t word = 0u; word < (bytes / (uint32_t)sizeof(uint32_t)); word++) {
    say("word ");
    say(name);
    say(" ");
    say_number(word);
    say(" ");
    say_hex(words[word]);
    say("\n");
  }
}

void say_tick(const ilk_inputs_t *in, const ilk_request_t requests[], uint32_t count,
              const ilk_state_t *state, const ilk_outputs_t *out) {
  say_words("in", &in->link_generation, (uint32_t)sizeof *in);
  say_words("request", &requests[0].sequence, count * (uint32_t)sizeof requests[0]);
  say_words("state", &state->system.tick, (uint32_t)sizeof *state);
  say_words("out", &out->command[0].direction, (uint32_t)sizeof *out);
}
