#include "gate.h"

#include <stdbool.h>

#include "arith.h"
#include "config.h"
#include "homing.h"

#define AMPLITUDE_MAX 255u

/** The kernel, not the app, picks the direction: towards the setpoint, none within the deadband. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result == setpoint_direction(config, axis);
  @*/
static uint32_t direction_to_setpoint(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int64_t distance = (int64_t)axis->setpoint_counts - (int64_t)axis->position_counts;
  const int64_t deadband = (int64_t)config->deadband_counts;
  uint32_t direction = (uint32_t)ILK_DIRECTION_NONE;
  if (distance > deadband) {
    direction = (uint32_t)ILK_DIRECTION_INCREASING;
  } else if (distance < -deadband) {
    direction = (uint32_t)ILK_DIRECTION_DECREASING;
  } else {
    direction = (uint32_t)ILK_DIRECTION_NONE;
  }
  return direction;
}

ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  ilk_command_t wanted = {.direction = (uint32_t)ILK_DIRECTION_NONE, .drive = 0u, .amplitude = 0u};
  switch (axis->state) {
    case (uint32_t)ILK_AXIS_MOVING:
      wanted.direction = direction_to_setpoint(config, axis);
      wanted.drive = axis->drive;
      wanted.amplitude = axis->amplitude;
      break;
    case (uint32_t)ILK_AXIS_HOMING:
      wanted.direction = ilk_homing_direction(config, axis);
      wanted.drive = config->home_drive;
      wanted.amplitude = config->home_amplitude;
      break;
    default:
      /* An axis in any other state wants nothing. */
      break;
  }
  return wanted;
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> held(axis);
  @*/
static bool is_held(const ilk_axis_t *axis) {
  return ((axis->state == (uint32_t)ILK_AXIS_MOVING) && (axis->lease_ticks != 0u)) ||
         (axis->state == (uint32_t)ILK_AXIS_HOMING);
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> !in_service(axis);
  @*/
static bool is_out_of_motion(const ilk_axis_t *axis) {
  return (axis->state == (uint32_t)ILK_AXIS_DISABLED) || (axis->state >= (uint32_t)ILK_AXIS_FAULTED);
}

/** True when the wish is no motion at all. */
/*@ requires readable: \valid_read(wanted);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> !asks_for_motion(wanted);
  @*/
static bool asks_for_nothing(const ilk_command_t *wanted) {
  const bool directed = (wanted->direction == (uint32_t)ILK_DIRECTION_INCREASING) ||
                        (wanted->direction == (uint32_t)ILK_DIRECTION_DECREASING);
  return !directed || (wanted->drive == 0u);
}

/** P3: towards a triggered switch. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P3_hard_limit: \result <==> !clear_of_switch(config, axis, direction);
  @*/
static bool presses_on_switch(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t direction) {
  const bool towards = ((config->limit_side == (uint32_t)ILK_LIMIT_UPPER) &&
                        (direction == (uint32_t)ILK_DIRECTION_INCREASING)) ||
                       ((config->limit_side == (uint32_t)ILK_LIMIT_LOWER) &&
                        (direction == (uint32_t)ILK_DIRECTION_DECREASING));
  return towards && (axis->switch_triggered != 0u);
}

/** P4: outward, where coasting would cross the soft limit. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P4_soft_limit: \result <==> !within_soft_range(config, axis, direction);
  @*/
static bool leaves_soft_range(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t direction) {
  const int64_t coast = (int64_t)config->coast_counts;
  const int64_t position = (int64_t)axis->position_counts;
  const bool above = position >= ((int64_t)config->max_counts - coast);
  const bool below = position <= ((int64_t)config->min_counts + coast);
  const bool outward = (above && (direction == (uint32_t)ILK_DIRECTION_INCREASING)) ||
                       (below && (direction == (uint32_t)ILK_DIRECTION_DECREASING));
  return outward && (axis->homed != 0u);
}

/** P7: onward, where coasting would exceed the travel allowed before homing. Homing has bounds of its own. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P7_travel: \result <==> !within_unhomed_travel(config, axis, direction);
  @*/
static bool exceeds_unhomed_travel(const ilk_axis_config_t *config, const ilk_axis_t *axis,
                                   uint32_t direction) {
  const int64_t reach = (int64_t)config->unhomed_travel_counts - (int64_t)config->coast_counts;
  const int64_t travelled = (int64_t)along(direction, axis->press_travel_counts);
  return (axis->homed == 0u) && (axis->state != (uint32_t)ILK_AXIS_HOMING) && (travelled >= reach);
}

/** P7: more than the axis may, or more than its card's words can carry. */
/*@ requires readable: \valid_read(config) && \valid_read(axis) && \valid_read(wanted);
  @ assigns  \nothing;
  @ ensures  P7_drive: \result <==> !within_drive(config, axis, wanted);
  @*/
static bool exceeds_drive(const ilk_axis_config_t *config, const ilk_axis_t *axis,
                          const ilk_command_t *wanted) {
  const uint32_t bound = (axis->homed != 0u) ? config->max_drive : config->unhomed_max_drive;
  return (wanted->drive > bound) || (wanted->drive > ilk_card_max_drive(config->card)) ||
         (wanted->amplitude > config->max_amplitude) || (wanted->amplitude > AMPLITUDE_MAX);
}

ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_state_t *state, const ilk_axis_t *axis,
                           const ilk_command_t *wanted) {
  ilk_gate_t gate = ILK_GATE_MODE;
  if (state->mode != (uint32_t)ILK_MODE_MOTION) {
    gate = ILK_GATE_MODE;
  } else if (state->pedal != (uint32_t)ILK_PEDAL_PRESSED) {
    gate = ILK_GATE_PEDAL;
  } else if (state->estop != 0u) {
    gate = ILK_GATE_ESTOP;
  } else if (axis->card_valid == 0u) {
    gate = ILK_GATE_CARD;
  } else if (is_out_of_motion(axis)) {
    gate = ILK_GATE_ENABLE;
  } else if (!is_held(axis)) {
    gate = ILK_GATE_LEASE;
  } else if (asks_for_nothing(wanted)) {
    gate = ILK_GATE_SETPOINT;
  } else if (presses_on_switch(config, axis, wanted->direction)) {
    gate = ILK_GATE_HARD_LIMIT;
  } else if (leaves_soft_range(config, axis, wanted->direction)) {
    gate = ILK_GATE_SOFT_LIMIT;
  } else if (exceeds_unhomed_travel(config, axis, wanted->direction)) {
    gate = ILK_GATE_UNHOMED_TRAVEL;
  } else if (exceeds_drive(config, axis, wanted)) {
    gate = ILK_GATE_DRIVE;
  } else {
    gate = ILK_GATE_OPEN;
  }
  return gate;
}
