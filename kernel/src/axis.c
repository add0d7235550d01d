#include "parts.h"

bool ilk_card_is_lost(const ilk_common_config_t *common, const ilk_axis_t *axis) {
  return axis->bad_frames >= common->bad_frame_limit;
}

void ilk_card_observe(const ilk_system_t *system, const ilk_reading_t *reading, bool received,
                      ilk_axis_t *axis) {
  /* Built after the card heard the frame of the transaction before; not judged until two were sent. */
  const bool current =
      (system->frames_sent < ILK_LATENCY_TICKS) || (reading->tick_echo == (system->tick - ILK_LATENCY_TICKS));
  const bool valid = received && reading->intact && current;
  axis->periods = (axis->card_valid != 0u) ? 0u : axis->periods;
  axis->card_valid = flag_of(valid);
  axis->bad_frames = ticks_in_row(!valid, axis->bad_frames, UINT32_MAX);
  if (received && !reading->intact) {
    axis->checksum_failures = count_up(axis->checksum_failures, UINT32_MAX);
  }
}

/* --- Stillness --------------------------------------------------------------------------------- */

static void begin_stillness(ilk_stillness_t *still, uint32_t raw) {
  *still = (ilk_stillness_t){.origin_raw = raw, .below = 0, .above = 0, .ticks = 0u};
}

/** One more reading; one that lies too far from another begins anew. */
static void follow_stillness(ilk_stillness_t *still, uint32_t raw, uint32_t span_counts, uint32_t longest) {
  const int32_t here = signed_of(raw - still->origin_raw);
  const int32_t below = (here < still->below) ? here : still->below;
  const int32_t above = (here > still->above) ? here : still->above;
  if ((still->ticks == 0u) || (((int64_t)above - (int64_t)below) > (int64_t)span_counts)) {
    begin_stillness(still, raw);
  } else {
    still->below = below;
    still->above = above;
  }
  still->ticks = count_up(still->ticks, longest);
}

bool ilk_axis_is_at_rest(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return (axis->card_valid != 0u) && (axis->rest.ticks >= config->rest_ticks);
}

/* --- Orders ------------------------------------------------------------------------------------ */

void ilk_axis_drop_motion(ilk_axis_t *axis) {
  if ((axis->state == (uint32_t)ILK_AXIS_MOVING) || (axis->state == (uint32_t)ILK_AXIS_HOMING)) {
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
  }
  axis->setpoint_counts = 0;
  axis->drive = 0u;
  axis->amplitude = 0u;
  axis->lease_ticks = 0u;
  axis->homing_phase = (uint32_t)ILK_HOMING_NONE;
}

void ilk_axis_disable(ilk_axis_t *axis) {
  ilk_axis_drop_motion(axis);
  if (axis->state != (uint32_t)ILK_AXIS_FAULTED) {
    axis->state = (uint32_t)ILK_AXIS_DISABLED;
    begin_stillness(&axis->rest, axis->raw);
  }
}

/** Where an axis that is DISABLED was moved to by hand, it is held to from here on. */
void ilk_axis_begin_press(ilk_axis_t *axis) {
  axis->drift_mark_raw = (axis->state == (uint32_t)ILK_AXIS_DISABLED) ? axis->raw : axis->drift_mark_raw;
  axis->path_raw = axis->raw;
  axis->path_is_homing = 0u;
  axis->unhomed_travel_counts = 0u;
  axis->homing_travel_counts = 0u;
  axis->homing_ticks = 0u;
}

/** A hand may have moved it: what its next drive does is measured from where that begins. */
void ilk_axis_enable(ilk_axis_t *axis) {
  if (axis->state == (uint32_t)ILK_AXIS_DISABLED) {
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
    axis->drift_mark_raw = axis->raw;
    axis->reverse_direction = (uint32_t)ILK_DIRECTION_NONE;
    axis->stall_direction = (uint32_t)ILK_DIRECTION_NONE;
  }
}

