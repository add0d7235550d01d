/**
 * @file
 * Reads the ticks of a block. Every word of it may be damaged: what does not fit together is told, never
 * followed.
 */
#ifndef INTERLOCK_RECORDED_BLOCK_H
#define INTERLOCK_RECORDED_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/recording.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One recorded tick, whole. */
typedef struct {
  uint32_t alarm;
  uint64_t state_hash;
  uint64_t begun_ns; /**< CLOCK_MONOTONIC */
  uint32_t request_count;
  ilk_request_t request[ILK_REQUESTS_PER_TICK];
  ilk_picture_pairs_t now;
} ilk_recorded_tick_t;

/** A place in a block's payload. */
typedef struct {
  const uint32_t *payload;
  uint32_t used;
  uint32_t place; /**< words read */
} ilk_block_cursor_t;

/** What comes next in a block. */
typedef enum {
  ILK_TICK_READ = 0,
  ILK_TICK_NONE = 1, /**< the block ends here */
  ILK_TICK_DAMAGED =
      2 /**< what comes is no record, or its state is not the one it was when it was recorded */
} ilk_tick_result_t;

/**
 * Begins to read a block's payload of `used` words.
 *
 * @param tick gets the opening: the picture before the first tick.
 * @return false when the payload is too short for one.
 */
bool ilk_block_begin(ilk_block_cursor_t *cursor, const uint32_t *payload, uint32_t used,
                     ilk_recorded_tick_t *tick);

/** The next tick; `tick` holds the one before. */
ilk_tick_result_t ilk_block_next(ilk_block_cursor_t *cursor, ilk_recorded_tick_t *tick);

#ifdef __cplusplus
}
#endif

#endif
