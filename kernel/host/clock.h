/**
 * @file
 * When the next tick begins.
 *
 * Real clock: absolute deadlines one period apart. A tick that begins more than a period late keeps the
 * phase: the periods that passed are skipped and counted as one overrun.
 * Simulated clock: paced at a multiple of real time, or as fast as possible. Simulated time waits for a late
 * host and makes up for nothing afterwards.
 */
#ifndef INTERLOCK_HOST_CLOCK_H
#define INTERLOCK_HOST_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/sim_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  ilk_clock_t clock;
  uint64_t period_ns;   /**< of the control loop */
  uint64_t pace_ns;     /**< wall time between ticks; 0: none */
  uint64_t deadline_ns; /**< at which the newest tick was due, CLOCK_MONOTONIC */
  uint64_t waited_ns;   /**< by which a paced simulated clock put off that deadline, since it had passed */
} ilk_ticker_t;

/** CLOCK_MONOTONIC in nanoseconds. */
uint64_t ilk_now_ns(void);

/** Milliseconds of UTC since 1970. */
uint64_t ilk_utc_ms(void);

/**
 * @param speed multiple of real time in the simulated clock, 0: as fast as possible; real clock: ignored.
 * @param now_ns from which the first deadline counts.
 */
void ilk_ticker_init(ilk_ticker_t *ticker, ilk_clock_t clock, uint32_t period_us, double speed,
                     uint64_t now_ns);

/**
 * The deadline of the next tick.
 *
 * @param in_step false keeps a simulated clock at real pace at most: plant or app are not waited for.
 */
uint64_t ilk_ticker_next(ilk_ticker_t *ticker, bool in_step, uint64_t now_ns);

/**
 * Notes that the tick began.
 *
 * @return nanoseconds after the deadline; 0 in the simulated clock.
 */
uint64_t ilk_ticker_begin(ilk_ticker_t *ticker, uint64_t now_ns);

/** Sleeps until the deadline has passed. Returns early when a signal arrives. */
void ilk_sleep_until(uint64_t deadline_ns);

#ifdef __cplusplus
}
#endif

#endif
