#include "homing.h"

#include <stdbool.h>

#include "arith.h"

/*@ requires valid: \valid(axis);
  @ assigns  axis->homing_phase, axis->homing_mark_raw, axis->rest_ticks;
  @ ensures  phase: axis->homing_phase == phase && axis->homing_mark_raw == axis->raw && axis->rest_ticks == 0;
  @*/
static void enter_phase(ilk_axis_t *axis, ilk_homing_phase_t phase) {
  axis->homing_phase = (uint32_t)phase;
  axis->homing_mark_raw = axis->raw;
  axis->rest_ticks = 0u;
}

void ilk_homing_begin(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  axis->state = (uint32_t)ILK_AXIS_HOMING;
  axis->homed = 0u;
  axis->lease_ticks = 0u;
  axis->homing_ticks = config->home_timeout_ticks;
  enter_phase(axis, (axis->switch_triggered != 0u) ? ILK_HOMING_BACK_OFF : ILK_HOMING_SEEK);
}

/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  exact: \result ==
  @   (config->limit_side == ILK_LIMIT_UPPER ? ILK_DIRECTION_INCREASING : ILK_DIRECTION_DECREASING);
  @*/
static uint32_t towards_switch(const ilk_axis_config_t *config) {
  return (config->limit_side == (uint32_t)ILK_LIMIT_UPPER) ? (uint32_t)ILK_DIRECTION_INCREASING
                                                           : (uint32_t)ILK_DIRECTION_DECREASING;
}

/*@ requires readable: \valid_read(config);
  @ assigns  \nothing;
  @ ensures  exact: \result ==
  @   (config->limit_side == ILK_LIMIT_UPPER ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING);
  @*/
static uint32_t away_from_switch(const ilk_axis_config_t *config) {
  return (config->limit_side == (uint32_t)ILK_LIMIT_UPPER) ? (uint32_t)ILK_DIRECTION_DECREASING
                                                           : (uint32_t)ILK_DIRECTION_INCREASING;
}

uint32_t ilk_homing_direction(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  uint32_t direction = (uint32_t)ILK_DIRECTION_NONE;
  switch (axis->homing_phase) {
    case (uint32_t)ILK_HOMING_BACK_OFF:
      direction = away_from_switch(config);
      break;
    case (uint32_t)ILK_HOMING_SEEK:
      direction = towards_switch(config);
      break;
    default:
      direction = (uint32_t)ILK_DIRECTION_NONE;
      break;
  }
  return direction;
}

/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->rest_ticks, axis->homing_phase, axis->homing_mark_raw, axis->state, axis->homed;
  @ behavior rested:
  @   assumes \let rest = axis->delta_counts == 0 ? axis->rest_ticks + 1 : 0; rest >= config->home_rest_ticks;
  @   ensures homed: axis->homed == 1 && axis->state == ILK_AXIS_ENABLED;
  @   ensures done: axis->homing_phase == ILK_HOMING_NONE && axis->rest_ticks == 0
  @     && axis->homing_mark_raw == axis->raw;
  @ behavior waits:
  @   assumes \let rest = axis->delta_counts == 0 ? axis->rest_ticks + 1 : 0; rest < config->home_rest_ticks;
  @   assigns axis->rest_ticks;
  @   ensures rest: axis->rest_ticks == (axis->delta_counts == 0 ? \old(axis->rest_ticks) + 1 : 0);
  @   ensures same: axis->state == \old(axis->state) && axis->homed == \old(axis->homed)
  @     && axis->homing_phase == \old(axis->homing_phase)
  @     && axis->homing_mark_raw == \old(axis->homing_mark_raw);
  @ complete behaviors;
  @ disjoint behaviors;
  @*/
static void wait_for_rest(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  axis->rest_ticks = (axis->delta_counts == 0) ? count_up(axis->rest_ticks, config->home_rest_ticks) : 0u;
  if (axis->rest_ticks >= config->home_rest_ticks) {
    enter_phase(axis, ILK_HOMING_NONE);
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
    axis->homed = 1u;
  }
}

