/**
 * @file
 * Simulated clock: the kernel stays within a few ticks of the app, so that a busy machine cannot look like a
 * silent app. The real clock waits for no app.
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
  bool gave_up;         /**< the app kept the kernel waiting for too long and is not waited for */
  uint32_t given_up_at; /**< the kernel's tick then */
} ilk_pacing_t;

/** Whether a tick after `tick` may begin when the app has handled `seen_tick`; ticks wrap. */
bool ilk_pacing_may_go_on(uint32_t tick, uint32_t seen_tick);

/**
 * Waits until the app has seen enough for a tick after `tick` to begin, at most `patience_ms` of wall time.
 *
 * Returns at once when no app is attached, when its socket closes, or when `*stop` is set. An app for which
 * the time ran out is not waited for again before it has seen a tick of the time since.
 *
 * @return false while an attached app is not waited for.
 */
bool ilk_pacing_wait(ilk_pacing_t *pacing, const ilk_attachment_t *attachment, uint32_t tick,
                     uint32_t patience_ms, const volatile sig_atomic_t *stop);

#ifdef __cplusplus
}
#endif

#endif
