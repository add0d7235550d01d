/**
 * @file
 * Durations and instants in nanoseconds as POSIX wants them.
 */
#ifndef INTERLOCK_HOST_TIMESPEC_H
#define INTERLOCK_HOST_TIMESPEC_H

#include <stdint.h>
#include <time.h>

/** The same time in seconds and nanoseconds. */
static inline struct timespec ilk_timespec(uint64_t nanoseconds) {
  const uint64_t seconds = nanoseconds / 1000000000u;
  const uint64_t rest = nanoseconds % 1000000000u;
  const struct timespec time = {.tv_sec = (time_t)seconds, .tv_nsec = (long)rest};
  return time;
}

#endif
