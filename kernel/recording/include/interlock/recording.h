/**
 * @file
 * The black box: what of each tick is recorded, in memory and in files.
 *
 * A *ring* is shared memory that the kernel process writes and others only read: a header, then blocks of
 * equal size, reused oldest first. A *recording* is a file: a header, then blocks of any length.
 *
 * A block stands by itself. It opens with everything of the tick before its first one, so that reading, and
 * replaying, can begin at any block. Each tick follows as one record: its requests, and those pairs of words
 * that changed since the tick before.
 *
 * All words are little-endian, 32 bits; offsets and sizes of all structures are in
 * `ilk_recording_layout_hash`.
 */
#ifndef INTERLOCK_RECORDING_H
#define INTERLOCK_RECORDING_H

#include <stddef.h>
#include <stdint.h>

#include "interlock/types.h"

#define ILK_RECORDING_VERSION 1u
#define ILK_RING_MAGIC 0x474e4952u  /* "RING" */
#define ILK_BLOCK_MAGIC 0x4b434c42u /* "BLCK" */

/** A block of the ring, its header included. */
#define ILK_BLOCK_BYTES (256u * 1024u)

/** Everything that is recorded of one tick but its requests. */
typedef struct {
  ilk_state_t state; /**< after the tick */
  ilk_inputs_t inputs;
  ilk_outputs_t out;
} ilk_picture_t;

/** Words of the picture, two at a time; a whole number of 64 such pairs, the rest zero, so that the words
 * that say which of them changed are pairs, too. */
#define ILK_PAIRS (((sizeof(ilk_picture_t) + 511u) / 512u) * 64u)
#define ILK_CHANGED_WORDS (ILK_PAIRS / 32u)

/** A picture, by field and as the pairs that are compared. */
typedef union {
  ilk_picture_t picture;
  uint64_t pair[ILK_PAIRS];
} ilk_picture_pairs_t;

/** Heads the record of a tick. The changed pairs follow, then the requests, then a word if it needs one to be
 * even. */
typedef struct {
  uint32_t words;                      /**< of the whole record, even */
  uint32_t tick;                       /**< `state.tick` after the tick */
  uint32_t alarm;                      /**< `ilk_alarm_of` the state after the tick */
  uint32_t request_count;              /**< at most ILK_REQUESTS_PER_TICK */
  uint32_t state_hash[2];              /**< `ilk_state_hash` of the state after the tick, low word first */
  uint32_t begun_ns[2];                /**< CLOCK_MONOTONIC at which the tick began, low word first */
  uint32_t changed[ILK_CHANGED_WORDS]; /**< bit n of word m: pair 32 m + n changed */
} ilk_tick_record_t;

/** Longest record of a tick, in words. */
#define ILK_RECORD_WORDS_MAX                                   \
  ((sizeof(ilk_tick_record_t) + sizeof(ilk_picture_pairs_t) +  \
    ((size_t)ILK_REQUESTS_PER_TICK * sizeof(ilk_request_t))) / \
   sizeof(uint32_t))

/** Heads a block. In the ring the checksums are zero. */
typedef struct {
  uint32_t magic;
  uint32_t number; /**< 1 for the first block of a kernel's run; in the ring 0 while it is being reused */
  uint32_t used;   /**< words after this header: the opening picture, then records */
  uint32_t payload_crc; /**< CRC-32 of those words */
  uint32_t reserved;    /**< 0 */
  uint32_t header_crc;  /**< CRC-32 of the words above */
} ilk_block_header_t;

/** A block of the ring. */
typedef struct {
  ilk_block_header_t header;
  uint64_t payload[(ILK_BLOCK_BYTES - sizeof(ilk_block_header_t)) / sizeof(uint64_t)];
} ilk_block_t;

/** Words of the longest payload, and of the shortest. */
#define ILK_PAYLOAD_WORDS_MAX ((ILK_BLOCK_BYTES - sizeof(ilk_block_header_t)) / sizeof(uint32_t))
#define ILK_OPENING_WORDS (sizeof(ilk_picture_pairs_t) / sizeof(uint32_t))

/** Ticks that fit into a block however much changes; its writer needs a pair beyond the last. */
#define ILK_BLOCK_TICKS_MIN ((ILK_PAYLOAD_WORDS_MAX - ILK_OPENING_WORDS - 2u) / ILK_RECORD_WORDS_MAX)

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

/**
 * Begins a ring; the blocks begin at ILK_RING_HEADER_BYTES. The kernel holds the file's lock (`flock`) for as
 * long as it lives.
 */
typedef struct {
  uint32_t magic;  /**< written last */
  uint32_t blocks; /**< block n is at place n modulo this */
  uint32_t closed; /**< 1: the kernel ended in order */
  uint32_t head;   /**< number of the block that is being written, 0 before the first */
  ilk_run_description_t run;
} ilk_ring_header_t;

#define ILK_RING_HEADER_BYTES 4096u

/** After the name of a ring: the ring of the kernel before, until a recorder has it on the disk. */
#define ILK_RING_BEFORE ".before"

/** After the name of a ring that a kernel is making: what stands under the name itself is always whole. */
#define ILK_RING_MAKING ".making"

#ifndef __cplusplus
_Static_assert(sizeof(ilk_picture_pairs_t) == ILK_PAIRS * sizeof(uint64_t), "pairs cover the picture");
_Static_assert(sizeof(ilk_tick_record_t) % sizeof(uint64_t) == 0u, "changed pairs are aligned");
_Static_assert(sizeof(ilk_block_header_t) % sizeof(uint64_t) == 0u, "a block's payload is aligned");
_Static_assert(sizeof(ilk_block_t) == ILK_BLOCK_BYTES, "blocks leave no gap");
_Static_assert(sizeof(ilk_ring_header_t) <= ILK_RING_HEADER_BYTES, "the ring's header fits");
#endif

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Digest of every word of the state. Two states that differ in one or two neighbouring words never share it;
 * others do by a chance of 2^-64. Not the kernel's own seal: what it says must not depend on the kernel.
 */
uint64_t ilk_state_hash(const ilk_state_t *state);

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
