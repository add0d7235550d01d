#include "watchdog.h"

#include <errno.h>
#include <poll.h>
#include <stddef.h>
#include <string.h>
#include <sys/eventfd.h>

#include "service_thread.h"

/** So often within the manager's patience; half would do. */
#define TELLS_A_WATCHDOG 4u

static void tell_when_it_goes_on(ilk_watchdog_t *watchdog) {
  const uint32_t beats = __atomic_load_n(watchdog->beats, __ATOMIC_RELAXED);
  if (beats != watchdog->told) {
    watchdog->told = beats;
    ilk_service_notify_send(&watchdog->notify, "WATCHDOG=1");
  }
}

static void *watch_loop(void *argument) {
  ilk_watchdog_t *watchdog = argument;
  const uint32_t share_ms = watchdog->notify.watchdog_ms / TELLS_A_WATCHDOG;
  const int pause_ms = (int)share_ms;
  struct pollfd stop = {.fd = watchdog->stop, .events = POLLIN};
  while (poll(&stop, 1, pause_ms) == 0) {
    tell_when_it_goes_on(watchdog);
  }
  return NULL;
}

bool ilk_watchdog_start(ilk_watchdog_t *watchdog, const uint32_t *beats, ilk_error_t *error) {
  *watchdog = (ilk_watchdog_t){.beats = beats, .stop = -1};
  if (!ilk_service_notify_open(&watchdog->notify)) {
    return ilk_fail(error, "the service manager at $NOTIFY_SOCKET cannot be reached: %s", strerror(errno));
  }
  if (watchdog->notify.watchdog_ms == 0u) {
    return true;
  }
  watchdog->stop = eventfd(0, EFD_CLOEXEC);
  if (watchdog->stop < 0) {
    return ilk_fail(error, "cannot create the watchdog's stop event: %s", strerror(errno));
  }
  watchdog->watched = ilk_service_thread_start(&watchdog->thread, watch_loop, watchdog, error);
  return watchdog->watched;
}

void ilk_watchdog_ready(const ilk_watchdog_t *watchdog) {
  ilk_service_notify_send(&watchdog->notify, "READY=1");
}

void ilk_watchdog_stop(ilk_watchdog_t *watchdog) {
  ilk_service_notify_send(&watchdog->notify, "STOPPING=1");
  if (watchdog->watched) {
    ilk_service_thread_stop(watchdog->thread, watchdog->stop);
  }
  ilk_service_notify_close(&watchdog->notify);
}
