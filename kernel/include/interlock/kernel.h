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

#include "interlock/acsl_config.h"
#include "interlock/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** First rule of the configuration that is broken, or NONE (property P13). */
/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  P13_valid: \result.error == ILK_CONFIG_ERROR_NONE ==> valid_config(config);
  @ ensures  known: \result.error < ILK_CONFIG_ERROR_COUNT && \result.slot <= ILK_SLOTS;
  @ ensures  P13_first: \result.slot < ILK_SLOTS ==> valid_slots(config, \result.slot)
  @   && \result.error == slot_rule(&config->axis[\result.slot], config->period_us)
  @   && \result.error != ILK_CONFIG_ERROR_NONE;
  @*/
ilk_config_verdict_t ilk_config_validate(const ilk_config_t *config);

/** CRC-32 (IEEE 802.3, reflected) of all words before `crc`, each least significant byte first. */
/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @*/
uint32_t ilk_config_crc(const ilk_config_t *config);

/** CRC-32 (IEEE 802.3, reflected) of all words before `crc`, each least significant byte first. */
/*@ requires readable: \valid_read(request);
  @ assigns  \nothing;
  @*/
uint32_t ilk_request_crc(const ilk_request_t *request);

/**
 * Starts the kernel: a valid configuration leads to LOCKED (BOOT), any other to INIT, in which
 * every step puts out zero.
 */
/*@ requires valid: \valid_read(config) && \valid(state) && \separated(config, state);
  @ assigns  *state;
  @ ensures  P15_invariant: sound(state);
  @ ensures  P13_init: \result.error != ILK_CONFIG_ERROR_NONE <==> state->mode == ILK_MODE_INIT;
  @ ensures  P13_valid: state->mode != ILK_MODE_INIT ==> \old(valid_config(config)) && state->config_sound == 1;
  @ ensures  boot: \result.error == ILK_CONFIG_ERROR_NONE ==>
  @   state->mode == ILK_MODE_LOCKED && state->cause == ILK_CAUSE_BOOT;
  @ ensures  P12_no_leap: blank_axes(state);
  @*/
ilk_config_verdict_t ilk_init(const ilk_config_t *config, ilk_state_t *state);

/**
 * One tick. Total: defined for every bit pattern of every argument.
 *
 * @param count requests in `requests`; those beyond ILK_REQUESTS_PER_TICK are not looked at.
 */
/*@ requires valid: \valid_read(config) && \valid(state) && \valid_read(in) && \valid(out)
  @   && \valid_read(requests + (0 .. \min(count, ILK_REQUESTS_PER_TICK) - 1));
  @ requires apart: \separated(config, state, out) && \separated(in, state, out)
  @   && \separated(state, requests + (0 .. \min(count, ILK_REQUESTS_PER_TICK) - 1))
  @   && \separated(out, requests + (0 .. \min(count, ILK_REQUESTS_PER_TICK) - 1));
  @ assigns  *state, *out;
  @ ensures  P15_invariant: sound(state);
  @ ensures  P11_one_verdict: out->verdict_count == \min(count, ILK_REQUESTS_PER_TICK);
  @ ensures  P2_stop: !consented(state) ==> at_zero(out) && all_still(out);
  @ ensures  P14_contained: !\old(sealed(state) && sound(state)) ==>
  @   state->mode == ILK_MODE_LOCKED && state->cause == ILK_CAUSE_INTEGRITY;
  @ ensures  P14_basis: \old(state->mode) != ILK_MODE_INIT && !\old(basis_kept(config, state)) ==>
  @   state->mode == ILK_MODE_LOCKED
  @   && (\old(state->mode) != ILK_MODE_LOCKED ==> state->cause == ILK_CAUSE_INTEGRITY);
  @*/
void ilk_step(const ilk_config_t *config, ilk_state_t *state, const ilk_inputs_t *in,
              const ilk_request_t requests[], uint32_t count, ilk_outputs_t *out);

#ifdef __cplusplus
}
#endif

#endif
