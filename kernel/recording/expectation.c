#include "interlock/expectation.h"

#include <stddef.h>
#include <string.h>

#define FIRST_FRAME (offsetof(ilk_inputs_t, frame) / sizeof(uint32_t))

void ilk_expectation_follow(ilk_expectation_t *expectation, const uint32_t given[], uint32_t count,
                            uint32_t missed[]) {
  uint32_t *newest = expectation->newest;
  uint32_t *change = expectation->change;
  uint32_t *step = expectation->step;
  for (uint32_t i = 0u; i < count; ++i) {
    const uint32_t changed = given[i] - newest[i];
    missed[i] = changed ^ step[i];
    step[i] = (changed == change[i]) ? changed : step[i];
    change[i] = changed;
    newest[i] = given[i];
  }
}

static uint32_t sum_of(const uint32_t frame[]) {
  uint32_t sum = 0u;
  for (uint32_t word = 0u; word < ((uint32_t)ILK_FRAME_WORDS - 1u); ++word) {
    sum += frame[word];
  }
  return sum;
}

/* spec/frames.md: all words of a sound frame, its checksum among them, add up to 0xffffffff. */

void ilk_given_from_inputs(uint32_t given[], const ilk_inputs_t *inputs) {
  (void)memcpy(given, inputs, sizeof *inputs);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; ++slot) {
    uint32_t *frame = &given[FIRST_FRAME + ((size_t)slot * (size_t)ILK_FRAME_WORDS)];
    frame[ILK_FRAME_WORDS - 1] += sum_of(frame) + 1u;
  }
}

void ilk_given_to_inputs(const uint32_t given[], ilk_inputs_t *inputs) {
  (void)memcpy(inputs, given, sizeof *inputs);
  for (uint32_t slot = 0u; slot < (uint32_t)ILK_SLOTS; ++slot) {
    uint32_t *frame = inputs->frame[slot];
    frame[ILK_FRAME_WORDS - 1] -= sum_of(frame) + 1u;
  }
}
