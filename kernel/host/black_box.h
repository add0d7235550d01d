/**
 * @file
 * The kernel's end of the black box: writes each tick into a ring in shared memory (recording.h).
 *
 * The memory outlives the process that writes it, however that ends. Writing is wait-free and calls nothing
 * of the system: whoever reads comes too late at worst, and sees so.
 */
#ifndef INTERLOCK_HOST_BLACK_BOX_H
#define INTERLOCK_HOST_BLACK_BOX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "error.h"
#include "interlock/recording.h"
#include "interlock/sim_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The ring that is being written. */
typedef struct {
  ilk_ring_header_t *ring;
  ilk_block_t *blocks;         /**< of the ring */
  size_t bytes;                /**< of the whole file */
  int descriptor;              /**< whose lock says that the kernel lives */
  ilk_block_t *block;          /**< that is being written */
  size_t used;                 /**< pairs of its payload */
  uint32_t newest;             /**< which of the pictures is the newest */
  ilk_picture_pairs_t tick[2]; /**< the newest picture, and the one before */
} ilk_black_box_t;

/** What a ring is made for. */
typedef struct {
  const ilk_config_t *config;
  ilk_clock_t clock;
  bool simulated;
  uint32_t seconds; /**< that it holds at least, however much changes in each tick */
} ilk_black_box_terms_t;

/**
 * Makes the ring in a new file, with all its memory, which takes the place of an old one once it is whole.
 * The old one keeps a second name, PATH with ILK_RING_BEFORE, unless an earlier one has that already. That of
 * a kernel that lives is refused.
 *
 * The file should lie in memory (/dev/shm): a disk could make the loop wait.
 */
bool ilk_black_box_create(ilk_black_box_t *box, const char *path, const ilk_black_box_terms_t *terms,
                          ilk_error_t *error);

/** Opens the first block with the state before the first tick. */
void ilk_black_box_begin(ilk_black_box_t *box, const ilk_state_t *state);

/** Records a tick that began at `begun_ns`: what the kernel was given, and what it made of it. */
void ilk_black_box_note(ilk_black_box_t *box, uint64_t begun_ns, const ilk_state_t *state,
                        const ilk_inputs_t *inputs, const ilk_request_t requests[], uint32_t count,
                        const ilk_outputs_t *out);

/** Says that the kernel ended in order, and lets go of the memory; the file stays for its readers. */
void ilk_black_box_close(ilk_black_box_t *box);

#ifdef __cplusplus
}
#endif

#endif
