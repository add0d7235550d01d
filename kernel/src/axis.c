#include "axis.h"

#include "arith.h"
#include "homing.h"

/** A fault that is about to be raised, or NONE. */
typedef struct {
  ilk_fault_t fault;
  int32_t value;
} finding_t;

static const finding_t nothing_found = {.fault = ILK_FAULT_NONE, .value = 0};

void ilk_axis_drop_motion(ilk_axis_t *axis) {
  if ((axis->state == (uint32_t)ILK_AXIS_MOVING) || (axis->state == (uint32_t)ILK_AXIS_HOMING)) {
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
  }
  axis->setpoint_counts = 0;
  axis->drive = 0u;
  axis->amplitude = 0u;
  axis->lease_ticks = 0u;
  axis->homing_phase = (uint32_t)ILK_HOMING_NONE;
  if (axis->stall_driven_ticks != 0u) {
    axis->setpoint_changed = 1u;
  }
}

void ilk_axis_disable(ilk_axis_t *axis) {
  ilk_axis_drop_motion(axis);
  if (axis->state != (uint32_t)ILK_AXIS_FAULTED) {
    axis->state = (uint32_t)ILK_AXIS_DISABLED;
  }
}

/** Faults after which the counter no longer tells where the axis is. */
/*@ assigns \nothing;
  @ ensures exact: \result <==> fault == ILK_FAULT_JUMP || fault == ILK_FAULT_CARD_LOST
  @   || fault == ILK_FAULT_HOMING_TRAVEL || fault == ILK_FAULT_HOMING_TIMEOUT;
  @*/
static bool loses_reference(ilk_fault_t fault) {
  return (fault == ILK_FAULT_JUMP) || (fault == ILK_FAULT_CARD_LOST) || (fault == ILK_FAULT_HOMING_TRAVEL) ||
         (fault == ILK_FAULT_HOMING_TIMEOUT);
}

/**
 * Faults the axis. The first fault is kept until CLEAR_FAULT.
 *
 * @return true when the fault is new.
 */
/*@ requires valid: \valid(axis);
  @ requires fault: ILK_FAULT_NONE < fault < ILK_FAULT_COUNT;
  @ assigns  axis->state, axis->setpoint_counts, axis->drive, axis->amplitude, axis->lease_ticks,
  @          axis->homing_phase, axis->setpoint_changed, axis->fault, axis->fault_tick, axis->fault_value,
  @          axis->homed;
  @ ensures  P6_faulted: axis->state == ILK_AXIS_FAULTED;
  @ ensures  new: \result <==> \old(axis->state) != ILK_AXIS_FAULTED;
  @ ensures  P8_first_fault: \old(axis->state) != ILK_AXIS_FAULTED ==> quiet(axis)
  @   && axis->fault == fault && axis->fault_tick == tick && axis->fault_value == value;
  @ ensures  P8_latch: \old(axis->state) == ILK_AXIS_FAULTED ==> axis->fault == \old(axis->fault)
  @   && axis->fault_tick == \old(axis->fault_tick) && axis->fault_value == \old(axis->fault_value)
  @   && axis->lease_ticks == \old(axis->lease_ticks) && axis->homing_phase == \old(axis->homing_phase);
  @ ensures  reference: axis->homed ==
  @   (fault == ILK_FAULT_STALL || fault == ILK_FAULT_REVERSE || fault == ILK_FAULT_DRIFT
  @     ? \old(axis->homed) : 0);
  @*/
static bool raise_fault(ilk_axis_t *axis, ilk_fault_t fault, int32_t value, uint32_t tick) {
  const bool is_new = axis->state != (uint32_t)ILK_AXIS_FAULTED;
  if (is_new) {
    ilk_axis_drop_motion(axis);
    axis->state = (uint32_t)ILK_AXIS_FAULTED;
    axis->fault = (uint32_t)fault;
    axis->fault_tick = tick;
    axis->fault_value = value;
  }
  if (loses_reference(fault)) {
    axis->homed = 0u;
  }
  return is_new;
}

bool ilk_card_is_lost(const ilk_config_t *config, const ilk_axis_t *axis) {
  return axis->bad_frames >= config->bad_frame_limit;
}

