#include "told.h"

#include "arith.h"

/** TLC counts with 32 bits and signs; nothing that is told needs more. */
#define LARGEST 0x3fffffffu

static const char* const contact_name[] = {"OPEN", "CLOSED", "INVALID"};
static const char* const pedal_name[] = {"RELEASED", "PRESSED", "DISAGREE"};
static const char* const mode_name[] = {"INIT", "LOCKED", "READY", "MOTION"};
static const char* const cause_name[] = {"NONE", "BOOT", "ESTOP", "BUS", "PEDAL", "INTEGRITY", "OVERRUN"};
static const char* const state_name[] = {"DISABLED", "ENABLED", "MOVING", "HOMING", "FAULTED"};
static const char* const fault_name[] = {"NONE", "STALL",     "REVERSE",       "DRIFT",
                                         "JUMP", "CARD_LOST", "HOMING_TRAVEL", "HOMING_TIMEOUT"};
static const char* const direction_name[] = {"NONE", "INCREASING", "DECREASING"};
static const char* const phase_name[] = {"NONE", "BACK_OFF", "SEEK", "REST"};
static const char* const limit_name[] = {"NONE", "LOWER", "UPPER"};
static const char* const kind_name[] = {"NONSENSE",    "HEARTBEAT", "STOP", "RESET",    "DISABLE", "ENABLE",
                                        "CLEAR_FAULT", "MOVE",      "HOME", "SET_HOME", "RESTORE"};
static const char* const verdict_name[] = {
    "ACCEPTED", "CHECKSUM", "SEQUENCE", "UNKNOWN", "AXIS",  "MODE",  "PEDAL_DOWN", "CAUSE_PRESENT", "FAULTED",
    "CARD",     "NO_FAULT", "DISABLED", "BUSY",    "LEASE", "DRIVE", "RANGE",      "NO_SWITCH"};
static const char* const gate_name[] = {"OPEN",       "MODE",       "PEDAL",          "ESTOP",
                                        "CARD",       "ENABLE",     "LEASE",          "SETPOINT",
                                        "HARD_LIMIT", "SOFT_LIMIT", "UNHOMED_TRAVEL", "DRIVE"};

static const char* yes(bool holds) { return holds ? "TRUE" : "FALSE"; }

static const char* contact(uint32_t word) { return contact_name[word > 2u ? 2u : word]; }

static uint32_t least(uint32_t a, uint32_t b) { return a < b ? a : b; }

static uint32_t number(uint32_t word) { return least(word, LARGEST); }

/** What comes before an element of a sequence: nothing before the first. */
static const char* comma(bool* first) {
  const char* text = *first ? "" : ",";
  *first = false;
  return text;
}

static void tell_axis_configuration(FILE* file, const ilk_axis_config_t* k) {
  (void)fprintf(file, "[limit_side|->\"%s\",min_counts|->%d,max_counts|->%d,home_offset_counts|->%d,",
                limit_name[k->limit_side], k->min_counts, k->max_counts, k->home_offset_counts);
  (void)fprintf(file, "coast_counts|->%u,deadband_counts|->%u,max_drive|->%u,unhomed_max_drive|->%u,",
                number(k->coast_counts), number(k->deadband_counts), number(k->max_drive),
                number(k->unhomed_max_drive));
  (void)fprintf(file, "unhomed_travel_counts|->%u,home_drive|->%u,home_travel_counts|->%u,",
                number(k->unhomed_travel_counts), number(k->home_drive), number(k->home_travel_counts));
  (void)fprintf(file, "home_backoff_counts|->%u,home_timeout_ticks|->%u,home_rest_ticks|->%u,",
                number(k->home_backoff_counts), number(k->home_timeout_ticks), number(k->home_rest_ticks));
  (void)fprintf(file, "stall_ticks|->%u,stall_min_counts|->%u,reverse_counts|->%u,drift_counts|->%u,",
                number(k->stall_ticks), number(k->stall_min_counts), number(k->reverse_counts),
                number(k->drift_counts));
  (void)fprintf(file, "settle_ticks|->%u,max_delta_counts|->%u,required|->%s]", number(k->settle_ticks),
                number(k->max_delta_counts), yes(k->required != 0u));
}

