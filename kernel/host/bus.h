/**
 * @file
 * What the loop knows of a card bus. A driver fills in this structure.
 */
#ifndef INTERLOCK_HOST_BUS_H
#define INTERLOCK_HOST_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  void *driver;   /**< passed to `transact` */
  bool simulated; /**< no hardware moves; the time of a transaction says nothing about the executive */

  /**
   * One transaction with all cards: sends frames and lamps of `out`, fills in `in`.
   *
   * Bounded in time, allocates nothing; with the simulated clock alone it waits for its plant. When it fails,
   * `transaction_done` and `frames_received` are 0 and the contacts keep what was last read of them: no card
   * is valid in such a tick, so nothing is driven, and the kernel locks for the bus instead of a contact that
   * nobody opened.
   *
   * @param tick for the record of the other side.
   * @return false when there is no other side to wait for, so that the loop must pace itself.
   */
  bool (*transact)(void *driver, uint32_t tick, const ilk_outputs_t *out, ilk_inputs_t *in);
} ilk_bus_t;

#ifdef __cplusplus
}
#endif

#endif