/* --- Stall ------------------------------------------------------------------------------------- */

static uint64_t effort_of(const ilk_axis_t *axis) {
  return ((uint64_t)axis->effort_high << 32u) | axis->effort_low;
}

static void set_effort(ilk_axis_t *axis, uint64_t effort) {
  axis->effort_low = (uint32_t)(effort & UINT32_MAX);
  axis->effort_high = (uint32_t)(effort >> 32u);
}

bool ilk_axis_has_stalled(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const uint64_t most = (uint64_t)config->stall_effort_ticks * config->max_drive;
  return (axis->stall_driven_ticks >= config->stall_ticks) || ((most != 0u) && (effort_of(axis) >= most));
}

static void mark_progress(ilk_axis_t *axis) {
  axis->stall_mark_raw = axis->raw;
  axis->effort_mark_raw = axis->raw;
}

static void clear_stall(ilk_axis_t *axis) {
  mark_progress(axis);
  axis->stall_driven_ticks = 0u;
  set_effort(axis, 0u);
}

/** How far the axis has come in `direction` since the reading `mark_raw`. */
static int32_t advance_from(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t mark_raw,
                            uint32_t direction) {
  return along(direction, travel_between(config, mark_raw, axis->raw));
}

/** True when the axis has come more than `counts` from the mark, the way in which progress counts. */
static bool is_beyond(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t mark_raw,
                      uint32_t counts) {
  const int32_t advance = advance_from(config, axis, mark_raw, axis->stall_direction);
  return (advance > 0) && (magnitude(advance) > counts);
}

static void follow_progress(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  if (is_beyond(config, axis, axis->stall_mark_raw, left_of(config->stall_min_counts, 1u))) {
    clear_stall(axis);
  } else if (is_beyond(config, axis, axis->effort_mark_raw, config->noise_counts)) {
    axis->effort_mark_raw = axis->raw;
    set_effort(axis, 0u);
  } else {
    /* No progress. */
  }
}

void ilk_axis_note_arrival(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  const bool ahead = is_beyond(config, axis, axis->effort_mark_raw, 0u);
  const uint32_t effort_mark_raw = ahead ? axis->raw : axis->effort_mark_raw;
  if (is_beyond(config, axis, axis->stall_mark_raw, config->noise_counts)) {
    clear_stall(axis);
    axis->effort_mark_raw = effort_mark_raw;
  }
}

void ilk_axis_note_drive(const ilk_command_t *command, ilk_axis_t *axis) {
  const uint64_t effort = effort_of(axis);
  if (axis->stall_direction != command->direction) {
    axis->stall_direction = command->direction;
    mark_progress(axis);
  }
  if (axis->reverse_direction != command->direction) {
    axis->reverse_direction = command->direction;
    axis->reverse_mark_raw = axis->raw;
  }
  if (axis->state == (uint32_t)ILK_AXIS_MOVING) {
    axis->path_is_homing = 0u;
  }
  axis->stall_driven_ticks = count_up(axis->stall_driven_ticks, UINT32_MAX);
  set_effort(axis, (effort > (UINT64_MAX - command->drive)) ? UINT64_MAX : (effort + command->drive));
  axis->drift_mark_raw = axis->raw;
  axis->driven_direction = command->direction;
  axis->rest.ticks = 0u;
}

/* --- Faults ------------------------------------------------------------------------------------ */

static ilk_finding_t found_if(bool present, ilk_fault_t fault, int32_t value) {
  return (ilk_finding_t){.fault = present ? fault : ILK_FAULT_NONE, .value = value};
}

static ilk_finding_t first_of(ilk_finding_t earlier, ilk_finding_t later) {
  return (earlier.fault != ILK_FAULT_NONE) ? earlier : later;
}

