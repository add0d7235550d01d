/**
 * @file
 * The real-time measures of Linux: which were asked for, which were granted, and whether that suffices.
 */
#ifndef INTERLOCK_HOST_REALTIME_H
#define INTERLOCK_HOST_REALTIME_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/link.h"
#include "interlock/sim_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ILK_RT_COUNT 4u

/** What was asked of the system, and what it gave. */
typedef struct {
  uint32_t asked;            /**< bits by ilk_rt_measure_t */
  uint32_t granted;          /**< bits by ilk_rt_measure_t */
  int refusal[ILK_RT_COUNT]; /**< `errno` of each measure that was asked for and refused */
} ilk_realtime_t;

/** What the executive may do with the rights it has. */
typedef enum {
  ILK_RUN,          /**< deadlines are kept, or do not exist */
  ILK_RUN_DEGRADED, /**< wall clock without the rights; simulator only */
  ILK_REFUSE        /**< hardware must not be run like this */
} ilk_run_permit_t;

/** Name of a measure for the report. */
const char *ilk_realtime_name(ilk_rt_measure_t measure);

/**
 * Asks for the measures on behalf of the calling thread. The simulated clock needs none and asks for none.
 *
 * @param core to run on, or -1 for any.
 */
void ilk_realtime_acquire(ilk_realtime_t *realtime, ilk_clock_t clock, int core, int priority);

/** Hardware needs the real clock and every measure that was asked for; the simulator does not. */
ilk_run_permit_t ilk_realtime_permit(ilk_clock_t clock, bool simulated, uint32_t asked, uint32_t granted);

#ifdef __cplusplus
}
#endif

#endif
