/**
 * @file
 * All words of one tick, for a person who looks for the first one that differs between two machines.
 */
#ifndef ILK_TARGET_TOLD_H
#define ILK_TARGET_TOLD_H

#include "interlock/types.h"

/** Prints `word NAME INDEX HEX` for each word of what the tick was given and of what it made. */
void say_tick(const ilk_inputs_t *in, const ilk_request_t requests[], uint32_t count,
              const ilk_state_t *state, const ilk_outputs_t *out);

#endif
