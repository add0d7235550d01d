/**
 * @file
 * What an axis wants, and the output gate: the only place from which a drive can leave (P1 to P5, P7).
 */
#ifndef ILK_GATE_H
#define ILK_GATE_H

#include "interlock/types.h"

/** The kernel, not the app, picks the direction: towards the setpoint, none within the deadband; or as homing
 * asks. */
ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** The first gate that blocks `wanted`; OPEN when it may leave. */
ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_system_t *system,
                           const ilk_axis_t *axis, const ilk_command_t *wanted);

#endif
