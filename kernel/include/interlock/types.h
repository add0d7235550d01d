/**
 * @file
 * The words that cross the kernel's door: configuration, state, inputs, requests, outputs.
 *
 * Every structure here is built from 32-bit words alone. It has no padding, no pointer and no `bool`,
 * so its layout is the same on x86-64, ARM and wasm32, every byte of it belongs to a named field,
 * and any bit pattern is a value that the kernel can judge.
 *
 * Units live in the names: `_counts` encoder counts, `_ticks` control periods, `_us` microseconds.
 * Fields that hold a code are `uint32_t`; the enumerations are in catalog.h.
 */
#ifndef INTERLOCK_TYPES_H
#define INTERLOCK_TYPES_H

#include <stdint.h>

#include "interlock/catalog.h"

/** Card slots of a robot. A slot carries at most one axis, so an axis is named by its slot.
   Ten as shipped; whole ticks are proved with one and with two. */
#ifndef ILK_SLOTS
#define ILK_SLOTS 10
#endif

/** 32-bit words of a card frame, each way. 32 and 64 are supported; see spec/frames.md. */
#ifndef ILK_FRAME_WORDS
#define ILK_FRAME_WORDS 32
#endif

/** Requests that one tick looks at; the rest wait in the ring for the next tick. */
#define ILK_REQUESTS_PER_TICK 16

/** Version of `ilk_config_t`. A configuration with another version is refused. */
#define ILK_CONFIG_VERSION 2u

/** Ticks from a reading to the effect that a decision on it has on the card: spec/frames.md, Fresh. */
#define ILK_LATENCY_TICKS 2u

/** One axis (or sensor card) of the robot, by slot. Ranges: `ilk_config_validate`. */
typedef struct {
  uint32_t card;                 /**< ilk_card_t; NONE leaves the slot empty */
  uint32_t required;             /**< 1: losing this card ends MOTION and blocks it */
  uint32_t motor_direction;      /**< 1: the card's direction bit follows the axis, 0: it is inverted */
  uint32_t direction_correction; /**< 1: position decreases while the raw counter increases */
  uint32_t limit_side;           /**< ilk_limit_side_t: the end at which the switch sits */
  int32_t min_counts;            /**< lower soft limit */
  int32_t max_counts;            /**< upper soft limit */
  int32_t home_offset_counts;    /**< position at the edge of the switch */
  uint32_t coast_counts; /**< farthest travel until rest, from the reading on which drive was last allowed */
  uint32_t backlash_counts;       /**< lost motion when the direction changes */
  uint32_t noise_counts;          /**< peak-to-peak noise of the counter at rest */
  uint32_t deadband_counts;       /**< no drive this near to the setpoint */
  uint32_t dead_zone_drive;       /**< largest drive that does not move the axis */
  uint32_t max_drive;             /**< largest drive */
  uint32_t unhomed_max_drive;     /**< largest drive while not homed */
  uint32_t max_amplitude;         /**< largest wave amplitude; 0 unless the card is HIGH_FREQUENCY */
  uint32_t unhomed_travel_counts; /**< farthest travel by MOVE in one press of the pedal while not homed */
  uint32_t home_drive;            /**< drive of homing until the first edge, and of its back-offs */
  uint32_t home_slow_drive;       /**< drive of the second approach */
  uint32_t home_amplitude;        /**< wave amplitude while homing */
  uint32_t home_travel_counts;    /**< farthest travel of homing in one press of the pedal */
  uint32_t home_timeout_ticks;    /**< longest homing in one press of the pedal */
  uint32_t home_clear_counts;     /**< every back-off ends at least this far from where the switch changed */
  uint32_t home_tolerance_counts; /**< the two edges of homing agree within this */
  uint32_t switch_hysteresis_counts;     /**< the switch opens this far from where it closes, at most */
  uint32_t full_speed_counts_per_s;      /**< highest speed at `max_drive` */
  uint32_t home_speed_counts_per_s;      /**< slowest speed at `home_drive` */
  uint32_t home_slow_speed_counts_per_s; /**< slowest speed at `home_slow_drive` */
  uint32_t stall_ticks;                  /**< driven ticks without progress that are a stall */
  uint32_t stall_effort_ticks; /**< ticks of full drive without progress that are a stall; 0: not judged */
  uint32_t stall_min_counts;   /**< progress that clears the count of driven ticks */
  uint32_t reverse_counts;     /**< tolerated motion against the command */
  uint32_t drift_counts;       /**< tolerated motion while not driven */
  uint32_t rest_ticks;         /**< ticks without motion that are rest */
  uint32_t max_delta_counts;   /**< largest possible motion in one tick */
} ilk_axis_config_t;

