/**
 * @file
 * A recording as a file: what its writer puts around each block, and its reader, block by block.
 */
#ifndef INTERLOCK_RECORDING_FILE_H
#define INTERLOCK_RECORDING_FILE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "interlock/recording.h"

#define ILK_RECORDING_MAGIC 0x524b4c49u /* "ILKR" */

/** Ends a block in a file: what was never written is zero, and no number makes this word zero. */
#define ILK_BLOCK_TRAILER(number) (ILK_BLOCK_MAGIC ^ (number))

/** Why a recording was begun. */
typedef enum {
  ILK_RECORDED_CONTINUOUSLY = 0,
  ILK_RECORDED_ON_LOCK = 1,  /**< the kernel locked */
  ILK_RECORDED_ON_FAULT = 2, /**< an axis faulted */
  ILK_RECORDED_ON_DEMAND = 3,
  ILK_RECORDED_ON_END = 4 /**< the kernel ended out of order */
} ilk_recorded_why_t;

#define ILK_RECORDED_WHYS 5u
#define ILK_BUILD_TEXT_BYTES 64u

/** Begins a recording. */
typedef struct {
  uint32_t magic;
  uint32_t why;                     /**< ilk_recorded_why_t */
  uint32_t tick;                    /**< of the event, or the newest one when the recording began */
  char build[ILK_BUILD_TEXT_BYTES]; /**< version and commit of the program that wrote it, zeros behind */
  ilk_run_description_t run;
  uint32_t crc; /**< CRC-32 of the words above */
} ilk_recording_header_t;

#ifdef __cplusplus
extern "C" {
#endif

/** Completes a header: magic and checksum. */
void ilk_recording_seal_header(ilk_recording_header_t *header);

/** The header of a block with this payload; in a file ILK_BLOCK_TRAILER follows the payload. */
ilk_block_header_t ilk_recording_block_header(uint32_t number, const uint32_t *payload, uint32_t used);

/** What stands where the next block should. */
typedef enum {
  ILK_FILE_BLOCK = 0,
  ILK_FILE_END = 1,  /**< nothing: the recording is complete */
  ILK_FILE_TORN = 2, /**< the beginning of a block that was being written when the machine or process died */
  ILK_FILE_DAMAGED = 3 /**< a block that is not what was written, or nothing that ever was one */
} ilk_file_result_t;

/** What a file's header says of it. */
typedef enum {
  ILK_HEADER_GOOD = 0,
  ILK_HEADER_NO_RECORDING = 1,  /**< too short, or another kind of file */
  ILK_HEADER_OTHER_RELEASE = 2, /**< format, layout or frame length of another build */
  ILK_HEADER_DAMAGED = 3
} ilk_header_result_t;

/** An open recording. */
typedef struct {
  FILE *file; /**< borrowed */
  ilk_recording_header_t header;
  uint64_t offset;                              /**< of the newest block in the file, bytes */
  uint32_t number;                              /**< of the newest block, 0 when its header is not sound */
  uint32_t used;                                /**< words in `payload` */
  uint32_t payload[ILK_PAYLOAD_WORDS_MAX + 1u]; /**< of the newest block, and its trailer */
} ilk_recording_t;

/** Begins to read; `file` stands at its beginning and outlives the recording. */
ilk_header_result_t ilk_recording_begin(ilk_recording_t *recording, FILE *file);

/** Reads the next block. After another answer than BLOCK there is no more to read. */
ilk_file_result_t ilk_recording_next(ilk_recording_t *recording);

#ifdef __cplusplus
}
#endif

#endif
