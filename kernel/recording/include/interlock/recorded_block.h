/**
 * @file
 * Reads the ticks of a block: takes what the kernel was given, and runs the kernel core on it again. Every
 * word of a block may be damaged: a record that does not fit is reported, never followed.
 */
#ifndef INTERLOCK_RECORDED_BLOCK_H
#define INTERLOCK_RECORDED_BLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/expectation.h"
#include "interlock/recording.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One recorded tick, whole. */
typedef struct {
  uint32_t tick; /**< the kernel's counter after it, as recorded */
  uint32_t alarm;
  uint64_t state_digest;
  uint64_t begun_ns; /**< CLOCK_MONOTONIC */
  uint32_t request_count;
  ilk_request_t request[ILK_REQUESTS_PER_TICK];
  ilk_picture_t picture;
} ilk_recorded_tick_t;

/** A place in a block's payload. */
typedef struct {
  const ilk_config_t *config;
  const uint32_t *payload;
  uint32_t used;
  uint32_t place; /**< words read */
  ilk_expectation_t expected;
} ilk_block_cursor_t;

/** What comes next in a block. */
typedef enum {
  ILK_TICK_READ = 0,
  ILK_TICK_NONE = 1,          /**< the block ends here */
  ILK_TICK_DAMAGED = 2,       /**< no record comes next */
  ILK_TICK_STATE_DIFFERS = 3, /**< the kernel core comes to another state than was recorded */
  ILK_TICK_OUTPUTS_DIFFER = 4 /**< to that state, but to other outputs */
} ilk_tick_result_t;

/**
 * Begins to read a block's payload of `used` words, of a kernel with this configuration. Both outlive the
 * cursor.
 *
 * @param tick gets the opening: the state before the first tick.
 * @return false when the payload is too short for one.
 */
bool ilk_block_begin(ilk_block_cursor_t *cursor, const ilk_config_t *config, const uint32_t *payload,
                     uint32_t used, ilk_recorded_tick_t *tick);

/** The next tick; `tick` holds the one before. Reading may go on after a difference. */
ilk_tick_result_t ilk_block_next(ilk_block_cursor_t *cursor, ilk_recorded_tick_t *tick);

#ifdef __cplusplus
}
#endif

#endif
