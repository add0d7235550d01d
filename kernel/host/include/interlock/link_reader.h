/**
 * @file
 * What a client of the link needs: read snapshots and events, wait for them, put requests.
 *
 * Every function is bounded, takes no lock and allocates nothing. Snapshots and events may be read by any
 * number of threads; requests are put by one thread at a time.
 */
#ifndef INTERLOCK_LINK_READER_H
#define INTERLOCK_LINK_READER_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/link.h"

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Copies the newest snapshot, whole.
 *
 * @param lock gets the value of `snapshot_lock` that belongs to the copy, for `ilk_link_wait_snapshot`.
 * @return false when there is no snapshot yet, or the kernel wrote during each of 100 attempts; try again.
 */
bool ilk_link_read_snapshot(const ilk_link_kernel_region_t *region, ilk_snapshot_t *snapshot, uint32_t *lock);

/**
 * Waits for a snapshot newer than the one that `lock` belongs to; 0 stands for none.
 *
 * @return false when there is none after `timeout_ms` milliseconds, or after an interruption.
 */
bool ilk_link_wait_snapshot(const ilk_link_kernel_region_t *region, uint32_t lock, uint32_t timeout_ms);

/**
 * Copies the next event.
 *
 * @param next events read or lost so far, 0 at first; advanced past the event.
 * @param lost increased by the events that were overwritten before they could be read.
 * @return false when there is none.
 */
bool ilk_link_next_event(const ilk_link_kernel_region_t *region, uint32_t *next, uint32_t *lost,
                         ilk_event_t *event);

/**
 * Puts one request, which must carry its CRC.
 *
 * @return false when the kernel has not yet read the last ILK_LINK_REQUESTS requests.
 */
bool ilk_link_put_request(const ilk_link_kernel_region_t *kernel, ilk_link_app_region_t *app,
                          const ilk_request_t *request);

/** Says that the snapshot of `tick` was handled, and wakes a kernel that waits for it. */
void ilk_link_set_seen_tick(ilk_link_app_region_t *app, uint32_t tick);

#ifdef __cplusplus
}
#endif

#endif
