/**
 * @file
 * A digest over words: two FNV-1a lanes of 32 bits, so that every machine computes it with its own words.
 */
#ifndef ILK_TARGET_DIGEST_H
#define ILK_TARGET_DIGEST_H

#include <stdint.h>

#include "interlock/types.h"

typedef struct {
  uint32_t even;
  uint32_t odd;
} digest_t;

#define DIGEST_START {.even = 0x811c9dc5u, .odd = 0x01000193u}

static inline void digest_words(digest_t *digest, const uint32_t words[], uint32_t count) {
  for (uint32_t word = 0u; word < count; word++) {
    digest->even = (digest->even ^ words[word]) * 0x01000193u;
    digest->odd = (digest->odd + words[word]) * 0x9e3779b1u;
  }
}

/** Everything that a tick decided: the whole state and every word of the outputs. */
static inline void digest_tick(digest_t *digest, const ilk_state_t *state, const ilk_outputs_t *out) {
  digest_words(digest, &state->system.tick, (uint32_t)(sizeof(ilk_state_t) / sizeof(uint32_t)));
  digest_words(digest, &out->command[0].direction, (uint32_t)(sizeof(ilk_outputs_t) / sizeof(uint32_t)));
}

#endif
