#include "interlock/service_notify.h"

#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define US_PER_MS 1000
#define WATCHDOG_MS_MAX 3600000

/** The whole number that the variable holds, 0 when there is none. */
static long number_in(const char *text) {
  char *end = NULL;
  errno = 0;
  const long number = text == NULL ? 0 : strtol(text, &end, 10);
  return errno == 0 && end != text && end != NULL && *end == '\0' ? number : 0;
}

/** The watchdog counts for the process that the manager started, not for one that inherited its words. */
static uint32_t watchdog_ms(void) {
  const long interval_ms = number_in(getenv("WATCHDOG_USEC")) / US_PER_MS;
  const char *process = getenv("WATCHDOG_PID");
  const bool ours = process == NULL || number_in(process) == (long)getpid();
  return ours && interval_ms > 0 && interval_ms <= WATCHDOG_MS_MAX ? (uint32_t)interval_ms : 0u;
}

/** Returns the length of the address, 0 when the path is none. */
static socklen_t address_of(const char *path, struct sockaddr_un *address) {
  const size_t length = strlen(path);
  if ((path[0] != '/' && path[0] != '@') || length < 2u || length >= sizeof address->sun_path) {
    return 0u;
  }
  *address = (struct sockaddr_un){.sun_family = AF_UNIX};
  (void)memcpy(address->sun_path, path, length);
  if (path[0] == '@') {
    address->sun_path[0] = '\0';
  }
  return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
}

bool ilk_service_notify_open(ilk_service_notify_t *notify) {
  const char *path = getenv("NOTIFY_SOCKET");
  *notify = (ilk_service_notify_t){.descriptor = -1};
  if (path == NULL || path[0] == '\0') {
    return true;
  }
  struct sockaddr_un address;
  const socklen_t length = address_of(path, &address);
  if (length == 0u) {
    errno = EINVAL;
    return false;
  }
  notify->descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (notify->descriptor < 0) {
    return false;
  }
  if (connect(notify->descriptor, (const struct sockaddr *)&address, length) != 0) {
    const int reason = errno;
    ilk_service_notify_close(notify);
    errno = reason;
    return false;
  }
  notify->watchdog_ms = watchdog_ms();
  return true;
}

void ilk_service_notify_send(const ilk_service_notify_t *notify, const char *message) {
  if (notify->descriptor >= 0) {
    (void)send(notify->descriptor, message, strlen(message), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
}

void ilk_service_notify_close(ilk_service_notify_t *notify) {
  if (notify->descriptor >= 0) {
    (void)close(notify->descriptor);
    notify->descriptor = -1;
  }
}
