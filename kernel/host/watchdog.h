/**
 * @file
 * Tells the service manager that the loop goes on, from a thread of its own: the loop calls nobody for it.
 *
 * A kernel whose loop has stood still is ended and started anew, LOCKED. The cards need no such help: they
 * are off 5 ms after its last frame.
 */
#ifndef INTERLOCK_HOST_WATCHDOG_H
#define INTERLOCK_HOST_WATCHDOG_H

#include <pthread.h>
#include <stdint.h>

#include "error.h"
#include "interlock/service_notify.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  ilk_service_notify_t notify;
  const uint32_t *beats; /**< counted by the loop, atomic; wraps */
  uint32_t told;         /**< beats when the manager was last told */
  bool watched;
  int stop; /**< event descriptor */
  pthread_t thread;
} ilk_watchdog_t;

/** Connects to the service manager and starts to watch `beats` when it wants that. Before real-time rights.
 */
bool ilk_watchdog_start(ilk_watchdog_t *watchdog, const uint32_t *beats, ilk_error_t *error);

/** The process serves from now on. */
void ilk_watchdog_ready(const ilk_watchdog_t *watchdog);

/** Says that the process ends, and no more. */
void ilk_watchdog_stop(ilk_watchdog_t *watchdog);

#ifdef __cplusplus
}
#endif

#endif
