/**
 * @file
 * The simulated bus: the kernel's end of sim_bus.h.
 *
 * The loop uses one descriptor number for ever. A service thread watches it, and when the plant goes away
 * connects again and swaps the new connection in under the same number, so the loop never connects,
 * closes or waits for a plant that is not there.
 *
 * With the simulated clock the loop waits for each reply as long as the connection lives: no time passes for
 * the robot meanwhile. With the real clock it waits 200 ms at most.
 */
#ifndef INTERLOCK_HOST_BUS_SIM_H
#define INTERLOCK_HOST_BUS_SIM_H

#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <sys/un.h>

#include "bus.h"
#include "error.h"
#include "interlock/sim_bus.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  int descriptor;           /**< of the connection, live or dead; its number never changes */
  int stop;                 /**< event descriptor */
  uint32_t connections;     /**< made so far; atomic */
  uint32_t loop_connection; /**< the one that the loop last used */
  bool awaiting_reply;      /**< an exchange of this connection is unanswered */
  uint64_t patience_ns;     /**< longest wait for a reply */
  uint64_t period_ns;
  const volatile sig_atomic_t *stopped; /**< ends a wait when it is not 0 */
  struct sockaddr_un address;
  ilk_sim_hello_t hello;
  ilk_sim_exchange_t exchange;
  ilk_sim_reply_t reply;
  pthread_t thread;
} ilk_bus_sim_t;

/**
 * Connects to the plant, which must be listening, agrees on the terms and starts the watching thread.
 *
 * @param stopped ends each wait of the loop when it is not 0.
 */
bool ilk_bus_sim_open(ilk_bus_sim_t *sim, const char *path, ilk_clock_t clock, const ilk_config_t *config,
                      const volatile sig_atomic_t *stopped, ilk_error_t *error);

/** The driver for the loop. */
ilk_bus_t ilk_bus_sim_driver(ilk_bus_sim_t *sim);

/** Closes the connection; nothing to do when there is none. */
void ilk_bus_sim_close(ilk_bus_sim_t *sim);

#ifdef __cplusplus
}
#endif

#endif
