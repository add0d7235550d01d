/**
 * @file
 * What an axis wants, and the output gate: the only place from which a drive can leave (P1 to P5, P7).
 */
#ifndef ILK_GATE_H
#define ILK_GATE_H

#include "interlock/types.h"

/** Positions from which outward drive is allowed no more, and beyond which no setpoint is accepted. */
typedef struct {
  int64_t low;
  int64_t high;
} ilk_reach_t;

/** Of an axis that is homed: soft limits less coast, and where its switch is sure to be open. */
ilk_reach_t ilk_reach(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** What is left of the travel by MOVE of this press, coast kept back; 0 when nothing is. */
uint32_t ilk_unhomed_travel_left(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Largest drive: the axis' own, a smaller one while it is not homed. */
uint32_t ilk_drive_bound(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** The kernel, not the app, picks the direction: towards the setpoint, none within the deadband; or as homing
 * asks. */
ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** The first gate that blocks `wanted`; OPEN when it may leave. */
ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_system_t *system,
                           const ilk_axis_t *axis, const ilk_command_t *wanted);

#endif
