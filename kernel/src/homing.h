/**
 * @file
 * Homing: two edges of the switch, the second one slowly, and rest at it (property P17).
 */
#ifndef ILK_HOMING_H
#define ILK_HOMING_H

#include <stdbool.h>

#include "interlock/types.h"

/** A fault that ends homing, or NONE. */
typedef struct {
  ilk_fault_t fault;
  int32_t value;
} ilk_homing_result_t;

/** Direction in which the switch of the axis lies; NONE without one. */
uint32_t ilk_towards_switch(const ilk_axis_config_t *config);

/** HOME was accepted: the axis is not homed until the end. */
void ilk_homing_begin(ilk_axis_t *axis);

/** Phase 4, in each tick of HOMING: what this tick's frame means for it, and its budget. */
ilk_homing_result_t ilk_homing_advance(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                       ilk_axis_t *axis);

/** What homing wants in its phase. */
ilk_command_t ilk_homing_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Travel and time of this press are not used up (HOME: BUDGET). */
bool ilk_homing_has_budget(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** What is left of the travel of this press, coast kept back; 0 when nothing is. */
uint32_t ilk_homing_travel_left(const ilk_axis_config_t *config, const ilk_axis_t *axis);

#endif
