/**
 * @file
 * Requests: one verdict each, and their effects (property P11).
 */
#ifndef ILK_REQUEST_H
#define ILK_REQUEST_H

#include "interlock/types.h"

/** Judges a request. Changes nothing. */
ilk_verdict_t ilk_request_judge(const ilk_config_t *config, const ilk_state_t *state,
                                const ilk_request_t *request);

/** Carries out a request that was judged ACCEPTED in this state. */
void ilk_request_apply(const ilk_config_t *config, ilk_state_t *state, const ilk_request_t *request);

#endif
