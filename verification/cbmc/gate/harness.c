/**
 * @file
 * Phase 7 for one axis: what it wants, and what the output gate lets through, as the contract of two leaf
 * functions. Configuration, state, axis and wish are arbitrary bits: P1 to P4 and P7 hold whatever damage
 * they bear (P14), and so does the absence of undefined behaviour (P15).
 */
#include "gate.c"
#include "proof.h"
#include "valid.h"

static uint32_t to_switch(const ilk_axis_config_t* config) {
  return (config->limit_side == ILK_LIMIT_UPPER)   ? ILK_DIRECTION_INCREASING
         : (config->limit_side == ILK_LIMIT_LOWER) ? ILK_DIRECTION_DECREASING
                                                   : ILK_DIRECTION_NONE;
}

static uint32_t from_switch(const ilk_axis_config_t* config) {
  return (config->limit_side == ILK_LIMIT_UPPER)   ? ILK_DIRECTION_DECREASING
         : (config->limit_side == ILK_LIMIT_LOWER) ? ILK_DIRECTION_INCREASING
                                                   : ILK_DIRECTION_NONE;
}

static void show_move(const ilk_axis_config_t* config, const ilk_axis_t* axis) {
  const ilk_command_t wish = ilk_wanted_command(config, axis);
  const int64_t distance = (int64_t)axis->setpoint_counts - axis->position_counts;
  const int64_t deadband = config->deadband_counts;
  SHOW((wish.direction == ILK_DIRECTION_INCREASING) == (distance > deadband), "MOVE: up to a setpoint above");
  SHOW((wish.direction == ILK_DIRECTION_DECREASING) == (-distance > deadband), "MOVE: down to one below");
  SHOW((wish.drive == axis->drive) && (wish.amplitude == axis->amplitude), "MOVE: as accepted");
  GOAL(goal_moves_down, wish.direction == ILK_DIRECTION_DECREASING);
  GOAL(goal_arrived, wish.direction == ILK_DIRECTION_NONE);
}

static void show_home(const ilk_axis_config_t* config, const ilk_axis_t* axis) {
  const ilk_command_t wish = ilk_wanted_command(config, axis);
  const uint32_t phase = axis->homing_phase;
  const bool away = (phase == ILK_HOMING_LEAVE) || (phase == ILK_HOMING_BACK_OFF);
  const bool towards = (phase == ILK_HOMING_SEEK) || (phase == ILK_HOMING_APPROACH);
  SHOW(wish.direction == (away      ? from_switch(config)
                          : towards ? to_switch(config)
                                    : ILK_DIRECTION_NONE),
       "P17: away from the switch, towards it, or at rest");
  SHOW(IMPLIES(towards || away,
               wish.drive == ((phase == ILK_HOMING_APPROACH) ? config->home_slow_drive : config->home_drive)),
       "P17: the second approach is slow");
  GOAL(goal_backs_off_upwards,
       (phase == ILK_HOMING_BACK_OFF) && (wish.direction == ILK_DIRECTION_INCREASING));
}

/** What an open gate promises. */
static void show_open(const ilk_axis_config_t* config, const ilk_system_t* system, const ilk_axis_t* axis,
                      const ilk_command_t* wish) {
  const bool homing = axis->state == ILK_AXIS_HOMING;
  const bool up = wish->direction == ILK_DIRECTION_INCREASING;
  const bool homed = axis->homed != ILK_HOMED_NOT;
  const int64_t used = homing ? axis->homing_travel_counts : axis->unhomed_travel_counts;
  const int64_t budget = homing ? config->home_travel_counts : config->unhomed_travel_counts;
  const int64_t room = up ? ((int64_t)config->max_counts - axis->position_counts)
                          : ((int64_t)axis->position_counts - config->min_counts);
  const uint64_t effort = ((uint64_t)axis->effort_high << 32) | axis->effort_low;
  SHOW((system->mode == ILK_MODE_MOTION) && (system->pedal == ILK_PEDAL_PRESSED) && (system->estop == 0u),
       "P1, P2: drive only in MOTION with the pedal pressed and no E-stop");
  SHOW(
      (axis->card_valid != 0u) && (homing || ((axis->state == ILK_AXIS_MOVING) && (axis->lease_ticks != 0u))),
      "P1: drive only with a valid card and a live lease or homing");
  SHOW((wish->drive != 0u) && (up || (wish->direction == ILK_DIRECTION_DECREASING)),
       "P1: drive has a direction and is not zero");
  SHOW((axis->switch_triggered == 0u) || (wish->direction != to_switch(config)),
       "P3: no drive towards a triggered switch");
  SHOW(IMPLIES(homed, room > (int64_t)config->coast_counts), "P4: no drive outward beyond limit minus coast");
  SHOW(wish->drive <= (homed ? config->max_drive : config->unhomed_max_drive), "P7: within the axis' bound");
  SHOW((wish->drive <= largest_drive_of(config->card)) && (wish->amplitude <= 255u),
       "P7, P16: within what the card's words carry");
  SHOW(IMPLIES(!homed, (used + config->coast_counts + config->noise_counts) < budget),
       "P7: the budget of the press, coast and noise kept back");
  SHOW(axis->stall_driven_ticks < config->stall_ticks, "P5: not longer than may be without progress");
  SHOW(IMPLIES((config->stall_effort_ticks != 0u) && (config->max_drive != 0u),
               effort < ((uint64_t)config->stall_effort_ticks * config->max_drive)),
       "P5: not with more drive than may be without progress");
}