/** What all axes share. */
typedef struct {
  uint32_t version;               /**< ILK_CONFIG_VERSION */
  uint32_t size_bytes;            /**< sizeof(ilk_config_t) */
  uint32_t period_us;             /**< control period, 125 to 2000 */
  uint32_t pedal_channels;        /**< 1: normally open contact only, 2: normally open and normally closed */
  uint32_t app_timeout_ticks;     /**< silence of the app that ends MOTION */
  uint32_t lease_max_ticks;       /**< longest lease of a MOVE */
  uint32_t pedal_debounce_ticks;  /**< ticks that make a press or the arming release count */
  uint32_t pedal_disagree_ticks;  /**< disagreement of the channels that locks */
  uint32_t power_up_ticks;        /**< from power on until the amplifiers obey */
  uint32_t switch_debounce_ticks; /**< valid readings in a row that make an edge of a switch count */
  uint32_t bad_frame_limit;       /**< bad frames in a row that lose a card, or the bus */
  uint32_t overrun_limit;         /**< missed deadlines in a row that lock */
} ilk_common_config_t;

/** The whole configuration. It never changes after `ilk_init`; its CRC-32 is checked slice by slice. */
typedef struct {
  ilk_common_config_t common;        /**< of all axes */
  ilk_axis_config_t axis[ILK_SLOTS]; /**< by slot */
  uint32_t crc;                      /**< `ilk_config_crc` of the words above */
} ilk_config_t;

/** Readings of a counter that lie close together, tick after tick. */
typedef struct {
  uint32_t origin_raw; /**< the first of them */
  int32_t below;       /**< the lowest, from there */
  int32_t above;       /**< the highest, from there */
  uint32_t ticks;      /**< how many ticks they last, saturating at `rest_ticks` */
} ilk_stillness_t;

/** What the kernel remembers of one axis. */
typedef struct {
  uint32_t state;              /**< ilk_axis_state_t */
  uint32_t fault;              /**< ilk_fault_t; the first one since CLEAR_FAULT */
  uint32_t fault_tick;         /**< tick of that fault */
  int32_t fault_value;         /**< what was measured, in the unit of the rule that was broken */
  uint32_t homed;              /**< ilk_homed_t */
  uint32_t runaway;            /**< 1: moved although faulted, and not at rest since */
  uint32_t card_valid;         /**< 1: this tick's frame was valid */
  uint32_t card_seen;          /**< 1: `raw` holds a reading, and nothing since says that it is worthless */
  uint32_t bad_frames;         /**< bad frames in a row, saturating */
  uint32_t checksum_failures;  /**< since boot, saturating */
  uint32_t heartbeat;          /**< of the last valid frame */
  uint32_t card_time_us;       /**< card's timestamp of the last valid reading, wrapping */
  uint32_t card_status;        /**< status word of the last valid frame */
  uint32_t periods;            /**< loop periods since the valid frame before this one, saturating */
  uint32_t raw;                /**< counter of the last valid frame, wrapping */
  int32_t position_counts;     /**< saturating */
  int32_t delta_counts;        /**< motion seen by the last valid frame, in the sense of the position */
  uint32_t switch_triggered;   /**< 1: at the switch, or the switch was not read validly */
  uint32_t switch_reading;     /**< 1: the last valid reading was triggered */
  uint32_t switch_run_ticks;   /**< valid readings in a row that say so, saturating at the debounce time */
  uint32_t switch_run_raw;     /**< counter at the first of them */
  uint32_t implausible_ticks;  /**< valid readings in a row in which the switch contradicts the position */
  int32_t setpoint_counts;     /**< of the last accepted MOVE */
  uint32_t drive;              /**< of the last accepted MOVE */
  uint32_t amplitude;          /**< of the last accepted MOVE */
  uint32_t lease_ticks;        /**< ticks for which the MOVE still holds */
  uint32_t driven_direction;   /**< ilk_direction_t driven since the last valid frame */
  ilk_stillness_t rest;        /**< undriven, valid, within `noise_counts` */
  ilk_stillness_t calm;        /**< within `drift_counts` */
  uint32_t drift_mark_raw;     /**< reading from which motion without drive counts */
  uint32_t reverse_direction;  /**< ilk_direction_t last driven */
  uint32_t reverse_mark_raw;   /**< farthest reading in it */
  uint32_t stall_direction;    /**< ilk_direction_t in which progress counts */
  uint32_t stall_mark_raw;     /**< reading from which progress of `stall_min_counts` counts */
  uint32_t effort_mark_raw;    /**< reading from which progress beyond noise counts */
  uint32_t stall_driven_ticks; /**< driven ticks without the first, saturating */
  uint32_t effort_low;         /**< drive summed over driven ticks without the second, 64 bits, saturating */
  uint32_t effort_high;        /**< upper half of that sum */
  uint32_t path_raw;           /**< follows the counter when it is more than noise away */
  uint32_t path_is_homing;     /**< 1: what it travels is homing's */
  uint32_t unhomed_travel_counts; /**< its path in this press while not homed, homing apart, saturating */
  uint32_t homing_travel_counts;  /**< its path in this press while homing, saturating */
  uint32_t homing_ticks;          /**< ticks of homing in this press, saturating */
  uint32_t homing_phase;          /**< ilk_homing_phase_t */
  uint32_t homing_mark_raw;       /**< where the switch changed, or where the back-off began */
  uint32_t first_edge_raw;        /**< counter at the first edge */
  uint32_t home_raw;              /**< counter at the last reference */
  uint32_t home_known;            /**< 1: `home_raw` may be compared with the next one */
  int32_t home_difference_counts; /**< of the last two references; 0 before the second */
  uint32_t wiring;                /**< card, switch end and motor sense at the start, packed (integrity.c) */
} ilk_axis_t;

