/**
 * @file
 * The tick: wait, bus, step, publish. Once it runs it allocates nothing, takes no lock, opens no file and
 * writes to no console.
 */
#ifndef INTERLOCK_HOST_LOOP_H
#define INTERLOCK_HOST_LOOP_H

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

#include "black_box.h"
#include "bus.h"
#include "clock.h"
#include "interlock/link.h"
#include "lateness.h"
#include "link_mailbox.h"
#include "pacing.h"
#include "publisher.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the loop works with. */
typedef struct {
  const ilk_config_t *config;
  ilk_bus_t bus;
  ilk_link_mailbox_t *mailbox;
  const volatile sig_atomic_t *stop; /**< ends the loop when it is not 0 */

  ilk_ticker_t ticker;
  ilk_pacing_t pacing;
  ilk_lateness_watch_t lateness;
  uint32_t beats; /**< ticks begun, atomic, for whoever watches the loop; wraps */
  bool bus_alive;
  bool rebuilt;                 /**< a damaged state was put aside: the next tick begins with another nonce */
  uint64_t bus_ns;              /**< time of the newest transaction */
  ilk_attachment_t *attachment; /**< being served, or NULL */
  uint32_t request_tail;        /**< of that attachment */
  ilk_publisher_t publisher;
  ilk_black_box_t *black_box; /**< or NULL */
  ilk_request_t request[ILK_REQUESTS_PER_TICK];
  ilk_outputs_t out;
  ilk_snapshot_t shown; /**< holds the kernel's state and inputs themselves */
} ilk_loop_t;

/** What distinguishes one run from another. */
typedef struct {
  ilk_clock_t clock;
  double speed; /**< of the simulated clock, 0: as fast as possible */
  bool degraded;
  uint32_t granted; /**< bits by ilk_rt_measure_t */
} ilk_run_terms_t;

/** Starts the kernel core on a valid configuration; the first deadline counts from now. */
void ilk_loop_init(ilk_loop_t *loop, const ilk_config_t *config, const ilk_run_terms_t *terms, ilk_bus_t bus,
                   ilk_link_mailbox_t *mailbox, const volatile sig_atomic_t *stop);

/** Records each tick from now on; before the first one. */
void ilk_loop_record(ilk_loop_t *loop, ilk_black_box_t *black_box);

/**
 * Whether a tick that began `late_ns` after its deadline counts against the kernel's overrun limit.
 *
 * Only missed deadlines of the executive itself do: not when degraded, where the report says that none can
 * be promised, and not the time that a simulated bus took in the tick before.
 */
bool ilk_loop_is_missed(const ilk_loop_t *loop, uint64_t late_ns);

/** One tick; returns without one when `*stop` is set during the wait. */
void ilk_loop_tick(ilk_loop_t *loop);

/** Ticks until `*stop` is set. */
void ilk_loop_run(ilk_loop_t *loop);

#ifdef __cplusplus
}
#endif

#endif
