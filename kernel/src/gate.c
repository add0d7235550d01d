#include "gate.h"

#include <stdbool.h>

#include "arith.h"
#include "axis.h"
#include "config.h"
#include "homing.h"
#include "interlock/kernel.h"

#define AMPLITUDE_MAX 255u

ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int64_t distance = (int64_t)axis->setpoint_counts - (int64_t)axis->position_counts;
  ilk_command_t wanted = {
      .direction = (uint32_t)ILK_DIRECTION_NONE, .drive = axis->drive, .amplitude = axis->amplitude};
  if (axis->state == (uint32_t)ILK_AXIS_HOMING) {
    wanted = ilk_homing_command(config, axis);
  } else if (distance > (int64_t)config->deadband_counts) {
    wanted.direction = (uint32_t)ILK_DIRECTION_INCREASING;
  } else if (distance < -(int64_t)config->deadband_counts) {
    wanted.direction = (uint32_t)ILK_DIRECTION_DECREASING;
  } else {
    wanted.direction = (uint32_t)ILK_DIRECTION_NONE;
  }
  return wanted;
}

static bool is_held(const ilk_axis_t *axis) {
  return ((axis->state == (uint32_t)ILK_AXIS_MOVING) && (axis->lease_ticks != 0u)) ||
         (axis->state == (uint32_t)ILK_AXIS_HOMING);
}

static bool is_out_of_motion(const ilk_axis_t *axis) {
  return (axis->state == (uint32_t)ILK_AXIS_DISABLED) || (axis->state >= (uint32_t)ILK_AXIS_FAULTED);
}

/** True when the wish is no motion at all. */
static bool asks_for_nothing(const ilk_command_t *wanted) {
  const bool directed = (wanted->direction == (uint32_t)ILK_DIRECTION_INCREASING) ||
                        (wanted->direction == (uint32_t)ILK_DIRECTION_DECREASING);
  return !directed || (wanted->drive == 0u);
}

/** P3: towards a triggered switch. */
static bool presses_on_switch(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t direction) {
  return (axis->switch_triggered != 0u) && (direction == ilk_towards_switch(config));
}

ilk_reach_t ilk_reach(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int64_t coast = (int64_t)config->coast_counts;
  const int64_t home = (int64_t)config->home_offset_counts;
  const int64_t margin = (int64_t)config->switch_hysteresis_counts + (int64_t)config->home_tolerance_counts;
  ilk_reach_t reach = {.low = (int64_t)config->min_counts + coast,
                       .high = (int64_t)config->max_counts - coast};
  if (axis->homed == (uint32_t)ILK_HOMED_BY_SWITCH) {
    if ((config->limit_side == (uint32_t)ILK_LIMIT_LOWER) && (reach.low < (home + margin))) {
      reach.low = home + margin;
    }
    if ((config->limit_side == (uint32_t)ILK_LIMIT_UPPER) && (reach.high > (home - margin))) {
      reach.high = home - margin;
    }
  }
  return reach;
}

/** P4: outward, where coasting would cross the soft limit. */
static bool leaves_soft_range(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t direction) {
  const ilk_reach_t reach = ilk_reach(config, axis);
  const bool at_end = (direction == (uint32_t)ILK_DIRECTION_INCREASING)
                          ? ((int64_t)axis->position_counts >= reach.high)
                          : ((int64_t)axis->position_counts <= reach.low);
  return at_end && (axis->homed != (uint32_t)ILK_HOMED_NOT);
}

uint32_t ilk_unhomed_travel_left(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return left_of(config->unhomed_travel_counts,
                 sum_saturating(axis->unhomed_travel_counts, config->coast_counts));
}

/** P7: the budget of this press is used up, coast kept back. */
static bool exceeds_travel(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const uint32_t left = (axis->state == (uint32_t)ILK_AXIS_HOMING) ? ilk_homing_travel_left(config, axis)
                                                                   : ilk_unhomed_travel_left(config, axis);
  return (axis->homed == (uint32_t)ILK_HOMED_NOT) && (left == 0u);
}

uint32_t ilk_drive_bound(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return (axis->homed != (uint32_t)ILK_HOMED_NOT) ? config->max_drive : config->unhomed_max_drive;
}

/** P7: more than the axis may, or more than its card's words can carry. */
static bool exceeds_drive(const ilk_axis_config_t *config, const ilk_axis_t *axis,
                          const ilk_command_t *wanted) {
  return (wanted->drive > ilk_drive_bound(config, axis)) ||
         (wanted->drive > ilk_card_max_drive(config->card)) || (wanted->amplitude > config->max_amplitude) ||
         (wanted->amplitude > AMPLITUDE_MAX);
}

ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_system_t *system,
                           const ilk_axis_t *axis, const ilk_command_t *wanted) {
  ilk_gate_t gate = ILK_GATE_MODE;
  if (system->mode != (uint32_t)ILK_MODE_MOTION) {
    gate = ILK_GATE_MODE;
  } else if (system->pedal != (uint32_t)ILK_PEDAL_PRESSED) {
    gate = ILK_GATE_PEDAL;
  } else if (system->estop != 0u) {
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
  } else if (exceeds_travel(config, axis)) {
    gate = ILK_GATE_UNHOMED_TRAVEL;
  } else if (exceeds_drive(config, axis, wanted)) {
    gate = ILK_GATE_DRIVE;
  } else if (ilk_axis_has_stalled(config, axis)) {
    gate = ILK_GATE_STALL;
  } else {
    gate = ILK_GATE_OPEN;
  }
  return gate;
}
