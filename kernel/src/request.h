/**
 * @file
 * Requests: one verdict each, and their effects (property P11).
 */
#ifndef ILK_REQUEST_H
#define ILK_REQUEST_H

#include "interlock/acsl.h"
#include "interlock/types.h"

/** Judges a request. Changes nothing. */
/*@ requires readable: \valid_read(config) && \valid_read(state) && \valid_read(request);
  @ assigns  \nothing;
  @ ensures  P11_inert_refusal: 0 <= \result < ILK_VERDICT_COUNT;
  @ ensures  known: \result == ILK_VERDICT_ACCEPTED ==>
  @   ILK_REQUEST_HEARTBEAT <= request->kind <= ILK_REQUEST_RESTORE;
  @ ensures  axis: \result == ILK_VERDICT_ACCEPTED && names_axis(request->kind) ==>
  @   request->axis < ILK_SLOTS && carries_axis(&config->axis[request->axis]);
  @ ensures  row: \result == ILK_VERDICT_ACCEPTED ==> acceptable(config, state, request);
  @*/
ilk_verdict_t ilk_request_judge(const ilk_config_t *config, const ilk_state_t *state,
                                const ilk_request_t *request);

/** Carries out a request that was judged ACCEPTED in this state. */
void ilk_request_apply(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t *request);

#endif
