#include "clock.h"

#include <time.h>

#include "timespec.h"

#define NS_PER_S 1000000000u

uint64_t ilk_now_ns(void) {
  struct timespec now;
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * NS_PER_S + (uint64_t)now.tv_nsec;
}

uint64_t ilk_utc_ms(void) {
  struct timespec now;
  (void)clock_gettime(CLOCK_REALTIME, &now);
  return ((uint64_t)now.tv_sec * 1000u) + ((uint64_t)now.tv_nsec / 1000000u);
}

void ilk_ticker_init(ilk_ticker_t *ticker, ilk_clock_t clock, uint32_t period_us, double speed,
                     uint64_t now_ns) {
  const uint64_t period_ns = (uint64_t)period_us * 1000u;
  ticker->clock = clock;
  ticker->period_ns = period_ns;
  ticker->deadline_ns = now_ns;
  if (clock == ILK_CLOCK_REAL) {
    ticker->pace_ns = period_ns;
  } else {
    ticker->pace_ns = speed > 0.0 ? (uint64_t)((double)period_ns / speed) : 0u;
  }
}

uint64_t ilk_ticker_next(ilk_ticker_t *ticker, bool in_step, uint64_t now_ns) {
  const uint64_t slowest = ticker->pace_ns > ticker->period_ns ? ticker->pace_ns : ticker->period_ns;
  ticker->deadline_ns += in_step ? ticker->pace_ns : slowest;
  ticker->waited_ns = 0u;
  if (ticker->clock == ILK_CLOCK_SIM && ticker->deadline_ns < now_ns) {
    ticker->waited_ns = ticker->pace_ns != 0u ? now_ns - ticker->deadline_ns : 0u;
    ticker->deadline_ns = now_ns;
  }
  return ticker->deadline_ns;
}

uint64_t ilk_ticker_begin(ilk_ticker_t *ticker, uint64_t now_ns) {
  if (ticker->clock == ILK_CLOCK_SIM || now_ns <= ticker->deadline_ns) {
    return 0u;
  }
  const uint64_t late_ns = now_ns - ticker->deadline_ns;
  ticker->deadline_ns += late_ns / ticker->period_ns * ticker->period_ns;
  return late_ns;
}

void ilk_sleep_until(uint64_t deadline_ns) {
  const struct timespec deadline = ilk_timespec(deadline_ns);
  (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL);
}
