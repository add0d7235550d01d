/**
 * @file
 * By how much a simulated run lags behind the wall clock, because the host was late.
 */
#ifndef INTERLOCK_HOST_LATENESS_H
#define INTERLOCK_HOST_LATENESS_H

#include <stdint.h>

#include "interlock/link.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  uint64_t total_ns;
  uint64_t second_ns;       /**< in the second that runs */
  uint64_t second_began_ns; /**< 0: none has */
} ilk_lateness_watch_t;

/** Adds what simulated time waited before the tick that begins at `now_ns`; `shown` follows. */
void ilk_lateness_add(ilk_lateness_watch_t *watch, ilk_lateness_t *shown, uint64_t waited_ns,
                      uint64_t now_ns);

#ifdef __cplusplus
}
#endif

#endif