/** What the kernel remembers of the robot as a whole. */
typedef struct {
  uint32_t tick;                 /**< steps since `ilk_init` or since a damaged state was rebuilt, wrapping */
  uint32_t frames_sent;          /**< frames handed over since then, saturating at 2 */
  uint32_t mode;                 /**< ilk_mode_t */
  uint32_t cause;                /**< ilk_cause_t: why LOCKED; the first one, kept until RESET */
  uint32_t cause_tick;           /**< tick of that cause */
  uint32_t cause_value;          /**< what was seen: contacts, counts or words, as the catalog says */
  uint32_t causes_seen;          /**< bit n: cause n happened since RESET */
  uint32_t consent;              /**< number of this press of the pedal; 0 outside of MOTION */
  uint32_t powered_ticks;        /**< ticks since power came on, saturating at `power_up_ticks` */
  uint32_t pedal;                /**< ilk_pedal_t in this tick */
  uint32_t pedal_armed;          /**< 1: a press will count */
  uint32_t pedal_pressed_ticks;  /**< pressed for so long, saturating at the debounce time */
  uint32_t pedal_released_ticks; /**< released for so long, saturating at the debounce time */
  uint32_t pedal_disagree_ticks; /**< channels disagree for so long, saturating */
  uint32_t estop;                /**< 1: E-stop active in this tick */
  uint32_t app_age_ticks;        /**< ticks since the last HEARTBEAT, saturating */
  uint32_t app_alive;            /**< 1: HEARTBEAT within `app_timeout_ticks`, as decided in this tick */
  uint32_t holder;               /**< control holder named by the last HEARTBEAT */
  uint32_t link_generation;      /**< attachment from which requests come */
  uint32_t last_sequence;        /**< newest sequence number of that attachment */
  uint32_t overruns_in_row;      /**< missed deadlines in a row, saturating */
  uint32_t overruns;             /**< missed deadlines since boot, saturating */
  uint32_t bus_bad_ticks;        /**< ticks in a row without any valid frame, saturating */
  uint32_t config_crc;           /**< CRC-32 of the configuration at `ilk_init` */
  uint32_t config_slice;         /**< slice that the next tick checks */
  uint32_t config_partial_crc;   /**< CRC-32 over the slices before it */
  uint32_t config_sound;         /**< 0: damaged; 1: the last whole pass agreed */
  uint32_t pedal_channels;       /**< of the configuration at the start */
  uint32_t app_timeout_ticks;    /**< of the configuration at the start */
  uint32_t requests_accepted;    /**< since boot, saturating */
  uint32_t requests_refused;     /**< since boot, saturating */
} ilk_system_t;

