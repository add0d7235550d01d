#include "interlock/link_reader.h"

#include "atomic_words.h"
#include "futex.h"
#include "timespec.h"

#define ATTEMPTS 100u

bool ilk_link_read_snapshot(const ilk_link_kernel_region_t *region, ilk_snapshot_t *snapshot,
                            uint32_t *lock) {
  for (unsigned attempt = 0; attempt < ATTEMPTS; ++attempt) {
    const uint32_t before = __atomic_load_n(&region->snapshot_lock, __ATOMIC_ACQUIRE);
    if (before == 0u) {
      return false;
    }
    if ((before & 1u) != 0u) {
      continue;
    }
    ilk_words_load((uint32_t *)snapshot, (const uint32_t *)&region->snapshot,
                   sizeof *snapshot / sizeof(uint32_t));
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (__atomic_load_n(&region->snapshot_lock, __ATOMIC_RELAXED) == before) {
      *lock = before;
      return true;
    }
  }
  return false;
}

static bool newer_snapshot(uint32_t current, uint32_t lock) {
  return (current & 1u) == 0u && current != lock;
}

bool ilk_link_wait_snapshot(const ilk_link_kernel_region_t *region, uint32_t lock, uint32_t timeout_ms) {
  const struct timespec timeout = ilk_timespec((uint64_t)timeout_ms * 1000000u);
  for (unsigned attempt = 0; attempt < ATTEMPTS; ++attempt) {
    const uint32_t current = __atomic_load_n(&region->snapshot_lock, __ATOMIC_ACQUIRE);
    if (newer_snapshot(current, lock)) {
      return true;
    }
    if (!ilk_futex_wait(&region->snapshot_lock, current, &timeout)) {
      return newer_snapshot(__atomic_load_n(&region->snapshot_lock, __ATOMIC_ACQUIRE), lock);
    }
  }
  return false;
}

static bool copy_event(const ilk_event_t *shared, uint32_t number, ilk_event_t *event) {
  if (__atomic_load_n(&shared->number, __ATOMIC_ACQUIRE) != number) {
    return false;
  }
  ilk_words_load((uint32_t *)event, (const uint32_t *)shared, sizeof *event / sizeof(uint32_t));
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  return __atomic_load_n(&shared->number, __ATOMIC_RELAXED) == number;
}

bool ilk_link_next_event(const ilk_link_kernel_region_t *region, uint32_t *next, uint32_t *lost,
                         ilk_event_t *event) {
  for (unsigned attempt = 0; attempt < ATTEMPTS; ++attempt) {
    const uint32_t head = __atomic_load_n(&region->event_head, __ATOMIC_ACQUIRE);
    const uint32_t unread = head - *next;
    if (unread == 0u) {
      return false;
    }
    if (unread > ILK_LINK_EVENTS) {
      *lost += unread - ILK_LINK_EVENTS;
      *next = head - ILK_LINK_EVENTS;
    }
    const bool copied = copy_event(&region->event[*next % ILK_LINK_EVENTS], *next + 1u, event);
    *next += 1u;
    if (copied) {
      return true;
    }
    *lost += 1u;
  }
  return false;
}

bool ilk_link_put_request(const ilk_link_kernel_region_t *kernel, ilk_link_app_region_t *app,
                          const ilk_request_t *request) {
  const uint32_t head = __atomic_load_n(&app->request_head, __ATOMIC_RELAXED);
  const uint32_t tail = __atomic_load_n(&kernel->request_tail, __ATOMIC_ACQUIRE);
  if (head - tail >= ILK_LINK_REQUESTS) {
    return false;
  }
  ilk_words_store((uint32_t *)&app->request[head % ILK_LINK_REQUESTS], (const uint32_t *)request,
                  sizeof *request / sizeof(uint32_t));
  __atomic_store_n(&app->request_head, head + 1u, __ATOMIC_RELEASE);
  return true;
}

void ilk_link_set_seen_tick(ilk_link_app_region_t *app, uint32_t tick) {
  __atomic_store_n(&app->seen_tick, tick, __ATOMIC_RELEASE);
  ilk_futex_wake(&app->seen_tick, 1u);
}
