/**
 * @file
 * What a process tells the service manager that started it: that it is ready, that it lives, that it ends.
 *
 * The protocol of systemd (sd_notify(3)): a datagram to the Unix socket that $NOTIFY_SOCKET names, `@` for an
 * abstract one. Without a service manager nothing is sent, and nothing else is different.
 */
#ifndef INTERLOCK_SERVICE_NOTIFY_H
#define INTERLOCK_SERVICE_NOTIFY_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int descriptor; /**< connected to the service manager, or -1 */
  uint32_t
      watchdog_ms; /**< longest silence before the service manager ends the process; 0: it does not watch */
} ilk_service_notify_t;

/**
 * Connects to the service manager of this process, if there is one.
 *
 * @return false when one is named that cannot be reached; `errno` says why.
 */
bool ilk_service_notify_open(ilk_service_notify_t *notify);

/** Sends one message, such as "READY=1", and never waits: a manager that does not read loses it. */
void ilk_service_notify_send(const ilk_service_notify_t *notify, const char *message);

/** Nothing is sent afterwards. */
void ilk_service_notify_close(ilk_service_notify_t *notify);

#ifdef __cplusplus
}
#endif

#endif
