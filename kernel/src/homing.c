#include "parts.h"

/** The other of the two directions, 1 and 2; NONE without a switch. */
static uint32_t away_from_switch(const ilk_axis_config_t *config) {
  const uint32_t towards = towards_switch(config);
  return (towards == (uint32_t)ILK_DIRECTION_NONE) ? towards : (ILK_DIRECTION_COUNT - towards);
}

uint32_t ilk_homing_travel_left(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return left_of(left_of(config->home_travel_counts, axis->homing_travel_counts), coast_as_read(config));
}

bool ilk_homing_has_budget(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return (ilk_homing_travel_left(config, axis) != 0u) && (axis->homing_ticks < config->home_timeout_ticks);
}

static void enter_phase(ilk_axis_t *axis, ilk_homing_phase_t phase, uint32_t mark_raw) {
  axis->homing_phase = (uint32_t)phase;
  axis->homing_mark_raw = mark_raw;
}

/** The run of readings begins anew, so that no edge counts that was seen before. */
void ilk_homing_begin(ilk_axis_t *axis) {
  ilk_axis_drop_motion(axis);
  axis->state = (uint32_t)ILK_AXIS_HOMING;
  axis->homed = (uint32_t)ILK_HOMED_NOT;
  axis->path_is_homing = 1u;
  axis->switch_run_ticks = 0u;
  enter_phase(axis, ILK_HOMING_LOOK, axis->raw);
}

/** LOOK and REST wait. */
ilk_command_t ilk_homing_command(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const uint32_t phase = axis->homing_phase;
  const bool slow = phase == (uint32_t)ILK_HOMING_APPROACH;
  const bool in = slow || (phase == (uint32_t)ILK_HOMING_SEEK);
  const bool out = (phase == (uint32_t)ILK_HOMING_LEAVE) || (phase == (uint32_t)ILK_HOMING_BACK_OFF);
  const uint32_t inward = in ? towards_switch(config) : (uint32_t)ILK_DIRECTION_NONE;
  return (ilk_command_t){.direction = out ? away_from_switch(config) : inward,
                         .drive = slow ? config->home_slow_drive : config->home_drive,
                         .amplitude = config->home_amplitude};
}

/** Far enough from the mark that a bounce or a look at the wrong edge is behind it. */
static bool is_clear(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int32_t away =
      along(away_from_switch(config), travel_between(config, axis->homing_mark_raw, axis->raw));
  return (away > 0) && (magnitude(away) >= config->home_clear_counts);
}

/** The reference is the second edge, if the first agrees and the axis rests no farther from it than it can
 * coast. */
static ilk_finding_t conclude(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  const uint32_t edge_raw = axis->homing_mark_raw;
  const int32_t disagreement = travel_between(config, axis->first_edge_raw, edge_raw);
  const int32_t beyond = travel_between(config, edge_raw, axis->raw);
  const bool agree = magnitude(disagreement) <= config->home_tolerance_counts;
  const bool near = magnitude(beyond) <= sum_saturating(config->coast_counts, config->home_tolerance_counts);
  ilk_finding_t finding = {.fault = ILK_FAULT_SWITCH, .value = agree ? beyond : disagreement};
  if (agree && near) {
    finding.fault = ILK_FAULT_NONE;
    axis->home_difference_counts =
        (axis->home_known != 0u) ? travel_between(config, axis->home_raw, edge_raw) : 0;
    axis->home_raw = edge_raw;
    axis->home_known = 1u;
    axis->position_counts = add_saturating(beyond, config->home_offset_counts);
    axis->homed = (uint32_t)ILK_HOMED_BY_SWITCH;
    ilk_axis_drop_motion(axis);
  }
  return finding;
}

/** What a valid frame means for the phase. */
static ilk_finding_t follow_phase(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                  ilk_axis_t *axis) {
  const bool triggered = ilk_switch_is_steady(common, axis, true);
  const bool open = ilk_switch_is_steady(common, axis, false);
  const bool left = open && is_clear(config, axis);
  const bool rests = ilk_axis_is_at_rest(config, axis);
  const uint32_t phase = axis->homing_phase;
  ilk_finding_t finding = {.fault = ILK_FAULT_NONE, .value = 0};
  if ((phase == (uint32_t)ILK_HOMING_LOOK) && triggered) {
    enter_phase(axis, ILK_HOMING_LEAVE, axis->raw);
  } else if (((phase == (uint32_t)ILK_HOMING_LOOK) && open) ||
             ((phase == (uint32_t)ILK_HOMING_LEAVE) && left)) {
    enter_phase(axis, ILK_HOMING_SEEK, axis->raw);
  } else if ((phase == (uint32_t)ILK_HOMING_SEEK) && triggered) {
    axis->first_edge_raw = axis->switch_run_raw;
    enter_phase(axis, ILK_HOMING_BACK_OFF, axis->switch_run_raw);
  } else if (((phase == (uint32_t)ILK_HOMING_BACK_OFF) && left) ||
             ((phase == (uint32_t)ILK_HOMING_REST) && rests && open)) {
    enter_phase(axis, ILK_HOMING_APPROACH, axis->raw);
  } else if ((phase == (uint32_t)ILK_HOMING_APPROACH) && triggered) {
    enter_phase(axis, ILK_HOMING_REST, axis->switch_run_raw);
  } else if ((phase == (uint32_t)ILK_HOMING_REST) && rests && triggered) {
    finding = conclude(config, axis);
  } else {
    /* The phase goes on. */
  }
  return finding;
}

ilk_finding_t ilk_homing_advance(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                 ilk_axis_t *axis) {
  ilk_finding_t finding = {.fault = ILK_FAULT_NONE, .value = 0};
  if (axis->state == (uint32_t)ILK_AXIS_HOMING) {
    axis->homing_ticks = count_up(axis->homing_ticks, UINT32_MAX);
    if (axis->card_valid != 0u) {
      finding = follow_phase(common, config, axis);
    }
  }
  if ((axis->state == (uint32_t)ILK_AXIS_HOMING) && (finding.fault == ILK_FAULT_NONE) &&
      !ilk_homing_has_budget(config, axis)) {
    const bool travelled = ilk_homing_travel_left(config, axis) == 0u;
    finding.fault = travelled ? ILK_FAULT_HOMING_TRAVEL : ILK_FAULT_HOMING_TIMEOUT;
    finding.value =
        signed_of(travelled ? (axis->homing_travel_counts & (uint32_t)INT32_MAX) : axis->homing_phase);
  }
  return finding;
}
