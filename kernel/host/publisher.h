/**
 * @file
 * The kernel's end of the region that the app reads: snapshot and events. Wait-free.
 */
#ifndef INTERLOCK_HOST_PUBLISHER_H
#define INTERLOCK_HOST_PUBLISHER_H

#include <stdint.h>

#include "interlock/link.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What was last told of an axis. */
typedef struct {
  uint32_t state;
  uint32_t fault;
  uint32_t homed;
} ilk_axis_told_t;

/** Where snapshots and events go, and what was told last. */
typedef struct {
  ilk_link_kernel_region_t *region; /**< NULL while no app is attached */
  uint32_t lock;                    /**< own copy of `snapshot_lock` */
  uint32_t events;                  /**< own copy of `event_head` */
  uint32_t mode;                    /**< last seen */
  ilk_axis_told_t axis[ILK_SLOTS];  /**< last seen */
} ilk_publisher_t;

/** Starts without an app; changes count from `state`. */
void ilk_publisher_init(ilk_publisher_t *publisher, const ilk_state_t *state);

/** Publishes into a fresh region from now on, or nowhere when it is NULL. */
void ilk_publisher_attach(ilk_publisher_t *publisher, ilk_link_kernel_region_t *region);

/**
 * Publishes one tick: events of its verdicts and changes, then the snapshot, then wakes those who wait.
 *
 * @param request_tail requests consumed so far.
 */
void ilk_publisher_publish(ilk_publisher_t *publisher, const ilk_snapshot_t *snapshot,
                           const ilk_outputs_t *out, uint32_t request_tail);

#ifdef __cplusplus
}
#endif

#endif
