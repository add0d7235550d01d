/**
 * @file
 * Every field of every structure that crosses the link, in order of its offset.
 *
 * FIELD(type, member) is applied to each. The list is complete when the fields of each structure tile it,
 * which a unit test checks.
 */
#ifndef INTERLOCK_HOST_LAYOUT_TABLE_H
#define INTERLOCK_HOST_LAYOUT_TABLE_H

#include <stddef.h>
#include <stdint.h>

#include "interlock/link.h"

#define ILK_LAYOUT_FIELDS(FIELD) \
  FIELD(ilk_request_t, sequence)                 \
  FIELD(ilk_request_t, kind)                     \
  FIELD(ilk_request_t, axis)                     \
  FIELD(ilk_request_t, target_counts)            \
  FIELD(ilk_request_t, drive)                    \
  FIELD(ilk_request_t, amplitude)                \
  FIELD(ilk_request_t, lease_ticks)              \
  FIELD(ilk_request_t, holder)                   \
  FIELD(ilk_request_t, crc)                      \
  FIELD(ilk_axis_t, state)                       \
  FIELD(ilk_axis_t, fault)                       \
  FIELD(ilk_axis_t, fault_tick)                  \
  FIELD(ilk_axis_t, fault_value)                 \
  FIELD(ilk_axis_t, homed)                       \
  FIELD(ilk_axis_t, switch_triggered)            \
  FIELD(ilk_axis_t, card_valid)                  \
  FIELD(ilk_axis_t, card_seen)                   \
  FIELD(ilk_axis_t, bad_frames)                  \
  FIELD(ilk_axis_t, checksum_failures)           \
  FIELD(ilk_axis_t, heartbeat)                   \
  FIELD(ilk_axis_t, card_time_us)                \
  FIELD(ilk_axis_t, card_status)                 \
  FIELD(ilk_axis_t, ticks_since_frame)           \
  FIELD(ilk_axis_t, raw)                         \
  FIELD(ilk_axis_t, position_counts)             \
  FIELD(ilk_axis_t, delta_counts)                \
  FIELD(ilk_axis_t, setpoint_counts)             \
  FIELD(ilk_axis_t, drive)                       \
  FIELD(ilk_axis_t, amplitude)                   \
  FIELD(ilk_axis_t, lease_ticks)                 \
  FIELD(ilk_axis_t, driven_direction)            \
  FIELD(ilk_axis_t, press_travel_counts)         \
  FIELD(ilk_axis_t, stall_driven_ticks)          \
  FIELD(ilk_axis_t, stall_progress_counts)       \
  FIELD(ilk_axis_t, stall_direction)             \
  FIELD(ilk_axis_t, setpoint_changed)            \
  FIELD(ilk_axis_t, reverse_mark_raw)            \
  FIELD(ilk_axis_t, reverse_direction)           \
  FIELD(ilk_axis_t, drift_mark_raw)              \
  FIELD(ilk_axis_t, undriven_ticks)              \
  FIELD(ilk_axis_t, homing_phase)                \
  FIELD(ilk_axis_t, homing_ticks)                \
  FIELD(ilk_axis_t, homing_mark_raw)             \
  FIELD(ilk_axis_t, rest_ticks)                  \
  FIELD(ilk_state_t, tick)                       \
  FIELD(ilk_state_t, mode)                       \
  FIELD(ilk_state_t, cause)                      \
  FIELD(ilk_state_t, cause_tick)                 \
  FIELD(ilk_state_t, cause_value)                \
  FIELD(ilk_state_t, causes_seen)                \
  FIELD(ilk_state_t, pedal)                      \
  FIELD(ilk_state_t, pedal_armed)                \
  FIELD(ilk_state_t, pedal_pressed_ticks)        \
  FIELD(ilk_state_t, pedal_released_ticks)       \
  FIELD(ilk_state_t, pedal_disagree_ticks)       \
  FIELD(ilk_state_t, estop)                      \
  FIELD(ilk_state_t, app_age_ticks)              \
  FIELD(ilk_state_t, app_alive)                  \
  FIELD(ilk_state_t, holder)                     \
  FIELD(ilk_state_t, link_generation)            \
  FIELD(ilk_state_t, last_sequence)              \
  FIELD(ilk_state_t, overruns_in_row)            \
  FIELD(ilk_state_t, overruns)                   \
  FIELD(ilk_state_t, bus_bad_ticks)              \
  FIELD(ilk_state_t, config_crc)                 \
  FIELD(ilk_state_t, config_slice)               \
  FIELD(ilk_state_t, config_partial_crc)         \
  FIELD(ilk_state_t, config_sound)               \
  FIELD(ilk_state_t, requests_accepted)          \
  FIELD(ilk_state_t, requests_refused)           \
  FIELD(ilk_state_t, axis)                       \
  FIELD(ilk_state_t, seal_sum)                   \
  FIELD(ilk_state_t, seal_order)                 \
  FIELD(ilk_inputs_t, link_generation)           \
  FIELD(ilk_inputs_t, deadline_missed)           \
  FIELD(ilk_inputs_t, transaction_done)          \
  FIELD(ilk_inputs_t, frames_received)           \
  FIELD(ilk_inputs_t, pedal_no_closed)           \
  FIELD(ilk_inputs_t, pedal_nc_closed)           \
  FIELD(ilk_inputs_t, estop_loop_closed)         \
  FIELD(ilk_inputs_t, frame)                     \
  FIELD(ilk_command_t, direction)                \
  FIELD(ilk_command_t, drive)                    \
  FIELD(ilk_command_t, amplitude)                \
  FIELD(ilk_timing_t, bucket)                    \
  FIELD(ilk_timing_t, max_ns)                    \
  FIELD(ilk_snapshot_t, clock)                   \
  FIELD(ilk_snapshot_t, simulated)               \
  FIELD(ilk_snapshot_t, degraded)                \
  FIELD(ilk_snapshot_t, granted)                 \
  FIELD(ilk_snapshot_t, period_us)               \
  FIELD(ilk_snapshot_t, config_crc)              \
  FIELD(ilk_snapshot_t, requests_dropped)        \
  FIELD(ilk_snapshot_t, overruns)                \
  FIELD(ilk_snapshot_t, state)                   \
  FIELD(ilk_snapshot_t, inputs)                  \
  FIELD(ilk_snapshot_t, command)                 \
  FIELD(ilk_snapshot_t, gate)                    \
  FIELD(ilk_snapshot_t, lamp)                    \
  FIELD(ilk_snapshot_t, timing)                  \
  FIELD(ilk_event_t, number)                     \
  FIELD(ilk_event_t, kind)                       \
  FIELD(ilk_event_t, tick)                       \
  FIELD(ilk_event_t, value)                      \
  FIELD(ilk_link_kernel_region_t, magic)         \
  FIELD(ilk_link_kernel_region_t, version)       \
  FIELD(ilk_link_kernel_region_t, layout_hash)   \
  FIELD(ilk_link_kernel_region_t, generation)    \
  FIELD(ilk_link_kernel_region_t, request_tail)  \
  FIELD(ilk_link_kernel_region_t, event_head)    \
  FIELD(ilk_link_kernel_region_t, snapshot_lock) \
  FIELD(ilk_link_kernel_region_t, snapshot)      \
  FIELD(ilk_link_kernel_region_t, event)         \
  FIELD(ilk_link_app_region_t, magic)            \
  FIELD(ilk_link_app_region_t, request_head)     \
  FIELD(ilk_link_app_region_t, seen_tick)        \
  FIELD(ilk_link_app_region_t, request)          \
  FIELD(ilk_link_hello_t, magic)                 \
  FIELD(ilk_link_hello_t, version)               \
  FIELD(ilk_link_hello_t, layout_hash)           \
  FIELD(ilk_link_hello_t, generation)            \
  FIELD(ilk_link_hello_t, kernel_region_bytes)   \
  FIELD(ilk_link_hello_t, app_region_bytes)

/** Where one field sits. */
typedef struct {
  uint32_t struct_bytes; /**< size of the structure that holds it */
  uint32_t offset;
  uint32_t bytes;
} ilk_layout_field_t;

#define ILK_LAYOUT_ENTRY(type, member) \
  {(uint32_t)sizeof(type), (uint32_t)offsetof(type, member), (uint32_t)sizeof(((type *)0)->member)},

#ifdef __cplusplus
extern "C" {
#endif

/** CRC-32 (IEEE 802.3, reflected) over the entries, each word least significant byte first. */
uint32_t ilk_layout_crc(const ilk_layout_field_t fields[], size_t count);

#ifdef __cplusplus
}
#endif

#endif
