/**
 * @file
 * A ghost that begins in the middle of a run. See monitors.h.
 */
#include "monitors.h"

static bool is_homing(const ilk_axis_t* axis, ilk_homing_phase_t phase) {
  return axis->state == ILK_AXIS_HOMING && axis->homing_phase == (uint32_t)phase;
}

/** The edges that the phase of a homing implies. An edge that may have been seen is one. */
static void adopt_homing(ilk_ghost_slot_t* g, const ilk_axis_config_t* config, uint32_t debounce,
                         const ilk_axis_t* axis) {
  const bool slow = is_homing(axis, ILK_HOMING_APPROACH) || is_homing(axis, ILK_HOMING_REST);
  g->seeks = axis->state == ILK_AXIS_HOMING;
  g->home_run = axis->switch_run_ticks;
  g->home_run_raw = axis->switch_run_raw;
  g->home_open = axis->switch_run_ticks < debounce || axis->switch_reading == 0u;
  g->reference = axis->home_raw;
  if (slow || is_homing(axis, ILK_HOMING_BACK_OFF)) {
    g->edges.firsts = 1u;
    g->edges.first[0] = axis->first_edge_raw;
    g->edges.slow[0] = slow;
  }
  if (is_homing(axis, ILK_HOMING_REST)) {
    const int32_t apart = judge_counts(config, axis->homing_mark_raw, axis->first_edge_raw);
    g->edges.second[0] = axis->homing_mark_raw;
    g->edges.seconds =
        ((apart < 0 ? -(int64_t)apart : apart) <= (int64_t)config->home_tolerance_counts) ? 1u : 0u;
  }
}

/** The run of readings goes on; how old its ends are is not known. */
static void adopt_calm(ilk_still_t* calm, const ilk_axis_config_t* config, const ilk_stillness_t* still) {
  const bool turned = config->direction_correction == 1u;
  calm->origin = still->origin_raw;
  calm->low = turned ? -still->above : still->below;
  calm->high = turned ? -still->below : still->above;
  calm->low_age = UINT32_MAX;
  calm->high_age = UINT32_MAX;
  calm->ticks = still->ticks;
  calm->apart_age = UINT32_MAX;
}

static void adopt_slot(ilk_ghost_slot_t* g, const ilk_config_t* config, const ilk_state_t* state,
                       uint32_t slot) {
  const ilk_axis_t* axis = &state->axis[slot];
  const bool ordered = axis->state == ILK_AXIS_MOVING || axis->state == ILK_AXIS_HOMING;
  g->seen = axis->card_seen != 0u;
  g->bad_run = axis->bad_frames;
  g->lost = g->bad_run >= config->common.bad_frame_limit;
  g->heartbeat = axis->heartbeat;
  g->status = axis->card_status;
  g->raw = axis->raw;
  g->periods = (axis->card_valid != 0u) ? 0u : axis->periods;
  g->triggered = axis->switch_reading != 0u;
  g->run = axis->switch_run_ticks;
  g->run_raw = axis->switch_run_raw;
  g->rest.apart_age = UINT32_MAX; /* neither moves nor rests for sure */
  adopt_calm(&g->calm, &config->axis[slot], &axis->calm);
  g->quiet = UINT32_MAX;
  g->since_disable = UINT32_MAX;
  g->drift_known = axis->state != ILK_AXIS_FAULTED;
  g->drift_mark = axis->drift_mark_raw;
  g->fault_mark = axis->drift_mark_raw;
  g->delta = axis->delta_counts;
  g->ran = axis->runaway != 0u;
  g->maybe_ran = g->ran;
  g->driven = axis->card_valid != 0u && axis->driven_direction != ILK_DIRECTION_NONE;
  g->direction = axis->driven_direction;
  g->reverse_direction = axis->reverse_direction;
  g->reverse_mark = axis->reverse_mark_raw;
  g->stall_direction = axis->stall_direction;
  g->stall_mark = axis->stall_mark_raw;
  g->effort_mark = axis->effort_mark_raw;
  g->stall_ticks = axis->stall_driven_ticks;
  g->effort = ((uint64_t)axis->effort_high << 32u) | axis->effort_low;
  g->path_known = g->seen;
  g->path = axis->path_raw;
  g->path_homing = axis->path_is_homing != 0u;
  g->move_travel = axis->unhomed_travel_counts;
  g->homing_travel = axis->homing_travel_counts;
  g->homing_ticks = axis->homing_ticks + ((axis->state == ILK_AXIS_HOMING) ? 1u : 0u);
  g->lease = axis->lease_ticks;
  g->setpoint = axis->setpoint_counts;
  g->order_drive = axis->drive;
  g->order_consent = ordered ? state->system.consent : 0u;
  g->state = axis->state;
  g->homed = axis->homed;
  adopt_homing(g, &config->axis[slot], config->common.switch_debounce_ticks, axis);
  g->position_known = g->seen;
  g->position = axis->position_counts;
  g->implausible = axis->implausible_ticks;
}

void ghost_adopt(ilk_ghost_t* ghost, const ilk_config_t* config, const ilk_state_t* state) {
  const ilk_ghost_t zero = {0};
  const ilk_system_t* system = &state->system;
  *ghost = zero;
  ghost->tick = system->tick;
  ghost->frames_sent = system->frames_sent;
  ghost->link_generation = system->link_generation;
  ghost->last_sequence = system->last_sequence;
  ghost->holder = system->holder;
  ghost->app_age = system->app_age_ticks;
  ghost->pressed_ticks = system->pedal_pressed_ticks;
  ghost->released_ticks = system->pedal_released_ticks;
  ghost->disagree_ticks = system->pedal_disagree_ticks;
  ghost->bus_bad_ticks = system->bus_bad_ticks;
  ghost->missed_in_row = system->overruns_in_row;
  ghost->missed_ticks = (system->overruns_in_row > 0u) ? 1u : 0u;
  ghost->powered_ticks = system->powered_ticks;
  ghost->armed_ticks = system->pedal_released_ticks;
  ghost->armed = system->pedal_armed != 0u;
  ghost->armed_weakly = ghost->armed;
  ghost->mode = system->mode;
  ghost->last_consent = system->consent;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    adopt_slot(&ghost->slot[slot], config, state, slot);
  }
}
