/**
 * @file
 * P13: in INIT no request is accepted; one that is whole, in order and names what there is gets MODE.
 * Configuration, request and the rest of the state are arbitrary bits.
 */
#include "proof.h"
#include "request.h"

uint32_t some_request_crc(const ilk_request_t* request) {
  uint32_t crc;
  (void)request;
  return crc;
}

void harness(void) {
  ilk_config_t config;
  ilk_state_t state;
  ilk_request_t request;
  state.mode = ILK_MODE_INIT;
  const ilk_verdict_t verdict = ilk_request_judge(&config, &state, &request);
  SHOW(verdict != ILK_VERDICT_ACCEPTED, "P13: in INIT nothing is accepted");
  SHOW(verdict <= ILK_VERDICT_MODE, "P13: in INIT a request that is whole gets MODE");
  GOAL(goal_mode, verdict == ILK_VERDICT_MODE);
  GOAL(goal_checksum, verdict == ILK_VERDICT_CHECKSUM);
  GOAL(goal_axis, (verdict == ILK_VERDICT_AXIS) && (request.axis == 0u));
  GOAL(never_beyond_mode, verdict > ILK_VERDICT_MODE);
}
