/**
 * @file
 * P14: a state that fails its check. Phase 1 rebuilds it from nothing, whatever bits it holds: LOCKED
 * (INTEGRITY) with every axis disabled and the configuration not trusted. Without trust no RESET is accepted,
 * and LOCKED opens no gate: so the tick gives zero drive and ends LOCKED.
 */
#include "proof.h"
#include "step.c"

bool check_fails(const ilk_state_t* state) {
  (void)state;
  return false;
}

uint32_t any_axis_crc(uint32_t crc, const ilk_axis_config_t* axis) {
  uint32_t next;
  (void)crc;
  (void)axis;
  return next;
}

uint32_t any_system_crc(uint32_t crc, const ilk_config_t* config) {
  uint32_t next;
  (void)crc;
  (void)config;
  return next;
}

uint32_t any_request_crc(const ilk_request_t* request) {
  uint32_t crc;
  (void)request;
  return crc;
}

static void show_rebuilt(void) {
  ilk_config_t config;
  ilk_state_t state;
  const uint32_t damaged_seal = state.seal;
  const ilk_config_check_t check = check_integrity(&config, &state);
  SHOW((state.mode == ILK_MODE_LOCKED) && (state.cause == ILK_CAUSE_INTEGRITY), "P14: LOCKED (INTEGRITY)");
  SHOW((state.cause_value == damaged_seal) && (state.causes_seen == (1u << ILK_CAUSE_INTEGRITY)),
       "P14: the damaged seal is told");
  SHOW((state.config_sound == 0u) && (state.config_slice == 1u) && !check.damaged,
       "P13: the configuration is not trusted until a whole pass has agreed");
  SHOW((state.tick == 0u) && (state.pedal_armed == 0u) && (state.app_alive == 0u) && (state.estop == 1u),
       "P9, P10: ticks, consent, app and E-stop start anew");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    const ilk_axis_t* axis = &state.axis[slot];
    SHOW((axis->state == ILK_AXIS_DISABLED) && (axis->homed == 0u) && (axis->lease_ticks == 0u) &&
             (axis->drive == 0u) && (axis->card_seen == 0u) && (axis->fault == ILK_FAULT_NONE),
         "P14: no axis remembers anything");
  }
  GOAL(goal_rebuilt, state.cause_value == 5u);
}

static void show_no_reset_without_trust(void) {
  ilk_config_t config;
  ilk_state_t state;
  ilk_request_t request;
  state.config_sound = 0u;
  request.kind = ILK_REQUEST_RESET;
  const ilk_verdict_t verdict = ilk_request_judge(&config, &state, &request);
  SHOW(verdict != ILK_VERDICT_ACCEPTED, "P14: RESET is refused while the configuration is not trusted");
  GOAL(goal_refused_for_its_cause, verdict == ILK_VERDICT_CAUSE_PRESENT);
  GOAL(never_reset_without_trust, verdict == ILK_VERDICT_ACCEPTED);
}

void harness(void) {
  show_rebuilt();
  show_no_reset_without_trust();
}