/** When the gate must open, of a homed axis that moves between its limits: so it is not always shut. */
static bool must_open(const ilk_axis_config_t* config, const ilk_system_t* system, const ilk_axis_t* axis,
                      const ilk_command_t* wish) {
  const int64_t coast = config->coast_counts;
  const uint64_t effort = ((uint64_t)axis->effort_high << 32) | axis->effort_low;
  return (system->mode == ILK_MODE_MOTION) && (system->pedal == ILK_PEDAL_PRESSED) && (system->estop == 0u) &&
         (axis->card_valid != 0u) && (axis->state == ILK_AXIS_MOVING) && (axis->lease_ticks != 0u) &&
         (axis->switch_triggered == 0u) && (axis->homed == ILK_HOMED_BY_HAND) &&
         between(wish->direction, 1, 2) && between(wish->drive, 1, config->max_drive) &&
         (config->max_drive <= largest_drive_of(config->card)) && (wish->amplitude == 0u) &&
         between(axis->position_counts, config->min_counts + coast + 1, config->max_counts - coast - 1) &&
         (axis->stall_driven_ticks < config->stall_ticks) && (effort == 0u);
}

void harness(void) {
  ilk_system_t system;
  ilk_axis_t axis;
  ilk_axis_config_t config;
  ilk_command_t wish;
  if (axis.state == ILK_AXIS_HOMING) {
    show_home(&config, &axis);
  } else {
    show_move(&config, &axis);
  }
  const ilk_gate_t gate = ilk_output_gate(&config, &system, &axis, &wish);
  const bool open = gate == ILK_GATE_OPEN;
  SHOW(gate < ILK_GATE_COUNT, "P15: a known gate");
  if (open) {
    show_open(&config, &system, &axis, &wish);
  }
  SHOW(IMPLIES(must_open(&config, &system, &axis, &wish), open), "P1: open when every condition holds");
  GOAL(goal_open_homed, open && (axis.homed == ILK_HOMED_BY_SWITCH));
  GOAL(goal_open_not_homed, open && (axis.homed == ILK_HOMED_NOT) && (wish.drive > 1u));
  GOAL(goal_open_homing, open && (axis.state == ILK_AXIS_HOMING));
  GOAL(goal_open_away_from_switch,
       open && (axis.switch_triggered != 0u) && (config.limit_side == ILK_LIMIT_LOWER));
  GOAL(goal_open_inward_beyond_limit,
       open && (axis.homed != ILK_HOMED_NOT) && (axis.position_counts > config.max_counts));
  GOAL(goal_blocked_soft_limit, gate == ILK_GATE_SOFT_LIMIT);
  GOAL(goal_blocked_hard_limit, gate == ILK_GATE_HARD_LIMIT);
  GOAL(goal_blocked_unhomed_travel, gate == ILK_GATE_UNHOMED_TRAVEL);
  GOAL(goal_blocked_drive, gate == ILK_GATE_DRIVE);
  GOAL(goal_blocked_stall, gate == ILK_GATE_STALL);
  GOAL(never_open_without_motion, open && (system.mode != ILK_MODE_MOTION));
  GOAL(never_open_faulted, open && (axis.state == ILK_AXIS_FAULTED));
  GOAL(never_open_at_rest, open && (wish.drive == 0u));
}