/** A switch that was not read validly makes no edge: only valid frames get here. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ requires homing: axis->state == ILK_AXIS_HOMING && axis->homing_phase < ILK_HOMING_COUNT
  @   && axis->homing_phase != ILK_HOMING_NONE;
  @ assigns  axis->state, axis->homed, axis->position_counts, axis->homing_phase, axis->homing_mark_raw,
  @          axis->rest_ticks;
  @ ensures  opened: \old(axis->homing_phase) == ILK_HOMING_BACK_OFF ==> axis->state == ILK_AXIS_HOMING
  @   && axis->homing_phase == (axis->switch_triggered == 0 ? ILK_HOMING_SEEK : ILK_HOMING_BACK_OFF);
  @ ensures  closed: \old(axis->homing_phase) == ILK_HOMING_SEEK ==> axis->state == ILK_AXIS_HOMING
  @   && axis->homing_phase == (axis->switch_triggered != 0 ? ILK_HOMING_REST : ILK_HOMING_SEEK);
  @ ensures  reference: axis->position_counts ==
  @   (\old(axis->homing_phase) == ILK_HOMING_SEEK && axis->switch_triggered != 0
  @     ? config->home_offset_counts : \old(axis->position_counts));
  @ ensures  rests: \old(axis->homing_phase) == ILK_HOMING_REST ==>
  @   (axis->state == ILK_AXIS_HOMING && axis->homing_phase == ILK_HOMING_REST)
  @   || (axis->state == ILK_AXIS_ENABLED && axis->homing_phase == ILK_HOMING_NONE);
  @ ensures  homed_at_rest: axis->homed == (axis->state == ILK_AXIS_ENABLED ? 1 : \old(axis->homed));
  @ ensures  mark: axis->homing_mark_raw ==
  @   (axis->homing_phase != \old(axis->homing_phase) ? axis->raw : \old(axis->homing_mark_raw));
  @*/
static void look_for_edge(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  const bool triggered = axis->switch_triggered != 0u;
  switch (axis->homing_phase) {
    case (uint32_t)ILK_HOMING_BACK_OFF:
      if (!triggered) {
        enter_phase(axis, ILK_HOMING_SEEK);
      }
      break;
    case (uint32_t)ILK_HOMING_SEEK:
      if (triggered) {
        axis->position_counts = config->home_offset_counts;
        enter_phase(axis, ILK_HOMING_REST);
      }
      break;
    default: /* REST */
      wait_for_rest(config, axis);
      break;
  }
}

/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result == homing_bound(config, axis);
  @*/
static uint32_t travel_bound(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return (axis->homing_phase == (uint32_t)ILK_HOMING_BACK_OFF) ? config->home_backoff_counts
                                                               : config->home_travel_counts;
}

ilk_homing_result_t ilk_homing_advance(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  ilk_homing_result_t result = {.fault = ILK_FAULT_NONE, .value = 0};
  if (axis->state == (uint32_t)ILK_AXIS_HOMING) {
    axis->homing_ticks = count_down(axis->homing_ticks);
    if (axis->card_valid != 0u) {
      look_for_edge(config, axis);
    }
  }
  if (axis->state == (uint32_t)ILK_AXIS_HOMING) {
    const int32_t travel = travel_between(config, axis->homing_mark_raw, axis->raw);
    if (magnitude(travel) > travel_bound(config, axis)) {
      result.fault = ILK_FAULT_HOMING_TRAVEL;
      result.value = travel;
    } else if (axis->homing_ticks == 0u) {
      result.fault = ILK_FAULT_HOMING_TIMEOUT;
      result.value = (int32_t)axis->homing_phase;
    } else {
      result.fault = ILK_FAULT_NONE;
    }
  }
  return result;
}