/** The first fault is kept until CLEAR_FAULT; true when this one is it. */
static bool raise_fault(const ilk_system_t *system, ilk_finding_t finding, ilk_axis_t *axis) {
  const bool is_new = (finding.fault != ILK_FAULT_NONE) && (axis->state != (uint32_t)ILK_AXIS_FAULTED);
  if (is_new) {
    ilk_axis_drop_motion(axis);
    axis->state = (uint32_t)ILK_AXIS_FAULTED;
    axis->fault = (uint32_t)finding.fault;
    axis->fault_tick = system->tick;
    axis->fault_value = finding.value;
    axis->drift_mark_raw = axis->raw;
  }
  if ((finding.fault != ILK_FAULT_NONE) && (finding.fault != ILK_FAULT_DRIFT)) {
    axis->homed = (uint32_t)ILK_HOMED_NOT;
  }
  return is_new;
}

void ilk_axis_clear_fault(ilk_axis_t *axis) {
  if (axis->fault == (uint32_t)ILK_FAULT_STALL) {
    clear_stall(axis);
  }
  axis->state = (uint32_t)ILK_AXIS_DISABLED;
  axis->fault = (uint32_t)ILK_FAULT_NONE;
  axis->fault_tick = 0u;
  axis->fault_value = 0;
}

/* --- Observation ------------------------------------------------------------------------------- */

/** What the counter says no longer belongs to what it said before: every mark begins here. */
static void begin_anew(ilk_axis_t *axis) {
  begin_stillness(&axis->rest, axis->raw);
  begin_stillness(&axis->calm, axis->raw);
  mark_progress(axis);
  axis->reverse_direction = (uint32_t)ILK_DIRECTION_NONE;
  axis->drift_mark_raw = axis->raw;
  axis->path_raw = axis->raw;
  axis->switch_run_ticks = 0u;
  axis->home_known = 0u;
}

/** A card that was reset counts from elsewhere. */
static ilk_finding_t judge_card(const ilk_reading_t *reading, const ilk_axis_t *axis) {
  const uint32_t ahead = reading->heartbeat - axis->heartbeat;
  const bool told = ((reading->card_status & ~axis->card_status) & ILK_STATUS_WAS_RESET) != 0u;
  const bool counted = (ahead == 0u) || ((ahead - 1u) > axis->periods);
  return found_if(told || counted, ILK_FAULT_CARD_RESET, signed_of(ahead));
}

/** Place, and what the card says of itself. The first frame after start or after a lost card is compared with
   nothing; what a reset or a jump leads to has nothing to do with what was before. A FAULTED axis that jumps
   on, the way it went in the frame before, is run away: its mark follows each jump, so that nothing else
   would tell. */
static ilk_finding_t follow_card(const ilk_axis_config_t *config, const ilk_reading_t *reading,
                                 ilk_axis_t *axis) {
  const bool first = axis->card_seen == 0u;
  const uint64_t farthest = (uint64_t)config->max_delta_counts * axis->periods;
  const int32_t delta = first ? 0 : travel_between(config, axis->raw, reading->raw);
  const bool goes_on = ((delta > 0) && (axis->delta_counts > 0)) || ((delta < 0) && (axis->delta_counts < 0));
  const ilk_finding_t jump = found_if(magnitude(delta) > farthest, ILK_FAULT_JUMP, delta);
  const ilk_finding_t nothing = found_if(false, ILK_FAULT_NONE, 0);
  const ilk_finding_t finding = first ? nothing : first_of(judge_card(reading, axis), jump);
  axis->delta_counts = delta;
  axis->position_counts = add_saturating(axis->position_counts, delta);
  axis->raw = reading->raw;
  axis->heartbeat = reading->heartbeat;
  axis->card_time_us = reading->card_time_us;
  axis->card_status = reading->card_status;
  axis->card_seen = 1u;
  if (first || (finding.fault != ILK_FAULT_NONE)) {
    axis->runaway |= flag_of(goes_on && (axis->state == (uint32_t)ILK_AXIS_FAULTED));
    begin_anew(axis);
  }
  return finding;
}