/** What the kernel remembers. Only `ilk_init` and `ilk_step` write it. */
typedef struct {
  ilk_system_t system;        /**< of all axes */
  ilk_axis_t axis[ILK_SLOTS]; /**< by slot */
  uint32_t seal;              /**< digest of all words above */
} ilk_state_t;

/** What the executive saw in this tick. Contacts: 1 closed, 0 open; any other value counts as unsafe. */
typedef struct {
  uint32_t link_generation;   /**< attachment of the app; a new value restarts the sequence numbers */
  uint32_t boot_nonce;        /**< drawn anew at every start and after an integrity failure */
  uint32_t deadlines_missed;  /**< 0: on time; otherwise so many periods passed without a tick before this */
  uint32_t transaction_done;  /**< 1: the bus transaction of this tick completed */
  uint32_t frames_received;   /**< bit n: slot n answered in this tick */
  uint32_t pedal_no_closed;   /**< normally open contact: closed means pressed */
  uint32_t pedal_nc_closed;   /**< normally closed contact: open means pressed; unused with one channel */
  uint32_t estop_loop_closed; /**< E-stop loop: closed means all clear */
  uint32_t frame[ILK_SLOTS][ILK_FRAME_WORDS]; /**< as received, spec/frames.md */
} ilk_inputs_t;

/** One wish of the app. Fields that a kind does not use are ignored, but covered by the CRC. */
typedef struct {
  uint32_t sequence;     /**< newer than every earlier one of this attachment; starts at 1 */
  uint32_t kind;         /**< ilk_request_kind_t */
  uint32_t axis;         /**< slot, for requests that name an axis */
  int32_t target_counts; /**< MOVE: setpoint; RESTORE: position */
  uint32_t drive;        /**< MOVE: 1 to `max_drive` */
  uint32_t amplitude;    /**< MOVE: 0 to `max_amplitude` */
  uint32_t lease_ticks;  /**< MOVE: 1 to `lease_max_ticks` */
  uint32_t consent;      /**< MOVE, HOME: number of the press of the pedal that its author saw */
  uint32_t holder;       /**< HEARTBEAT: who is in control */
  uint32_t crc;          /**< `ilk_request_crc` of the words above */
} ilk_request_t;

/** The one answer to a request. */
typedef struct {
  uint32_t tick;     /**< tick in which it was judged */
  uint32_t sequence; /**< as in the request, even when its CRC is wrong */
  uint32_t kind;     /**< as in the request */
  uint32_t axis;     /**< as in the request */
  uint32_t verdict;  /**< ilk_verdict_t */
} ilk_verdict_record_t;

/** What one card is told to do. Zero drive is `{ILK_DIRECTION_NONE, 0, 0}`. */
typedef struct {
  uint32_t direction; /**< ilk_direction_t */
  uint32_t drive;     /**< speed magnitude, 0 to `max_drive` */
  uint32_t amplitude; /**< HIGH_FREQUENCY only */
} ilk_command_t;

/** What the kernel decided in this tick. `ilk_step` writes every word of it. */
typedef struct {
  ilk_command_t command[ILK_SLOTS];           /**< what left the output gate */
  uint32_t gate[ILK_SLOTS];                   /**< ilk_gate_t: the first gate that blocks, OPEN when driven */
  uint32_t frame[ILK_SLOTS][ILK_FRAME_WORDS]; /**< the commands, packed by spec/frames.md */
  uint32_t power;                             /**< 1: the amplifiers have power */
  uint32_t lamp[ILK_LAMP_COUNT];              /**< ilk_colour_t by ilk_lamp_t */
  uint32_t verdict_count;                     /**< valid entries of `verdict` */
  ilk_verdict_record_t verdict[ILK_REQUESTS_PER_TICK]; /**< in the order of the requests */
} ilk_outputs_t;

/** Answer of configuration validation: the first rule broken and where. */
typedef struct {
  uint32_t error; /**< ilk_config_error_t; NONE when valid */
  uint32_t slot;  /**< slot of the axis, ILK_SLOTS for a system field */
} ilk_config_verdict_t;

#endif
