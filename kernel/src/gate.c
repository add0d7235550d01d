#include "parts.h"

ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int64_t distance = (int64_t)axis->setpoint_counts - (int64_t)axis->position_counts;
  const int64_t deadband = (int64_t)config->deadband_counts;
  ilk_command_t wanted = {
      .direction = (uint32_t)ILK_DIRECTION_NONE, .drive = axis->drive, .amplitude = axis->amplitude};
  if (distance > deadband) {
    wanted.direction = (uint32_t)ILK_DIRECTION_INCREASING;
  }
  if (distance < -deadband) {
    wanted.direction = (uint32_t)ILK_DIRECTION_DECREASING;
  }
  return (axis->state == (uint32_t)ILK_AXIS_HOMING) ? ilk_homing_command(config, axis) : wanted;
}

static bool is_held(const ilk_axis_t *axis) {
  return (axis->state == (uint32_t)ILK_AXIS_HOMING) ||
         ((axis->state == (uint32_t)ILK_AXIS_MOVING) && (axis->lease_ticks != 0u));
}

/** P3: towards a triggered switch. */
static bool presses_on_switch(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t direction) {
  return (axis->switch_triggered != 0u) && (direction == towards_switch(config));
}

ilk_reach_t ilk_reach(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int64_t margin = (int64_t)config->switch_hysteresis_counts + (int64_t)config->home_tolerance_counts;
  const int64_t opens_above = (int64_t)config->home_offset_counts + margin;
  const int64_t opens_below = (int64_t)config->home_offset_counts - margin;
  const bool by_switch = axis->homed == (uint32_t)ILK_HOMED_BY_SWITCH;
  ilk_reach_t reach = {.low = (int64_t)config->min_counts + (int64_t)config->coast_counts,
                       .high = (int64_t)config->max_counts - (int64_t)config->coast_counts};
  if (by_switch && (config->limit_side == (uint32_t)ILK_LIMIT_LOWER) && (reach.low < opens_above)) {
    reach.low = opens_above;
  }
  if (by_switch && (config->limit_side == (uint32_t)ILK_LIMIT_UPPER) && (reach.high > opens_below)) {
    reach.high = opens_below;
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
  return left_of(left_of(config->unhomed_travel_counts, axis->unhomed_travel_counts), coast_as_read(config));
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

/** P7: no more than the axis may, nor than its card's words can carry. */
static bool drive_fits(const ilk_axis_config_t *config, const ilk_axis_t *axis, const ilk_command_t *wanted) {
  return (wanted->drive <= ilk_drive_bound(config, axis)) &&
         (wanted->drive <= ilk_card_max_drive(config->card)) &&
         (wanted->amplitude <= config->max_amplitude) && (wanted->amplitude <= ILK_AMPLITUDE_MAX);
}

/** The first gate that is shut is the answer. */
static ilk_gate_t then(ilk_gate_t gate, bool open, ilk_gate_t shut) {
  return ((gate == ILK_GATE_OPEN) && !open) ? shut : gate;
}

ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_system_t *system,
                           const ilk_axis_t *axis, const ilk_command_t *wanted) {
  const uint32_t direction = wanted->direction;
  const bool moves = count_of(direction, (uint32_t)ILK_DIRECTION_DECREASING) && (wanted->drive != 0u);
  ilk_gate_t gate = then(ILK_GATE_OPEN, system->mode == (uint32_t)ILK_MODE_MOTION, ILK_GATE_MODE);
  gate = then(gate, system->pedal == (uint32_t)ILK_PEDAL_PRESSED, ILK_GATE_PEDAL);
  gate = then(gate, system->estop == 0u, ILK_GATE_ESTOP);
  gate = then(gate, axis->card_valid != 0u, ILK_GATE_CARD);
  gate = then(gate, count_of(axis->state, (uint32_t)ILK_AXIS_HOMING), ILK_GATE_ENABLE);
  gate = then(gate, is_held(axis), ILK_GATE_LEASE);
  gate = then(gate, moves, ILK_GATE_SETPOINT);
  gate = then(gate, !presses_on_switch(config, axis, direction), ILK_GATE_HARD_LIMIT);
  gate = then(gate, !leaves_soft_range(config, axis, direction), ILK_GATE_SOFT_LIMIT);
  gate = then(gate, !exceeds_travel(config, axis), ILK_GATE_UNHOMED_TRAVEL);
  gate = then(gate, drive_fits(config, axis, wanted), ILK_GATE_DRIVE);
  return then(gate, !ilk_axis_has_stalled(config, axis), ILK_GATE_STALL);
}