/** The travel of this press that its budgets bound; outside of them the point stays with the counter. */
static void follow_path(const ilk_axis_config_t *config, const ilk_system_t *system, ilk_axis_t *axis) {
  const bool counts = (system->mode == (uint32_t)ILK_MODE_MOTION) && (axis->homed == (uint32_t)ILK_HOMED_NOT);
  const uint32_t distance = magnitude(travel_between(config, axis->path_raw, axis->raw));
  if (!counts || (distance > config->noise_counts)) {
    uint32_t *sum = (axis->path_is_homing != 0u) ? &axis->homing_travel_counts : &axis->unhomed_travel_counts;
    *sum = sum_saturating(*sum, counts ? distance : 0u);
    axis->path_raw = axis->raw;
  }
}

static void follow_switch(const ilk_common_config_t *common, const ilk_reading_t *reading, ilk_axis_t *axis) {
  const uint32_t triggered = flag_of(reading->switch_triggered);
  if ((axis->switch_run_ticks == 0u) || (axis->switch_reading != triggered)) {
    axis->switch_reading = triggered;
    axis->switch_run_ticks = 0u;
    axis->switch_run_raw = axis->raw;
  }
  axis->switch_run_ticks = count_up(axis->switch_run_ticks, common->switch_debounce_ticks);
}

bool ilk_switch_is_steady(const ilk_common_config_t *common, const ilk_axis_t *axis, bool triggered) {
  return (axis->switch_run_ticks >= common->switch_debounce_ticks) &&
         (axis->switch_reading == flag_of(triggered));
}

/** The switch of an axis that homed at it, against the place where it homed. */
static ilk_finding_t judge_switch(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                  ilk_axis_t *axis) {
  const int64_t from_home = (int64_t)axis->position_counts - (int64_t)config->home_offset_counts;
  const int64_t outside = (config->limit_side == (uint32_t)ILK_LIMIT_UPPER) ? from_home : -from_home;
  const int64_t slack = (int64_t)config->home_tolerance_counts + (int64_t)config->coast_counts;
  const bool contradicts = (axis->switch_reading != 0u)
                               ? (outside < -(slack + (int64_t)config->switch_hysteresis_counts))
                               : (outside > slack);
  axis->implausible_ticks = ticks_in_row(contradicts && (axis->homed == (uint32_t)ILK_HOMED_BY_SWITCH),
                                         axis->implausible_ticks, common->switch_debounce_ticks);
  return found_if(axis->implausible_ticks >= common->switch_debounce_ticks, ILK_FAULT_SWITCH,
                  add_saturating(axis->position_counts, negate_saturating(config->home_offset_counts)));
}

static ilk_finding_t judge_reverse(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  const int32_t advance = advance_from(config, axis, axis->reverse_mark_raw, axis->reverse_direction);
  const bool reversed = (axis->driven_direction != (uint32_t)ILK_DIRECTION_NONE) && (advance < 0) &&
                        (magnitude(advance) > config->reverse_counts);
  if (advance > 0) {
    axis->reverse_mark_raw = axis->raw;
  }
  return found_if(reversed, ILK_FAULT_REVERSE, negate_saturating(advance));
}

/** A DISABLED axis may be moved by hand, but in MOTION nothing but drive moves any. A drive needs a valid
   frame: an axis that was driven since its last one was driven in that very tick. */
static ilk_finding_t judge_drift(const ilk_axis_config_t *config, const ilk_system_t *system,
                                 bool read_last_tick, const ilk_axis_t *axis) {
  const bool driven_last_tick = (axis->driven_direction != (uint32_t)ILK_DIRECTION_NONE) && read_last_tick;
  const int32_t drift = travel_between(config, axis->drift_mark_raw, axis->raw);
  const bool by_hand =
      (axis->state == (uint32_t)ILK_AXIS_DISABLED) && (system->mode != (uint32_t)ILK_MODE_MOTION);
  const bool judged = !by_hand && !driven_last_tick && (axis->state != (uint32_t)ILK_AXIS_FAULTED);
  return found_if(judged && (magnitude(drift) > config->drift_counts), ILK_FAULT_DRIFT, drift);
}

