/**
 * @file
 * The kernel's end of the black box: writes each tick into shared memory (recording.h).
 *
 * The memory has no name. Readers get its descriptor from the kernel (black_box_door.h); it is gone when the
 * last process that holds it has ended. Writing is wait-free and calls nothing of the system: whoever reads
 * comes too late at worst, and sees so.
 */
#ifndef INTERLOCK_HOST_BLACK_BOX_H
#define INTERLOCK_HOST_BLACK_BOX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "error.h"
#include "interlock/expectation.h"
#include "interlock/recording.h"
#include "interlock/sim_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a tick may take on the average for the seconds asked for to fit: nearly three times the mean of the
 * most varied case of the fault campaign (`black_box_bench`). */
#define ILK_BLACK_BOX_BYTES_A_TICK 256u

/** The black box that is being written. */
typedef struct {
  ilk_ring_header_t *ring;
  ilk_block_t *blocks; /**< of the ring */
  size_t bytes;        /**< of all the memory */
  int memory;          /**< descriptor that readers get: sealed, so that they can only read */
  int life[2];         /**< pipe whose reading end hangs up when the kernel ends */
  ilk_block_t *block;  /**< that is being written */
  uint32_t used;       /**< words of its payload */
  ilk_expectation_t expected;
} ilk_black_box_t;

/** What a black box is made for. */
typedef struct {
  const ilk_config_t *config;
  ilk_clock_t clock;
  bool simulated;
  uint32_t seconds; /**< that it holds, unless ticks take more than ILK_BLACK_BOX_BYTES_A_TICK */
} ilk_black_box_terms_t;

/** Takes all memory now, so that no tick waits for any. */
bool ilk_black_box_create(ilk_black_box_t *box, const ilk_black_box_terms_t *terms, ilk_error_t *error);

/** Opens the first block with the state before the first tick. */
void ilk_black_box_begin(ilk_black_box_t *box, const ilk_state_t *state);

/** Records a tick that began at `begun_ns`: what the kernel was given, and digests of what it made of it. */
void ilk_black_box_note(ilk_black_box_t *box, uint64_t begun_ns, const ilk_state_t *state,
                        const ilk_inputs_t *inputs, const ilk_request_t requests[], uint32_t count,
                        const ilk_outputs_t *out);

/** Says that the kernel ended in order, and lets go of the memory; readers keep what they hold. */
void ilk_black_box_close(ilk_black_box_t *box);

#ifdef __cplusplus
}
#endif

#endif
