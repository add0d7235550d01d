/**
 * @file
 * How a run of the kernel is told to Trace.tla: its configuration, the state that it begins with, and one
 * tuple a tick, inputs first, then what the kernel did.
 */
#ifndef INTERLOCK_TOLD_H
#define INTERLOCK_TOLD_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "interlock/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the card of one axis said in a tick, in the words of the model. */
typedef struct {
  const char* frame; /**< GOOD, MISSING, CORRUPT, LATE or REPEATED */
  int32_t moved;     /**< travel since the last valid frame, in the sense of the position */
  bool at_switch;
} told_reading_t;

/** What the model is given of a tick besides its contacts and requests. */
typedef struct {
  bool attached;           /**< an app came anew */
  const char* config_pass; /**< AGREES at the end of a pass over the configuration, NONE within one */
  told_reading_t reading[ILK_SLOTS];
} told_tick_t;

/**
 * Opens the module: the slots that hold motors, both configurations, and the state to begin with.
 *
 * @param from_boot the state is that of `ilk_init`, which the model must come to by itself.
 */
void told_begin(FILE* file, const ilk_config_t* config, const ilk_state_t* state, bool from_boot);

/**
 * Tells one tick.
 *
 * @param door what the kernel's door must say of each request: INTACT, CHECKSUM or SEQUENCE.
 * @param first nothing was told yet.
 */
void told_tick(FILE* file, const ilk_config_t* config, const told_tick_t* told, const ilk_inputs_t* in,
               const ilk_request_t request[], const char* const door[], uint32_t count,
               const ilk_state_t* state, const ilk_outputs_t* out, bool first);

/** Closes the module. */
void told_end(FILE* file);

#ifdef __cplusplus
}
#endif

#endif