static void tell_slots(FILE* file, const ilk_config_t* config) {
  bool first = true;
  (void)fprintf(file, "Slots == <<");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_axis(&config->axis[slot])) {
      (void)fprintf(file, "%s%u", comma(&first), slot);
    }
  }
  (void)fprintf(file, ">>\nAxisConfigurations == <<");
  first = true;
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_axis(&config->axis[slot])) {
      (void)fprintf(file, "%s\n  ", comma(&first));
      tell_axis_configuration(file, &config->axis[slot]);
    }
  }
  (void)fprintf(file, ">>\n");
}

static void tell_configuration(FILE* file, const ilk_config_t* config) {
  (void)fprintf(file, "Configuration == [pedal_channels|->%u,app_timeout_ticks|->%u,lease_max_ticks|->%u,",
                config->pedal_channels, config->app_timeout_ticks, config->lease_max_ticks);
  (void)fprintf(file, "pedal_debounce_ticks|->%u,pedal_disagree_ticks|->%u,bad_frame_limit|->%u,",
                config->pedal_debounce_ticks, config->pedal_disagree_ticks, config->bad_frame_limit);
  (void)fprintf(file, "overrun_limit|->%u]\n", config->overrun_limit);
  tell_slots(file, config);
}

static void tell_system(FILE* file, const ilk_config_t* c, const ilk_state_t* s) {
  bool first = true;
  (void)fprintf(file, "<<\"%s\",\"%s\",{", mode_name[s->mode], cause_name[s->cause]);
  for (uint32_t cause = 1u; cause < ILK_CAUSE_COUNT; cause++) {
    if (((s->causes_seen >> cause) & 1u) != 0u) {
      (void)fprintf(file, "%s\"%s\"", comma(&first), cause_name[cause]);
    }
  }
  (void)fprintf(file, "},\"%s\",%s,%u,%u,%u,%s,%u,%s,%u,%u,%u,%s>>", pedal_name[s->pedal],
                yes(s->pedal_armed != 0u), s->pedal_pressed_ticks, s->pedal_released_ticks,
                least(s->pedal_disagree_ticks, c->pedal_disagree_ticks + 1u), yes(s->estop != 0u),
                least(s->app_age_ticks, c->app_timeout_ticks), yes(s->app_alive != 0u), number(s->holder),
                least(s->overruns_in_row, c->overrun_limit), least(s->bus_bad_ticks, c->bad_frame_limit),
                yes(s->config_sound != 0u));
}

static void tell_axis(FILE* file, const ilk_config_t* c, uint32_t slot, const ilk_axis_t* a) {
  const ilk_axis_config_t* k = &c->axis[slot];
  const uint32_t limit = c->bad_frame_limit;
  (void)fprintf(file, "<<\"%s\",\"%s\",%s,%s,%s,%s,%u,%u,%d,%d,%d,%u,%u,", state_name[a->state],
                fault_name[a->fault], yes(a->homed != 0u), yes(a->switch_triggered != 0u),
                yes(a->card_valid != 0u), yes(a->card_seen != 0u), least(a->bad_frames, limit),
                least(a->ticks_since_frame, limit), a->position_counts, a->delta_counts, a->setpoint_counts,
                a->drive, a->lease_ticks);
  (void)fprintf(file, "\"%s\",%d,%u,%d,\"%s\",%s,%d,\"%s\",%d,%u,\"%s\",%u,%d,%u>>",
                direction_name[a->driven_direction], a->press_travel_counts,
                least(a->stall_driven_ticks, k->stall_ticks), travel_between(k, a->stall_mark_raw, a->raw),
                direction_name[a->stall_direction], yes(a->setpoint_changed != 0u),
                travel_between(k, a->reverse_mark_raw, a->raw), direction_name[a->reverse_direction],
                travel_between(k, a->drift_mark_raw, a->raw), a->undriven_ticks, phase_name[a->homing_phase],
                a->homing_ticks, travel_between(k, a->homing_mark_raw, a->raw), a->rest_ticks);
}

