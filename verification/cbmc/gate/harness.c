/**
 * @file
 * Phase 7 for one axis: what it wants and what the output gate lets through, as exact relations.
 *
 * Configuration, state, axis and wish are arbitrary bits: P1, P2 and P3 hold whatever damage they bear (P14).
 */
#include "counts.h"
#include "gate.h"
#include "proof.h"
#include "valid.h"

static void show_wish(const ilk_axis_config_t* axis_config, const ilk_axis_t* axis) {
  const ilk_command_t wish = ilk_wanted_command(axis_config, axis);
  const int64_t distance = (int64_t)axis->setpoint_counts - axis->position_counts;
  const int64_t deadband = axis_config->deadband_counts;
  const bool upper = axis_config->limit_side == ILK_LIMIT_UPPER;
  if (axis->state == ILK_AXIS_MOVING) {
    SHOW((wish.direction == ILK_DIRECTION_INCREASING) == (distance > deadband),
         "MOVE: up to a setpoint above");
    SHOW((wish.direction == ILK_DIRECTION_DECREASING) == (-distance > deadband), "MOVE: down to one below");
    SHOW((wish.drive == axis->drive) && (wish.amplitude == axis->amplitude), "MOVE: as accepted");
  } else if (axis->state == ILK_AXIS_HOMING) {
    const uint32_t to_switch = upper ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_DECREASING;
    const uint32_t from_switch = upper ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING;
    SHOW(wish.direction == ((axis->homing_phase == ILK_HOMING_SEEK)       ? to_switch
                            : (axis->homing_phase == ILK_HOMING_BACK_OFF) ? from_switch
                                                                          : ILK_DIRECTION_NONE),
         "HOME: away from a switch that is triggered, then towards it, then rest");
    SHOW((wish.drive == axis_config->home_drive) && (wish.amplitude == axis_config->home_amplitude),
         "HOME: at the homing drive");
  } else {
    SHOW((wish.drive == 0u) && (wish.amplitude == 0u), "an axis in any other state wants nothing");
  }
  SHOW(wish.direction < ILK_DIRECTION_COUNT, "a wish has a known direction");
  GOAL(goal_moves_down, (axis->state == ILK_AXIS_MOVING) && (wish.direction == ILK_DIRECTION_DECREASING));
  GOAL(goal_backs_off_upwards,
       (axis->homing_phase == ILK_HOMING_BACK_OFF) && (wish.direction == ILK_DIRECTION_INCREASING));
  GOAL(goal_arrived, (axis->state == ILK_AXIS_MOVING) && (wish.direction == ILK_DIRECTION_NONE));
}

/** Fills in which gates block, each stated from kernel.md alone. */
static void judge_gates(const ilk_axis_config_t* axis_config, const ilk_state_t* state,
                        const ilk_axis_t* axis, const ilk_command_t* wish, bool blocks[ILK_GATE_COUNT]) {
  const bool up = wish->direction == ILK_DIRECTION_INCREASING;
  const bool down = wish->direction == ILK_DIRECTION_DECREASING;
  const int64_t position = axis->position_counts;
  const int64_t coast = axis_config->coast_counts;
  const bool homing = axis->state == ILK_AXIS_HOMING;
  const bool homed = axis->homed != 0u;
  const int64_t bound = homed ? axis_config->max_drive : axis_config->unhomed_max_drive;
  blocks[ILK_GATE_OPEN] = false;
  blocks[ILK_GATE_MODE] = state->mode != ILK_MODE_MOTION;
  blocks[ILK_GATE_PEDAL] = state->pedal != ILK_PEDAL_PRESSED;
  blocks[ILK_GATE_ESTOP] = state->estop != 0u;
  blocks[ILK_GATE_CARD] = axis->card_valid == 0u;
  blocks[ILK_GATE_ENABLE] = (axis->state != ILK_AXIS_ENABLED) && (axis->state != ILK_AXIS_MOVING) && !homing;
  blocks[ILK_GATE_LEASE] = !homing && ((axis->state != ILK_AXIS_MOVING) || (axis->lease_ticks == 0u));
  blocks[ILK_GATE_SETPOINT] = (!up && !down) || (wish->drive == 0u);
  blocks[ILK_GATE_HARD_LIMIT] =
      (axis->switch_triggered != 0u) && ((up && (axis_config->limit_side == ILK_LIMIT_UPPER)) ||
                                         (down && (axis_config->limit_side == ILK_LIMIT_LOWER)));
  blocks[ILK_GATE_SOFT_LIMIT] = homed && ((up && ((position + coast) >= axis_config->max_counts)) ||
                                          (down && ((position - coast) <= axis_config->min_counts)));
  blocks[ILK_GATE_UNHOMED_TRAVEL] = !homed && !homing &&
                                    ((directed(wish->direction, axis->press_travel_counts) + coast) >=
                                     (int64_t)axis_config->unhomed_travel_counts);
  blocks[ILK_GATE_DRIVE] = (wish->drive > bound) || (wish->drive > largest_drive_of(axis_config->card)) ||
                           (wish->amplitude > axis_config->max_amplitude) || (wish->amplitude > 255u);
}

