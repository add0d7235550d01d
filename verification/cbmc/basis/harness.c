/**
 * @file
 * P14: what P1 to P3 rest on is compared exactly. The words of a configuration that was valid are remembered;
 * whichever of them, and however many at once, hold other bits later is noticed, and nothing else is.
 */
#include "integrity.c"
#include "proof.h"

static bool same_axis(const ilk_axis_config_t* a, const ilk_axis_config_t* b) {
  return (a->card == b->card) && (a->limit_side == b->limit_side) &&
         (a->motor_direction == b->motor_direction);
}

void harness(void) {
  ilk_config_t at_start;
  ilk_config_t now;
  ilk_state_t state;
  const uint32_t trusted = state.config_sound;
  bool same = (at_start.pedal_channels == now.pedal_channels) &&
              (at_start.app_timeout_ticks == now.app_timeout_ticks);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    GIVEN((at_start.axis[slot].card < ILK_CARD_COUNT) && (at_start.axis[slot].limit_side < ILK_LIMIT_COUNT) &&
          (at_start.axis[slot].motor_direction <= 1u)); /* proof `config_slot` */
    same = same && same_axis(&at_start.axis[slot], &now.axis[slot]);
  }
  remember_basis(&state, &at_start);
  SHOW(state.config_sound == trusted, "P13: remembering gives no trust");
  const bool kept = ilk_config_check_basis(&now, &state);
  SHOW(kept == same, "P14: every change of what P1 to P3 rest on is noticed, and nothing else");
  SHOW(state.config_sound == (kept ? trusted : 0u), "P13: a change ends trust, and nothing begins it");
  GOAL(goal_kept, kept);
  GOAL(goal_last_motor, !kept && same_axis(&at_start.axis[8], &now.axis[8]) &&
                            (now.axis[9].motor_direction == (at_start.axis[9].motor_direction + 256u)));
  GOAL(goal_carry, !kept && (now.axis[0].card == (at_start.axis[0].card + 256u)) &&
                       (now.axis[0].limit_side == (at_start.axis[0].limit_side - 1u)));
  GOAL(never_aliased, kept && (now.axis[3].card > 255u));
}