static ilk_finding_t judge_stall(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return found_if(ilk_axis_has_stalled(config, axis), ILK_FAULT_STALL,
                  advance_from(config, axis, axis->stall_mark_raw, axis->stall_direction));
}

/** What a valid frame says. */
static ilk_finding_t observe_frame(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                   const ilk_system_t *system, const ilk_reading_t *reading,
                                   bool read_last_tick, ilk_axis_t *axis) {
  ilk_finding_t finding = follow_card(config, reading, axis);
  follow_stillness(&axis->rest, axis->raw, config->noise_counts, config->rest_ticks);
  follow_stillness(&axis->calm, axis->raw, config->drift_counts, config->rest_ticks);
  follow_path(config, system, axis);
  follow_progress(config, axis);
  finding = first_of(finding, judge_reverse(config, axis));
  finding = first_of(finding, judge_drift(config, system, read_last_tick, axis));
  axis->driven_direction = (uint32_t)ILK_DIRECTION_NONE;
  finding = first_of(finding, judge_stall(config, axis));
  if (has_switch(config)) {
    follow_switch(common, reading, axis);
    finding = first_of(finding, judge_switch(common, config, axis));
  }
  return finding;
}

/** What a missing frame says. */
static ilk_finding_t observe_nothing(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                     ilk_axis_t *axis) {
  const bool lost = ilk_card_is_lost(common, axis);
  axis->rest.ticks = 0u;
  if (lost) {
    axis->card_seen = 0u;
    axis->runaway = 0u;
  }
  return first_of(found_if(lost, ILK_FAULT_CARD, signed_of(axis->bad_frames & (uint32_t)INT32_MAX)),
                  judge_stall(config, axis));
}

/** A faulted axis is not driven; one that moves all the same, however slowly, is run away until it rests. */
static void watch_faulted(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  const uint32_t distance = magnitude(travel_between(config, axis->drift_mark_raw, axis->raw));
  const bool rests = ilk_axis_is_at_rest(config, axis);
  if ((axis->state == (uint32_t)ILK_AXIS_FAULTED) && (axis->card_valid != 0u)) {
    const bool over = rests && (axis->runaway != 0u);
    axis->drift_mark_raw = over ? axis->raw : axis->drift_mark_raw;
    axis->runaway = flag_of(!over && ((axis->runaway != 0u) || (distance > config->drift_counts)));
  }
}

static void run_lease_down(ilk_axis_t *axis) {
  axis->lease_ticks = left_of(axis->lease_ticks, 1u);
  if ((axis->state == (uint32_t)ILK_AXIS_MOVING) && (axis->lease_ticks == 0u)) {
    ilk_axis_drop_motion(axis);
  }
}

bool ilk_axis_observe(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                      const ilk_system_t *system, const ilk_reading_t *reading, uint32_t periods,
                      ilk_axis_t *axis) {
  const bool valid = axis->card_valid != 0u;
  const bool read_last_tick = axis->periods == 0u;
  axis->periods = sum_saturating(axis->periods, periods);
  axis->switch_triggered = flag_of(has_switch(config) && (!valid || reading->switch_triggered));
  run_lease_down(axis);
  ilk_finding_t finding = valid ? observe_frame(common, config, system, reading, read_last_tick, axis)
                                : observe_nothing(common, config, axis);
  finding = first_of(finding, ilk_homing_advance(common, config, axis));
  const bool faulted = raise_fault(system, finding, axis);
  watch_faulted(config, axis);
  return faulted;
}