static void show_corollaries(const ilk_axis_config_t* axis_config, const ilk_state_t* state,
                             const ilk_axis_t* axis, const ilk_command_t* wish) {
  const bool homing = axis->state == ILK_AXIS_HOMING;
  const bool up = wish->direction == ILK_DIRECTION_INCREASING;
  SHOW((state->mode == ILK_MODE_MOTION) && (state->pedal == ILK_PEDAL_PRESSED) && (state->estop == 0u),
       "P1, P2: drive only in MOTION with the pedal pressed and no E-stop");
  SHOW(
      (axis->card_valid != 0u) && (homing || ((axis->state == ILK_AXIS_MOVING) && (axis->lease_ticks != 0u))),
      "P1: drive only with a valid card and a live lease or homing");
  SHOW(axis->state < ILK_AXIS_FAULTED, "P1, P5: no drive for a faulted axis");
  SHOW(
      (axis->switch_triggered == 0u) || (axis_config->limit_side != (up ? ILK_LIMIT_UPPER : ILK_LIMIT_LOWER)),
      "P3: no drive towards a triggered switch");
  if (axis->homed != 0u) {
    const int64_t room = up ? ((int64_t)axis_config->max_counts - axis->position_counts)
                            : ((int64_t)axis->position_counts - axis_config->min_counts);
    SHOW(room > (int64_t)axis_config->coast_counts, "P4: no drive outward beyond limit minus coast");
    SHOW(wish->drive <= axis_config->max_drive, "P7: at most max_drive");
  } else {
    SHOW(wish->drive <= axis_config->unhomed_max_drive, "P7: at most unhomed_max_drive while not homed");
  }
}

void harness(void) {
  ilk_state_t state;
  ilk_axis_t axis;
  ilk_axis_config_t axis_config;
  ilk_command_t wish;
  const bool valid = valid_geometry(&axis_config) && valid_bounds(&axis_config);

  show_wish(&axis_config, &axis);
  const ilk_gate_t gate = ilk_output_gate(&axis_config, &state, &axis, &wish);
  SHOW(gate < ILK_GATE_COUNT, "P15: a known gate");
  if (gate == ILK_GATE_OPEN) {
    show_corollaries(&axis_config, &state, &axis, &wish);
  }
  if (valid) {
    bool blocks[ILK_GATE_COUNT];
    judge_gates(&axis_config, &state, &axis, &wish, blocks);
    bool any_before = false;
    for (uint32_t code = ILK_GATE_MODE; code < ILK_GATE_COUNT; code++) {
      SHOW((gate == code) == (blocks[code] && !any_before),
           "P1: the first condition that does not hold is told");
      any_before = any_before || blocks[code];
    }
    SHOW((gate == ILK_GATE_OPEN) == !any_before, "P1: drive exactly when every condition holds");
  }
  GOAL(goal_open_homed, valid && (gate == ILK_GATE_OPEN) && (axis.homed != 0u));
  GOAL(goal_open_not_homed, valid && (gate == ILK_GATE_OPEN) && (axis.homed == 0u) && (wish.drive > 1u));
  GOAL(goal_open_away_from_switch, valid && (gate == ILK_GATE_OPEN) && (axis.switch_triggered != 0u));
  GOAL(goal_open_inward_beyond_limit, valid && (gate == ILK_GATE_OPEN) && (axis.homed != 0u) &&
                                          (axis.position_counts > axis_config.max_counts));
  GOAL(goal_blocked_soft_limit, valid && (gate == ILK_GATE_SOFT_LIMIT));
  GOAL(goal_blocked_hard_limit, valid && (gate == ILK_GATE_HARD_LIMIT));
  GOAL(goal_blocked_unhomed_travel, valid && (gate == ILK_GATE_UNHOMED_TRAVEL));
  GOAL(goal_blocked_drive, valid && (gate == ILK_GATE_DRIVE));
  GOAL(never_open_without_motion, (gate == ILK_GATE_OPEN) && (state.mode != ILK_MODE_MOTION));
  GOAL(never_open_faulted, (gate == ILK_GATE_OPEN) && (axis.state == ILK_AXIS_FAULTED));
  GOAL(never_open_at_rest, (gate == ILK_GATE_OPEN) && (wish.drive == 0u));
}
