/**
 * @file
 * A wall clock that a test can step, for a program that is started with this library preloaded.
 *
 * CLOCK_REALTIME is shifted by the nanoseconds in the file $INTERLOCK_CLOCK_SHIFT (one int64_t, mapped, so
 * that a step acts at once and in every thread). Time that passes, CLOCK_MONOTONIC, stays as it is: a step of
 * the wall clock does not touch it either.
 */
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define NS_PER_S 1000000000LL

static const int64_t no_shift;
static const int64_t* shift_ns = &no_shift;

__attribute__((constructor)) static void map_shift(void) {
  const char* path = getenv("INTERLOCK_CLOCK_SHIFT");
  const int file = path == NULL ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return;
  }
  const void* mapped = mmap(NULL, sizeof *shift_ns, PROT_READ, MAP_SHARED, file, 0);
  if (mapped != MAP_FAILED) {
    shift_ns = mapped;
  }
  (void)close(file);
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = (int)syscall(SYS_clock_gettime, clock, now);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) {
    const int64_t ns = now->tv_nsec + __atomic_load_n(shift_ns, __ATOMIC_RELAXED);
    const int64_t rest = ((ns % NS_PER_S) + NS_PER_S) % NS_PER_S;
    now->tv_sec += (time_t)((ns - rest) / NS_PER_S);
    now->tv_nsec = (long)rest;
  }
  return result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  (void)zone;
  struct timespec precise;
  const int result = clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return result;
}

time_t time(time_t* now) {
  struct timespec precise;
  (void)clock_gettime(CLOCK_REALTIME, &precise);
  if (now != NULL) {
    *now = precise.tv_sec;
  }
  return precise.tv_sec;
}
