/**
 * @file
 * The safety kernel: one total function, called once per tick, decides everything.
 *
 * Pure integer C11: no I/O, heap, floating point, recursion, function pointer or hidden state.
 * The same configuration, inputs and requests give the same bits on every machine.
 */
#ifndef INTERLOCK_KERNEL_H
#define INTERLOCK_KERNEL_H

#include <stdint.h>

#include "interlock/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** First rule of the configuration that is broken, or NONE (property P13). */
ilk_config_verdict_t ilk_config_validate(const ilk_config_t *config);

/** CRC-32 (IEEE 802.3, reflected) of all words before `crc`, each least significant byte first. */
uint32_t ilk_config_crc(const ilk_config_t *config);

/** CRC-32 (IEEE 802.3, reflected) of all words before `crc`, each least significant byte first. */
uint32_t ilk_request_crc(const ilk_request_t *request);

/**
 * Starts the kernel: a valid configuration leads to LOCKED (BOOT), any other to INIT, in which
 * every step puts out zero.
 */
ilk_config_verdict_t ilk_init(const ilk_config_t *config, ilk_state_t *state);

/** Positions from which outward drive is allowed no more, and beyond which no setpoint is accepted. */
typedef struct {
  int64_t low;  /**< in counts */
  int64_t high; /**< in counts */
} ilk_reach_t;

/** Of an axis that is homed: soft limits less coast, and where its switch is sure to be open. */
ilk_reach_t ilk_reach(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** What is left of the travel by MOVE of this press, coast kept back; 0 when nothing is. */
uint32_t ilk_unhomed_travel_left(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Largest drive: the axis' own, a smaller one while it is not homed. */
uint32_t ilk_drive_bound(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/**
 * One tick. Total: defined for every bit pattern of every argument.
 *
 * @param count requests in `requests`; those beyond ILK_REQUESTS_PER_TICK are not looked at.
 */
void ilk_step(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
              const ilk_request_t requests[], uint32_t count, ilk_outputs_t *out);

#ifdef __cplusplus
}
#endif

#endif
