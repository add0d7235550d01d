/**
 * @file
 * Requests of the app: one verdict each, by the table of the specification (P11).
 */
#ifndef ILK_REQUEST_H
#define ILK_REQUEST_H

#include "interlock/types.h"

/** Phase 6: judges one request and carries it out when it is accepted. */
ilk_verdict_record_t ilk_request_take(const ilk_config_t *config, const ilk_request_t *request,
                                      ilk_state_t *state);

#endif
