/**
 * @file
 * Runs the kernel core again on what was recorded, and finds the first tick that comes out differently.
 */
#ifndef INTERLOCK_REPLAY_H
#define INTERLOCK_REPLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/recorded_block.h"
#include "interlock/recorded_fields.h"
#include "interlock/recording_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * How a replay differs. The digests of a tick say that its state or its outputs are others; which words of
 * the state, the next recorded state says: that before the first tick of the next block.
 */
typedef struct {
  uint32_t tick;      /**< the first that differs: the kernel's counter after it */
  bool outputs;       /**< the outputs of that tick differ, its state does not */
  uint32_t words;     /**< of the next recorded state that differ; 0 when it is the same, or there is none */
  uint32_t seen_tick; /**< counter of that state */
  uint32_t
      offset;   /**< of the first of these words in `ilk_picture_t`, bytes; `ilk_picture_fields` names it */
  uint32_t bit; /**< lowest bit that differs */
  uint32_t recorded;
  uint32_t replayed;
} ilk_difference_t;

/** A replay, from one recorded block to the next. */
typedef struct {
  const ilk_config_t *config;
  ilk_state_t state;   /**< of the kernel that is run again */
  uint32_t next_block; /**< number of the block that continues the newest one, 0 before the first */
  uint32_t blocks;
  uint32_t gaps; /**< blocks that do not continue the one before */
  uint64_t ticks;
  uint64_t requests;
  uint32_t first_tick; /**< of the first replayed tick */
  uint32_t last_tick;  /**< of the newest one */
} ilk_replay_t;

/** What came of replaying a block. */
typedef enum {
  ILK_REPLAY_IDENTICAL = 0,
  ILK_REPLAY_DIFFERS = 1,
  ILK_REPLAY_UNREADABLE = 2 /**< the block holds something that is no record of a tick */
} ilk_replay_result_t;

/** Starts with nothing replayed; the configuration outlives the replay. */
void ilk_replay_begin(ilk_replay_t *replay, const ilk_config_t *config);

/** Sees each tick that was replayed without a difference, and the state before it. */
typedef void (*ilk_tick_visitor_t)(void *context, const ilk_state_t *before, const ilk_recorded_tick_t *tick);

/**
 * Replays a block: from the state that the block before led to, or from its opening when it continues none.
 *
 * In a block that continues the one before, the opening is compared, too: between two ticks nothing changes.
 *
 * @param difference set when the result is DIFFERS; `ilk_replay_name` adds the words.
 * @param visitor may be NULL.
 */
ilk_replay_result_t ilk_replay_block(ilk_replay_t *replay, uint32_t number, const uint32_t *payload,
                                     uint32_t used, ilk_difference_t *difference, ilk_tick_visitor_t visitor,
                                     void *context);

/** After a block that differs: adds to the difference what the opening of the next block shows of it. */
void ilk_replay_name(const ilk_replay_t *replay, uint32_t number, const uint32_t *payload, uint32_t used,
                     ilk_difference_t *difference);

/** What came of a whole recording. */
typedef struct {
  ilk_replay_t replay;
  ilk_replay_result_t result;  /**< of the newest block */
  ilk_difference_t difference; /**< set when the result is DIFFERS */
  ilk_file_result_t end;       /**< why no further block was replayed; BLOCK when the result says it */
} ilk_replay_report_t;

/** Replays what is left of a recording, up to the first block that cannot be believed or differs. */
void ilk_replay_recording(ilk_recording_t *recording, ilk_replay_report_t *report, ilk_tick_visitor_t visitor,
                          void *context);

/** True when every recorded tick that was written whole came out the same. */
bool ilk_replay_is_identical(const ilk_replay_report_t *report);

#ifdef __cplusplus
}
#endif

#endif
