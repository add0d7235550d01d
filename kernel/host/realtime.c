#include "realtime.h"

#include <errno.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#define STACK_BYTES (128u * 1024u)

const char *ilk_realtime_name(ilk_rt_measure_t measure) {
  switch (measure) {
    case ILK_RT_FIFO:
      return "SCHED_FIFO priority";
    case ILK_RT_MLOCK:
      return "memory locked";
    case ILK_RT_PINNED:
      return "pinned to its core";
    case ILK_RT_TIMER:
      return "timer slack 1 ns";
    default:
      return "unknown measure";
  }
}

static void note(ilk_realtime_t *realtime, ilk_rt_measure_t measure, bool granted) {
  realtime->asked |= 1u << (uint32_t)measure;
  if (granted) {
    realtime->granted |= 1u << (uint32_t)measure;
  } else {
    realtime->refusal[measure] = errno;
  }
}

/** Touches the stack that the loop can need, so that it is mapped before the first tick. */
static void touch_stack(void) {
  volatile unsigned char stack[STACK_BYTES];
  for (size_t i = 0; i < sizeof stack; i += 4096u) {
    stack[i] = 0u;
  }
}

static bool lock_memory(void) {
  touch_stack();
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
}

static bool pin(int core) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET((size_t)core, &cores);
  return sched_setaffinity(0, sizeof cores, &cores) == 0;
}

static bool take_priority(int priority) {
  const struct sched_param parameters = {.sched_priority = priority};
  return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

void ilk_realtime_acquire(ilk_realtime_t *realtime, ilk_clock_t clock, int core, int priority) {
  *realtime = (ilk_realtime_t){0};
  if (core >= 0) {
    note(realtime, ILK_RT_PINNED, pin(core));
  }
  if (clock == ILK_CLOCK_SIM) {
    return;
  }
  note(realtime, ILK_RT_TIMER, prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) == 0);
  note(realtime, ILK_RT_MLOCK, lock_memory());
  note(realtime, ILK_RT_FIFO, take_priority(priority));
}

ilk_run_permit_t ilk_realtime_permit(ilk_clock_t clock, bool simulated, uint32_t asked, uint32_t granted) {
  const bool real = clock == ILK_CLOCK_REAL;
  const bool sufficient = (asked & ~granted) == 0u;
  if (!simulated) {
    return real && sufficient ? ILK_RUN : ILK_REFUSE;
  }
  return !real || sufficient ? ILK_RUN : ILK_RUN_DEGRADED;
}
