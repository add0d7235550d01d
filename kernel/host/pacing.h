/**
 * @file
 * Simulated clock: the kernel stays within sight of the app, so that a busy machine cannot look like a
 * silent app.
 */
#ifndef INTERLOCK_HOST_PACING_H
#define INTERLOCK_HOST_PACING_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#include "link_mailbox.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  bool gave_up;         /**< the app did not move for too long and is not waited for */
  uint32_t given_up_at; /**< its `seen_tick` then */
} ilk_pacing_t;

/** Whether a tick after `tick` may begin when the app has handled `seen_tick`; ticks wrap. */
bool ilk_pacing_may_go_on(uint32_t tick, uint32_t seen_tick);

/**
 * Waits until the app has seen enough for a tick after `tick` to begin, at most `patience_ms` of wall time.
 *
 * Returns at once when no app is attached, when its socket closes, or when `*stop` is set. An app for which
 * the time ran out is not waited for again until its `seen_tick` changes.
 */
void ilk_pacing_wait(ilk_pacing_t *pacing, const ilk_attachment_t *attachment, uint32_t tick,
                     uint32_t patience_ms, const volatile sig_atomic_t *stop);

#ifdef __cplusplus
}
#endif

#endif
