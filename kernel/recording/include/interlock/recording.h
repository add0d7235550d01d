/**
 * @file
 * The black box: what is recorded of each tick, in memory and in files.
 *
 * The kernel is deterministic. A recording therefore holds what the kernel was *given* in each tick, its
 * inputs and requests, and a digest of what it made of them. Whoever reads it runs the kernel core again.
 *
 * The black box is shared memory that the kernel process writes and others only read: a header, then blocks
 * of equal size, the oldest reused first. A *recording* is a file: a header, then blocks of any length.
 *
 * A block stands by itself. It opens with the state before its first tick, so that reading, and replaying,
 * can begin at any block. Each tick follows as one record: those words that are not what was expected.
 *
 * All words are little-endian, 32 bits; offsets and sizes of all structures are in
 * `ilk_recording_layout_hash`.
 */
#ifndef INTERLOCK_RECORDING_H
#define INTERLOCK_RECORDING_H

#include <stddef.h>
#include <stdint.h>

#include "interlock/types.h"

#define ILK_RECORDING_VERSION 2u
#define ILK_RING_MAGIC 0x474e4952u  /* "RING" */
#define ILK_BLOCK_MAGIC 0x4b434c42u /* "BLCK" */

/** A block of the black box, its header included. */
#define ILK_BLOCK_BYTES (64u * 1024u)

/** Everything of one tick but its requests: inputs as recorded, state and outputs as the kernel core makes
 * them of it. */
typedef struct {
  ilk_state_t state; /**< after the tick */
  ilk_inputs_t inputs;
  ilk_outputs_t out;
} ilk_picture_t;

/** Words that the kernel is given in one tick: the inputs, then the requests. */
#define ILK_INPUT_WORDS (sizeof(ilk_inputs_t) / sizeof(uint32_t))
#define ILK_REQUEST_WORDS (sizeof(ilk_request_t) / sizeof(uint32_t))
#define ILK_GIVEN_WORDS (ILK_INPUT_WORDS + ((size_t)ILK_REQUESTS_PER_TICK * ILK_REQUEST_WORDS))

/** Groups of 32 given words. */
#define ILK_GIVEN_GROUPS ((ILK_GIVEN_WORDS + 31u) / 32u)

/** Heads the record of a tick. For each group that `groups` names, a word follows that says which of its
 * words were not expected; then those words. */
typedef struct {
  uint32_t words;           /**< of the whole record */
  uint32_t tick;            /**< `state.system.tick` after the tick */
  uint32_t alarm;           /**< `ilk_alarm_of` the state after the tick */
  uint32_t request_count;   /**< at most ILK_REQUESTS_PER_TICK */
  uint32_t state_digest[2]; /**< `ilk_state_digest` of the state after the tick, low word first */
  uint32_t out_digest;      /**< `ilk_out_digest` of the outputs */
  uint32_t begun_ns[2];     /**< CLOCK_MONOTONIC at which the tick began, low word first */
  uint32_t groups;          /**< bit n: a word of group n was not expected */
} ilk_tick_record_t;

#define ILK_RECORD_HEAD_WORDS (sizeof(ilk_tick_record_t) / sizeof(uint32_t))

/** Longest record of a tick, in words. */
#define ILK_RECORD_WORDS_MAX (ILK_RECORD_HEAD_WORDS + ILK_GIVEN_GROUPS + ILK_GIVEN_WORDS)

/** Heads a block. In memory the checksums are zero. */
typedef struct {
  uint32_t magic;
  uint32_t number;      /**< 1 for the first block of a kernel's run; in memory 0 while it is being reused */
  uint32_t used;        /**< words after this header: the opening state, then records */
  uint32_t payload_crc; /**< CRC-32 of those words */
  uint32_t reserved;    /**< 0 */
  uint32_t header_crc;  /**< CRC-32 of the words above */
} ilk_block_header_t;

/** Words of the longest payload, and of the shortest. */
#define ILK_PAYLOAD_WORDS_MAX ((ILK_BLOCK_BYTES - sizeof(ilk_block_header_t)) / sizeof(uint32_t))
#define ILK_OPENING_WORDS (sizeof(ilk_state_t) / sizeof(uint32_t))

/** A block in memory. */
typedef struct {
  ilk_block_header_t header;
  uint32_t payload[ILK_PAYLOAD_WORDS_MAX];
} ilk_block_t;

/** What describes one run of a kernel. */
typedef struct {
  uint32_t version;               /**< ILK_RECORDING_VERSION */
  uint32_t layout_hash;           /**< `ilk_recording_layout_hash` of the kernel's build */
  uint32_t frame_words;           /**< ILK_FRAME_WORDS */
  uint32_t clock;                 /**< ilk_clock_t */
  uint32_t simulated;             /**< 1: no hardware moved */
  uint32_t begun_utc_ms[2];       /**< milliseconds since 1970 when the run began, low word first */
  uint32_t begun_monotonic_ns[2]; /**< CLOCK_MONOTONIC at that time, low word first */
  ilk_config_t config;
} ilk_run_description_t;

/** Begins the black box; the blocks begin at ILK_RING_HEADER_BYTES. */
typedef struct {
  uint32_t magic;        /**< written last */
  uint32_t blocks;       /**< block n is at place n modulo this */
  uint32_t closed;       /**< 1: the kernel ended in order */
  uint32_t head;         /**< number of the block that is being written, 0 before the first */
  uint32_t seconds;      /**< that it was made for */
  uint32_t fewest_ticks; /**< that it ever held since all blocks were in use; 0 before */
  ilk_run_description_t run;
} ilk_ring_header_t;

#define ILK_RING_HEADER_BYTES 4096u

#ifndef __cplusplus
_Static_assert(ILK_GIVEN_GROUPS <= 32u, "a word has a bit for each group");
_Static_assert(sizeof(ilk_block_t) == ILK_BLOCK_BYTES, "blocks leave no gap");
_Static_assert(ILK_OPENING_WORDS + ILK_RECORD_WORDS_MAX <= ILK_PAYLOAD_WORDS_MAX, "a block holds a tick");
_Static_assert(sizeof(ilk_ring_header_t) <= ILK_RING_HEADER_BYTES, "the header fits");
#endif

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Digest of every word of the state. Two states that differ in one or two neighbouring words never share it;
 * others do by a chance of 2^-64. Not the kernel's own seal: what it says must not depend on the kernel.
 */
uint64_t ilk_state_digest(const ilk_state_t *state);

/** Digest of every word of the outputs; different ones share it by a chance of 2^-32. */
uint32_t ilk_out_digest(const ilk_outputs_t *out);

/** Mode in bits 3..0, cause in bits 7..4; bit 8 + n is set while the axis of slot n is FAULTED. */
uint32_t ilk_alarm_of(const ilk_state_t *state);

/** CRC-32 over name, size and offset of everything that is recorded. */
uint32_t ilk_recording_layout_hash(void);

/** CRC-32 (IEEE 802.3, reflected) of words, each least significant byte first. */
uint32_t ilk_recording_crc(const uint32_t words[], uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
