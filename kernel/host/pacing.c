#include "pacing.h"

#include <time.h>

#include "clock.h"
#include "futex.h"

/** Longest sleep between looks at the socket and the stop flag. */
#define LOOK_INTERVAL_NS 1000000L

bool ilk_pacing_may_go_on(uint32_t tick, uint32_t seen_tick) {
  const uint32_t ahead = tick + 1u - seen_tick;
  return (int32_t)ahead <= (int32_t)ILK_LINK_TICKS_AHEAD;
}

/** Beyond what it had seen when it was given up: an old or absurd `seen_tick` holds the kernel only once. */
static bool is_back(const ilk_pacing_t *pacing, uint32_t seen_tick) {
  const uint32_t ahead = seen_tick - pacing->given_up_at;
  return ahead <= (uint32_t)INT32_MAX;
}

bool ilk_pacing_wait(ilk_pacing_t *pacing, const ilk_attachment_t *attachment, uint32_t tick,
                     uint32_t patience_ms, const volatile sig_atomic_t *stop) {
  const struct timespec interval = {.tv_nsec = LOOK_INTERVAL_NS};
  const uint64_t end_ns = ilk_now_ns() + (uint64_t)patience_ms * 1000000u;
  while (ilk_attachment_is_open(attachment) && *stop == 0) {
    const uint32_t *seen_word = &attachment->regions.app->seen_tick;
    const uint32_t seen_tick = __atomic_load_n(seen_word, __ATOMIC_ACQUIRE);
    pacing->gave_up = pacing->gave_up && !is_back(pacing, seen_tick);
    if (pacing->gave_up || ilk_pacing_may_go_on(tick, seen_tick)) {
      return !pacing->gave_up;
    }
    if (ilk_now_ns() >= end_ns) {
      *pacing = (ilk_pacing_t){.gave_up = true, .given_up_at = tick};
      return false;
    }
    (void)ilk_futex_wait(seen_word, seen_tick, &interval);
  }
  return true;
}