static void tell_state(FILE* file, const ilk_config_t* config, const ilk_state_t* state) {
  bool first = true;
  tell_system(file, config, state);
  (void)fprintf(file, ",<<");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_axis(&config->axis[slot])) {
      (void)fprintf(file, "%s", comma(&first));
      tell_axis(file, config, slot, &state->axis[slot]);
    }
  }
  (void)fprintf(file, ">>");
}

static void tell_inputs(FILE* file, const ilk_config_t* config, const told_tick_t* told,
                        const ilk_inputs_t* in) {
  bool first = true;
  (void)fprintf(file, "<<\"%s\",\"%s\",\"%s\",%s,%s,\"%s\",<<", contact(in->pedal_no_closed),
                contact(in->pedal_nc_closed), contact(in->estop_loop_closed), yes(in->deadline_missed != 0u),
                yes(told->attached), told->config_pass);
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_axis(&config->axis[slot])) {
      const told_reading_t* reading = &told->reading[slot];
      (void)fprintf(file, "%s<<\"%s\",%d,%s>>", comma(&first), reading->frame, reading->moved,
                    yes(reading->at_switch));
    }
  }
  (void)fprintf(file, ">>>>");
}

static void tell_request(FILE* file, const char* door, const ilk_request_t* request, uint32_t verdict) {
  const uint32_t kind = request->kind > ILK_REQUEST_COUNT ? 0u : request->kind;
  (void)fprintf(file, "<<\"%s\",\"%s\",%u,%d,%u,%u,%u,\"%s\">>", door, kind_name[kind], number(request->axis),
                request->target_counts, number(request->drive), number(request->lease_ticks),
                number(request->holder), verdict_name[verdict]);
}

static void tell_outputs(FILE* file, const ilk_config_t* config, const ilk_outputs_t* out) {
  bool first = true;
  (void)fprintf(file, "<<");
  for (uint32_t slot = 0u; slot < ILK_SLOTS; slot++) {
    if (has_axis(&config->axis[slot])) {
      const ilk_command_t* command = &out->command[slot];
      (void)fprintf(file, "%s<<\"%s\",\"%s\",%u>>", comma(&first), gate_name[out->gate[slot]],
                    direction_name[command->direction], command->drive);
    }
  }
  (void)fprintf(file, ">>");
}

void told_begin(FILE* file, const ilk_config_t* config, const ilk_state_t* state, bool from_boot) {
  (void)fprintf(file, "---- MODULE TraceData ----\nEXTENDS Integers\n");
  tell_configuration(file, config);
  (void)fprintf(file, "FromBoot == %s\nStart == <<", yes(from_boot));
  tell_state(file, config, state);
  (void)fprintf(file, ">>\nTrace == <<\n");
}

void told_tick(FILE* file, const ilk_config_t* config, const told_tick_t* told, const ilk_inputs_t* in,
               const ilk_request_t request[], const char* const door[], uint32_t count,
               const ilk_state_t* state, const ilk_outputs_t* out, bool first) {
  bool first_request = true;
  (void)fprintf(file, "%s<<", first ? "" : ",\n");
  tell_inputs(file, config, told, in);
  (void)fprintf(file, ",<<");
  for (uint32_t i = 0u; i < count; i++) {
    (void)fprintf(file, "%s", comma(&first_request));
    tell_request(file, door[i], &request[i], out->verdict[i].verdict);
  }
  (void)fprintf(file, ">>,");
  tell_state(file, config, state);
  (void)fprintf(file, ",");
  tell_outputs(file, config, out);
  (void)fprintf(file, ">>");
}

void told_end(FILE* file) { (void)fprintf(file, "\n>>\n====\n"); }