/** Built after the card heard the frame of the transaction before; not judged until one was sent. */
/*@ requires readable: \valid_read(reading);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> tick < 2 || reading->tick_echo == tick - 2;
  @*/
static bool echo_is_current(const ilk_reading_t *reading, uint32_t tick) {
  return (tick < 2u) || (reading->tick_echo == (tick - 2u));
}

/*@ requires readable: \valid_read(axis) && \valid_read(reading);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> axis->card_seen == 0 || reading->heartbeat != axis->heartbeat;
  @*/
static bool heartbeat_advanced(const ilk_axis_t *axis, const ilk_reading_t *reading) {
  return (axis->card_seen == 0u) || (reading->heartbeat != axis->heartbeat);
}

void ilk_observe_card(ilk_axis_t *axis, const ilk_reading_t *reading, bool received, uint32_t tick) {
  const bool valid =
      received && reading->intact && echo_is_current(reading, tick) && heartbeat_advanced(axis, reading);
  axis->ticks_since_frame = (axis->card_valid != 0u) ? 1u : count_up(axis->ticks_since_frame, UINT32_MAX);
  axis->card_valid = flag_of(valid);
  if (valid) {
    axis->bad_frames = 0u;
    axis->heartbeat = reading->heartbeat;
    axis->card_time_us = reading->card_time_us;
    axis->card_status = reading->card_status;
  } else {
    axis->bad_frames = count_up(axis->bad_frames, UINT32_MAX);
  }
  if (received && !reading->intact) {
    axis->checksum_failures = count_up(axis->checksum_failures, UINT32_MAX);
  }
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> axis->state != ILK_AXIS_DISABLED && axis->state != ILK_AXIS_FAULTED;
  @*/
static bool is_enabled(const ilk_axis_t *axis) {
  return (axis->state != (uint32_t)ILK_AXIS_DISABLED) && (axis->state != (uint32_t)ILK_AXIS_FAULTED);
}

/*@ requires readable: \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> axis->driven_direction != ILK_DIRECTION_NONE;
  @*/
static bool was_driven(const ilk_axis_t *axis) {
  return axis->driven_direction != (uint32_t)ILK_DIRECTION_NONE;
}

/** The first frame after a drive tells what the drive did, however many were missed in between. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result <==> settled(config, axis);
  @*/
static bool has_settled(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  return !was_driven(axis) && (axis->undriven_ticks >= config->settle_ticks);
}

/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P6_jump: \result.fault == ILK_FAULT_JUMP <==> jumped(config, axis);
  @ ensures  only: \result.fault == ILK_FAULT_JUMP || \result.fault == ILK_FAULT_NONE;
  @ ensures  value: \result.fault == ILK_FAULT_JUMP ==> \result.value == axis->delta_counts;
  @*/
static finding_t judge_jump(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const uint32_t farthest = multiply_saturating(config->max_delta_counts, axis->ticks_since_frame);
  finding_t finding = nothing_found;
  if (magnitude(axis->delta_counts) > farthest) {
    finding.fault = ILK_FAULT_JUMP;
    finding.value = axis->delta_counts;
  }
  return finding;
}

/** How far the axis has come along `direction` since the reading `mark`. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  exact: \result == progress(config, axis, mark_raw, direction);
  @*/
static int32_t progress_from(const ilk_axis_config_t *config, const ilk_axis_t *axis, uint32_t mark_raw,
                             uint32_t direction) {
  return along(direction, travel_between(config, mark_raw, axis->raw));
}

/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P6_reverse: \result.fault == ILK_FAULT_REVERSE <==> reversed(config, axis);
  @ ensures  only: \result.fault == ILK_FAULT_REVERSE || \result.fault == ILK_FAULT_NONE;
  @ ensures  value: \result.fault == ILK_FAULT_REVERSE ==> \result.value ==
  @   clamped(-progress(config, axis, axis->reverse_mark_raw, axis->reverse_direction));
  @*/
static finding_t judge_reverse(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int32_t progress = progress_from(config, axis, axis->reverse_mark_raw, axis->reverse_direction);
  finding_t finding = nothing_found;
  if (was_driven(axis) && (progress < 0) && (magnitude(progress) > config->reverse_counts)) {
    finding.fault = ILK_FAULT_REVERSE;
    finding.value = negate_saturating(progress);
  }
  return finding;
}

/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P6_drift: \result.fault == ILK_FAULT_DRIFT <==> drifted(config, axis);
  @ ensures  only: \result.fault == ILK_FAULT_DRIFT || \result.fault == ILK_FAULT_NONE;
  @ ensures  value: \result.fault == ILK_FAULT_DRIFT ==>
  @   \result.value == travel(config, axis->drift_mark_raw, axis->raw);
  @*/
static finding_t judge_drift(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int32_t drift = travel_between(config, axis->drift_mark_raw, axis->raw);
  finding_t finding = nothing_found;
  if (is_enabled(axis) && has_settled(config, axis) && (magnitude(drift) > config->drift_counts)) {
    finding.fault = ILK_FAULT_DRIFT;
    finding.value = drift;
  }
  return finding;
}

/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P5_stall: \result.fault == ILK_FAULT_STALL <==> stalled(config, axis);
  @ ensures  only: \result.fault == ILK_FAULT_STALL || \result.fault == ILK_FAULT_NONE;
  @ ensures  value: \result.fault == ILK_FAULT_STALL ==> \result.value ==
  @   progress(config, axis, axis->stall_mark_raw, axis->stall_direction);
  @*/
static finding_t judge_stall(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  finding_t finding = nothing_found;
  if (is_enabled(axis) && (axis->stall_driven_ticks >= config->stall_ticks)) {
    finding.fault = ILK_FAULT_STALL;
    finding.value = progress_from(config, axis, axis->stall_mark_raw, axis->stall_direction);
  }
  return finding;
}

/*@ assigns \nothing;
  @ ensures exact: earlier.fault != ILK_FAULT_NONE
  @   ? \result.fault == earlier.fault && \result.value == earlier.value
  @   : \result.fault == later.fault && \result.value == later.value;
  @*/
static finding_t first_of(finding_t earlier, finding_t later) {
  return (earlier.fault != ILK_FAULT_NONE) ? earlier : later;
}

/*@ requires valid: \valid(axis);
  @ assigns  axis->stall_driven_ticks, axis->setpoint_changed, axis->stall_mark_raw;
  @ ensures  P5_stall: axis->stall_driven_ticks == 0 && axis->setpoint_changed == 0
  @   && axis->stall_mark_raw == axis->raw;
  @*/
static void clear_stall_count(ilk_axis_t *axis) {
  axis->stall_driven_ticks = 0u;
  axis->setpoint_changed = 0u;
  axis->stall_mark_raw = axis->raw;
}

/** Moves position and marks to a new reading. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->card_seen, axis->raw, axis->ticks_since_frame, axis->reverse_mark_raw, axis->drift_mark_raw,
  @          axis->stall_mark_raw, axis->homing_mark_raw, axis->delta_counts, axis->position_counts,
  @          axis->press_travel_counts;
  @ ensures  raw: axis->raw == raw && (\old(axis->card_seen) == 0 ? axis->card_seen == 1
  @   : axis->card_seen == \old(axis->card_seen));
  @ ensures  delta: axis->delta_counts == (\old(axis->card_seen) == 0 ? 0 : travel(config, \old(axis->raw), raw));
  @ ensures  position: axis->position_counts == clamped(\old(axis->position_counts) + axis->delta_counts);
  @ ensures  P7_travel: axis->press_travel_counts == clamped(\old(axis->press_travel_counts) + axis->delta_counts);
  @ ensures  new_card: \old(axis->card_seen) == 0 ==> axis->ticks_since_frame == 0
  @   && axis->reverse_mark_raw == raw && axis->drift_mark_raw == raw && axis->stall_mark_raw == raw
  @   && axis->homing_mark_raw == raw;
  @ ensures  P6_marks: \old(axis->card_seen) != 0 ==> axis->reverse_mark_raw == \old(axis->reverse_mark_raw)
  @   && axis->drift_mark_raw == \old(axis->drift_mark_raw) && axis->stall_mark_raw == \old(axis->stall_mark_raw)
  @   && axis->homing_mark_raw == \old(axis->homing_mark_raw)
  @   && axis->ticks_since_frame == \old(axis->ticks_since_frame);
  @*/
static void follow(const ilk_axis_config_t *config, ilk_axis_t *axis, uint32_t raw) {
  if (axis->card_seen == 0u) {
    axis->card_seen = 1u;
    axis->raw = raw;
    axis->ticks_since_frame = 0u;
    axis->reverse_mark_raw = raw;
    axis->drift_mark_raw = raw;
    axis->stall_mark_raw = raw;
    axis->homing_mark_raw = raw;
  }
  axis->delta_counts = travel_between(config, axis->raw, raw);
  axis->position_counts = add_saturating(axis->position_counts, axis->delta_counts);
  axis->press_travel_counts = add_saturating(axis->press_travel_counts, axis->delta_counts);
  axis->raw = raw;
}

/** Motion counts as progress only until the axis has settled: later it is not the drive's doing. */
/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P5_stall: \result <==> !settled(config, axis)
  @   && progress(config, axis, axis->stall_mark_raw, axis->stall_direction) > 0
  @   && progress(config, axis, axis->stall_mark_raw, axis->stall_direction) >= config->stall_min_counts;
  @*/
static bool made_progress(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  const int32_t progress = progress_from(config, axis, axis->stall_mark_raw, axis->stall_direction);
  return !has_settled(config, axis) && (progress > 0) && (magnitude(progress) >= config->stall_min_counts);
}

/** Marks that follow the axis while it does nothing wrong. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->reverse_mark_raw, axis->stall_driven_ticks, axis->setpoint_changed, axis->stall_mark_raw,
  @          axis->drift_mark_raw;
  @ ensures  P6_reverse: axis->reverse_mark_raw == axis->raw
  @   || axis->reverse_mark_raw == \old(axis->reverse_mark_raw);
  @ ensures  P6_drift: axis->state != ILK_AXIS_DISABLED && axis->state != ILK_AXIS_FAULTED && settled(config, axis)
  @   ==> axis->drift_mark_raw == \old(axis->drift_mark_raw);
  @ ensures  P6_idle: axis->state == ILK_AXIS_DISABLED || axis->state == ILK_AXIS_FAULTED
  @   ==> axis->drift_mark_raw == axis->raw;
  @ ensures  P6_driven: !settled(config, axis) ==> axis->drift_mark_raw == axis->raw;
  @ ensures  P5_stall: axis->stall_driven_ticks == 0
  @   || axis->stall_driven_ticks == \old(axis->stall_driven_ticks);
  @*/
static void advance_marks(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  if (progress_from(config, axis, axis->reverse_mark_raw, axis->reverse_direction) > 0) {
    axis->reverse_mark_raw = axis->raw;
  }
  if (made_progress(config, axis)) {
    clear_stall_count(axis);
  }
  if (!is_enabled(axis) || !has_settled(config, axis)) {
    axis->drift_mark_raw = axis->raw;
  }
}

/*@ requires readable: \valid_read(config) && \valid_read(axis);
  @ assigns  \nothing;
  @ ensures  P6_jump: jumped(config, axis) <==> \result.fault == ILK_FAULT_JUMP;
  @ ensures  P6_reverse: reversed(config, axis) ==> \result.fault != ILK_FAULT_NONE;
  @ ensures  P6_drift: drifted(config, axis) ==> \result.fault != ILK_FAULT_NONE;
  @ ensures  P5_stall: stalled(config, axis) ==> \result.fault != ILK_FAULT_NONE;
  @ ensures  founded: \result.fault == ILK_FAULT_NONE || \result.fault == ILK_FAULT_JUMP
  @   || (\result.fault == ILK_FAULT_REVERSE && reversed(config, axis))
  @   || (\result.fault == ILK_FAULT_DRIFT && drifted(config, axis))
  @   || (\result.fault == ILK_FAULT_STALL && stalled(config, axis));
  @*/
static finding_t judge_motion(const ilk_axis_config_t *config, const ilk_axis_t *axis) {
  finding_t finding = judge_jump(config, axis);
  finding = first_of(finding, judge_reverse(config, axis));
  finding = first_of(finding, judge_drift(config, axis));
  finding = first_of(finding, judge_stall(config, axis));
  return finding;
}

/*@ requires valid: \valid_read(config) && \valid(axis) && \valid_read(reading);
  @ requires apart: \separated(config, axis, reading);
  @ assigns  axis->card_seen, axis->raw, axis->ticks_since_frame, axis->reverse_mark_raw, axis->drift_mark_raw,
  @          axis->stall_mark_raw, axis->homing_mark_raw, axis->delta_counts, axis->position_counts,
  @          axis->press_travel_counts, axis->stall_driven_ticks, axis->setpoint_changed,
  @          axis->driven_direction;
  @ ensures  seen: axis->raw == \old(reading->raw) && axis->driven_direction == ILK_DIRECTION_NONE;
  @ ensures  P5_stall: \result.fault == ILK_FAULT_NONE
  @   && axis->state != ILK_AXIS_DISABLED && axis->state != ILK_AXIS_FAULTED ==>
  @     axis->stall_driven_ticks < \old(config->stall_ticks);
  @ ensures  known: 0 <= \result.fault <= ILK_FAULT_JUMP;
  @*/
static finding_t observe_valid(const ilk_axis_config_t *config, ilk_axis_t *axis,
                               const ilk_reading_t *reading) {
  follow(config, axis, reading->raw);
  advance_marks(config, axis);
  const finding_t finding = judge_motion(config, axis);
  axis->driven_direction = (uint32_t)ILK_DIRECTION_NONE;
  return finding;
}

/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->card_seen;
  @ ensures  lost: axis->bad_frames >= config->bad_frame_limit ==>
  @   \result.fault == ILK_FAULT_CARD_LOST && axis->card_seen == 0;
  @ ensures  kept: axis->bad_frames < config->bad_frame_limit ==>
  @   \result.fault == ILK_FAULT_NONE && axis->card_seen == \old(axis->card_seen);
  @*/
static finding_t observe_missing(const ilk_config_t *config, ilk_axis_t *axis) {
  finding_t finding = nothing_found;
  if (ilk_card_is_lost(config, axis)) {
    axis->card_seen = 0u;
    finding.fault = ILK_FAULT_CARD_LOST;
    const uint32_t missed = axis->bad_frames & (uint32_t)INT32_MAX;
    finding.value = (int32_t)missed;
  }
  return finding;
}

/*@ requires valid: \valid(axis);
  @ requires sound: sound_axis(axis);
  @ assigns  axis->lease_ticks, axis->state;
  @ ensures  P15_invariant: sound_axis(axis);
  @ ensures  lease: axis->lease_ticks == \max(\old(axis->lease_ticks) - 1, 0);
  @ ensures  P1_lease: axis->state == (\old(axis->state) == ILK_AXIS_MOVING && axis->lease_ticks == 0
  @   ? ILK_AXIS_ENABLED : \old(axis->state));
  @*/
static void run_lease_down(ilk_axis_t *axis) {
  axis->lease_ticks = count_down(axis->lease_ticks);
  if ((axis->state == (uint32_t)ILK_AXIS_MOVING) && (axis->lease_ticks == 0u)) {
    axis->state = (uint32_t)ILK_AXIS_ENABLED;
  }
}

void ilk_observe_sensor(const ilk_config_t *config, ilk_axis_t *axis) {
  if (axis->card_valid != 0u) {
    axis->card_seen = 1u;
  } else if (ilk_card_is_lost(config, axis)) {
    axis->card_seen = 0u;
  } else {
    /* A few bad frames do not make a card a new one. */
  }
}

/** A drive needs a valid frame: an axis that was driven since its last one was driven in that very tick. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ assigns  axis->undriven_ticks;
  @ ensures  P6_undriven: axis->undriven_ticks ==
  @   (axis->driven_direction != ILK_DIRECTION_NONE && axis->ticks_since_frame == 1 ? 0
  @     : \min(\old(axis->undriven_ticks) + 1, config->settle_ticks));
  @*/
static void count_undriven(const ilk_axis_config_t *config, ilk_axis_t *axis) {
  const bool driven_last_tick = was_driven(axis) && (axis->ticks_since_frame == 1u);
  axis->undriven_ticks = driven_last_tick ? 0u : count_up(axis->undriven_ticks, config->settle_ticks);
}

/** Homing by what the frame said, then the fault that was found first. */
/*@ requires valid: \valid_read(config) && \valid(axis) && \separated(config, axis);
  @ requires sound: sound_axis(axis);
  @ requires known: seen.fault < ILK_FAULT_COUNT;
  @ assigns  axis->state, axis->setpoint_counts, axis->drive, axis->amplitude, axis->lease_ticks,
  @          axis->homing_phase, axis->setpoint_changed, axis->fault, axis->fault_tick, axis->fault_value,
  @          axis->homed, axis->position_counts, axis->homing_ticks, axis->homing_mark_raw, axis->rest_ticks;
  @ ensures  P15_invariant: sound_axis(axis);
  @ ensures  P6_faulted: seen.fault != ILK_FAULT_NONE ==> axis->state == ILK_AXIS_FAULTED;
  @ ensures  P6_reference: seen.fault == ILK_FAULT_CARD_LOST || seen.fault == ILK_FAULT_JUMP ==> axis->homed == 0;
  @ ensures  new: \result <==> \old(axis->state) != ILK_AXIS_FAULTED && axis->state == ILK_AXIS_FAULTED;
  @ ensures  P8_first_fault: \result && seen.fault != ILK_FAULT_NONE ==>
  @   axis->fault == seen.fault && axis->fault_tick == tick && axis->fault_value == seen.value;
  @ ensures  P8_latch: fault_latched{Pre, Post}(axis);
  @ ensures  mode: axis->state == \old(axis->state) || axis->state == ILK_AXIS_FAULTED
  @   || (\old(axis->state) == ILK_AXIS_HOMING && axis->state == ILK_AXIS_ENABLED);
  @*/
static bool conclude(const ilk_axis_config_t *config, ilk_axis_t *axis, finding_t seen, uint32_t tick) {
  const ilk_homing_result_t homing = ilk_homing_advance(config, axis);
  finding_t finding = seen;
  if (homing.fault != ILK_FAULT_NONE) {
    const finding_t homing_finding = {.fault = homing.fault, .value = homing.value};
    finding = first_of(seen, homing_finding);
  }
  bool faulted = false;
  if (finding.fault != ILK_FAULT_NONE) {
    faulted = raise_fault(axis, finding.fault, finding.value, tick);
  }
  return faulted;
}

bool ilk_observe_axis(const ilk_config_t *config, const ilk_axis_config_t *axis_config, ilk_axis_t *axis,
                      const ilk_reading_t *reading, uint32_t tick) {
  const bool valid = axis->card_valid != 0u;
  const bool has_switch = axis_config->limit_side != (uint32_t)ILK_LIMIT_NONE;
  axis->switch_triggered = flag_of(has_switch && (!valid || reading->switch_triggered));
  run_lease_down(axis);
  count_undriven(axis_config, axis);
  const finding_t seen = valid ? observe_valid(axis_config, axis, reading) : observe_missing(config, axis);
  /*@ assert P15_invariant: sound_axis(axis); */
  /*@ assert P8_latch: fault_latched{Pre, Here}(axis); */
  return conclude(axis_config, axis, seen, tick);
}

void ilk_axis_note_drive(const ilk_axis_config_t *config, ilk_axis_t *axis, uint32_t direction) {
  const bool rested = axis->undriven_ticks >= config->settle_ticks;
  if (rested || (axis->reverse_direction != direction)) {
    axis->reverse_direction = direction;
    axis->reverse_mark_raw = axis->raw;
  }
  if (rested || (axis->stall_direction != direction)) {
    axis->stall_direction = direction;
    axis->stall_mark_raw = axis->raw;
  }
  axis->stall_driven_ticks = count_up(axis->stall_driven_ticks, UINT32_MAX);
  axis->driven_direction = direction;
}

void ilk_axis_note_arrival(ilk_axis_t *axis) {
  if (axis->setpoint_changed == 0u) {
    clear_stall_count(axis);
  }
}
