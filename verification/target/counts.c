#include "counts.h"

#include "platform.h"

void count_tick(counts_t *counts, const ilk_state_t *state, const ilk_outputs_t *out) {
  counts->mode[state->system.mode]++;
  counts->cause[state->system.cause]++;
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; slot++) {
    counts->fault[state->axis[slot].fault]++;
    counts->gate[out->gate[slot]]++;
  }
  for (uint32_t index = 0u; index < out->verdict_count; index++) {
    counts->verdict[out->verdict[index].verdict]++;
  }
}

static void say_row(const char *name, const uint32_t row[], uint32_t length) {
  say(name);
  for (uint32_t code = 0u; code < length; code++) {
    say(" ");
    say_number(row[code]);
  }
  say("\n");
}

void say_counts(const counts_t *counts) {
  say_row("mode", counts->mode, ILK_MODE_COUNT);
  say_row("cause", counts->cause, ILK_CAUSE_COUNT);
  say_row("fault", counts->fault, ILK_FAULT_COUNT);
  say_row("verdict", counts->verdict, ILK_VERDICT_COUNT);
  say_row("gate", counts->gate, ILK_GATE_COUNT);
}
