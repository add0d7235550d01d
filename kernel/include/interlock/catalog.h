/**
 * @file
 * Every mode, request, verdict, cause, fault and gate by its number. Generated from spec/catalog.toml by `make generate`. Do not edit.
 */
#ifndef INTERLOCK_CATALOG_H
#define INTERLOCK_CATALOG_H

/** System modes. */
typedef enum {
  ILK_MODE_INIT = 0,   /**< The kernel has no valid configuration; every output is zero. */
  ILK_MODE_LOCKED = 1, /**< Motion is latched off; the first cause is kept. */
  ILK_MODE_READY = 2,  /**< All is clear; the kernel waits for the pedal. */
  ILK_MODE_MOTION = 3, /**< The pedal is held after fresh consent; accepted moves drive their axes. */
} ilk_mode_t;

/** Codes of ilk_mode_t. */
#define ILK_MODE_COUNT 4u

/** States of an axis. */
typedef enum {
  ILK_AXIS_DISABLED = 0, /**< The axis is not driven; outside of MOTION it may be moved by hand. */
  ILK_AXIS_ENABLED = 1,  /**< The axis is ready for a move and stands still. */
  ILK_AXIS_MOVING = 2,   /**< A move is held by its lease. */
  ILK_AXIS_HOMING = 3,   /**< The kernel runs the axis to its switch to reference it. */
  ILK_AXIS_FAULTED = 4,  /**< The axis broke a rule and is not driven. */
} ilk_axis_state_t;

/** Codes of ilk_axis_state_t. */
#define ILK_AXIS_COUNT 5u

/** Requests of the app. `fields` are read by the kernel; `checks` are the verdicts that can refuse it, in order, after CHECKSUM, SEQUENCE, UNKNOWN and AXIS. */
typedef enum {
  ILK_REQUEST_HEARTBEAT = 1,   /**< The app is alive; `holder` is in control. */
  ILK_REQUEST_STOP = 2,        /**< End MOTION now, or take back a pedal that is armed. */
  ILK_REQUEST_RESET = 3,       /**< Unlock. */
  ILK_REQUEST_DISABLE = 4,     /**< Take the axis out of motion. */
  ILK_REQUEST_ENABLE = 5,      /**< Let the axis be moved, from where it stands. */
  ILK_REQUEST_CLEAR_FAULT = 6, /**< Acknowledge the fault of the axis. */
  ILK_REQUEST_MOVE = 7,        /**< Drive the axis towards a setpoint for as long as the lease holds. */
  ILK_REQUEST_HOME = 8,        /**< Reference the axis at its switch. */
  ILK_REQUEST_SET_HOME = 9,    /**< Declare that the axis stands at its home position. */
  ILK_REQUEST_RESTORE = 10,    /**< Set the position from a saved one; the axis is not homed afterwards. */
} ilk_request_kind_t;

/** Codes of ilk_request_kind_t. */
#define ILK_REQUEST_COUNT 10u

/** The one answer to a request. */
typedef enum {
  ILK_VERDICT_ACCEPTED = 0,      /**< The request takes effect in this tick. */
  ILK_VERDICT_CHECKSUM = 1,      /**< The request's CRC does not match its words. */
  ILK_VERDICT_SEQUENCE = 2,      /**< The sequence number is not newer than the last one. */
  ILK_VERDICT_UNKNOWN = 3,       /**< There is no such request. */
  ILK_VERDICT_AXIS = 4,          /**< No axis in that slot. */
  ILK_VERDICT_MODE = 5,          /**< The request is not allowed in this mode. */
  ILK_VERDICT_PEDAL_DOWN = 6,    /**< The pedal must be released first. */
  ILK_VERDICT_CAUSE_PRESENT = 7, /**< What locked the system or faulted the axis is still there. */
  ILK_VERDICT_FAULTED = 8,       /**< The axis is faulted. */
  ILK_VERDICT_CARD = 9,          /**< The axis' card gave no valid frame in this tick. */
  ILK_VERDICT_NO_FAULT = 10,     /**< There is no fault to clear. */
  ILK_VERDICT_DISABLED = 11,     /**< The axis is not enabled. */
  ILK_VERDICT_BUSY = 12,         /**< The axis is homing or not at rest, or power is not up. */
  ILK_VERDICT_LEASE = 13,        /**< The lease is zero or too long. */
  ILK_VERDICT_DRIVE = 14,        /**< Drive is zero, or drive or amplitude is above its bound. */
  ILK_VERDICT_RANGE = 15,        /**< The setpoint or position is outside the allowed range. */
  ILK_VERDICT_NO_SWITCH = 16,    /**< The axis has no limit switch to home at. */
  ILK_VERDICT_CONSENT = 17,      /**< The request carries the number of another press of the pedal. */
  ILK_VERDICT_BUDGET = 18,       /**< Homing has used up its travel or time for this press of the pedal. */
} ilk_verdict_t;

/** Codes of ilk_verdict_t. */
#define ILK_VERDICT_COUNT 19u

/** Why the system is LOCKED. */
typedef enum {
  ILK_CAUSE_NONE = 0,      /**< Not locked. */
  ILK_CAUSE_BOOT = 1,      /**< The kernel has just started. */
  ILK_CAUSE_ESTOP = 2,     /**< The E-stop was pulled, or its loop is broken. Value: the contact as read. */
  ILK_CAUSE_BUS = 3,       /**< No card answered, or transactions failed. Value: bad ticks in a row. */
  ILK_CAUSE_PEDAL = 4,     /**< The pedal's channels disagree. Value: contacts as read, normally open in bit 0, normally closed in bit 1. */
  ILK_CAUSE_INTEGRITY = 5, /**< Memory of the kernel was damaged. Value: the seal of the damaged state, or the CRC that was found over the configuration; 0 when one of its words that drive rests on had changed. */
  ILK_CAUSE_OVERRUN = 6,   /**< The control loop missed its deadline several times in a row. Value: misses in a row. */
  ILK_CAUSE_RUNAWAY = 7,   /**< A faulted axis goes on moving although its drive is zero; power was taken away. Value: its slot. */
} ilk_cause_t;

/** Codes of ilk_cause_t. */
#define ILK_CAUSE_COUNT 8u

/** Why an axis is FAULTED. */
typedef enum {
  ILK_FAULT_NONE = 0,           /**< No fault. */
  ILK_FAULT_STALL = 1,          /**< The axis was driven without making progress. Value: progress in counts. */
  ILK_FAULT_REVERSE = 2,        /**< The axis moved against its command. Value: counts against the command. */
  ILK_FAULT_DRIFT = 3,          /**< The axis moved although it was not driven. Value: counts from its mark. */
  ILK_FAULT_JUMP = 4,           /**< The counter jumped farther than the axis can move. Value: counts of the jump. */
  ILK_FAULT_CARD = 5,           /**< The card gave no valid frame several times in a row; the axis is no longer homed. Value: bad frames in a row. */
  ILK_FAULT_HOMING_TRAVEL = 6,  /**< Homing has used up its travel for this press of the pedal. Value: counts travelled. */
  ILK_FAULT_HOMING_TIMEOUT = 7, /**< Homing has used up its time for this press of the pedal. Value: homing phase. */
  ILK_FAULT_CARD_RESET = 8,     /**< The card was reset, so that its counter means another place. Value: heartbeats since the last valid frame. */
  ILK_FAULT_SWITCH = 9,         /**< The switch contradicts the position, or the two edges of homing differ. Value: counts from the place where it homed, or between the edges. */
  ILK_FAULT_INTEGRITY = 10,     /**< Memory of the kernel was damaged; nothing is known of the axis. */
} ilk_fault_t;

/** Codes of ilk_fault_t. */
#define ILK_FAULT_COUNT 11u

/** The conditions between a wish and a driven axis, in the order in which they are checked. The first that does not hold blocks. */
typedef enum {
  ILK_GATE_OPEN = 0,           /**< The axis is driven. */
  ILK_GATE_MODE = 1,           /**< The system is not in MOTION. */
  ILK_GATE_PEDAL = 2,          /**< Not every channel of the pedal reads pressed. */
  ILK_GATE_ESTOP = 3,          /**< The E-stop is active. */
  ILK_GATE_CARD = 4,           /**< The card's frame is not valid in this tick. */
  ILK_GATE_ENABLE = 5,         /**< The axis is not enabled, or is faulted. */
  ILK_GATE_LEASE = 6,          /**< No move holds the axis. */
  ILK_GATE_SETPOINT = 7,       /**< The axis is at its setpoint, or homing waits for rest. */
  ILK_GATE_HARD_LIMIT = 8,     /**< The axis stands at its switch and may only move away from it. */
  ILK_GATE_SOFT_LIMIT = 9,     /**< The axis is at its soft limit and may only move inward. */
  ILK_GATE_UNHOMED_TRAVEL = 10, /**< The axis is not homed and has used up its travel for this press of the pedal. */
  ILK_GATE_DRIVE = 11,         /**< The drive that was asked for is above its bound. */
  ILK_GATE_STALL = 12,         /**< The axis was driven as long as it may be without progress. */
} ilk_gate_t;

/** Codes of ilk_gate_t. */
#define ILK_GATE_COUNT 13u

/** The first rule that a refused configuration breaks. */
typedef enum {
  ILK_CONFIG_ERROR_NONE = 0,            /**< The configuration is valid. */
  ILK_CONFIG_ERROR_VERSION = 1,         /**< `version` is not the kernel's configuration version. */
  ILK_CONFIG_ERROR_SIZE = 2,            /**< `size_bytes` is not the size of the kernel's configuration. */
  ILK_CONFIG_ERROR_CRC = 3,             /**< `crc` does not match the words before it. */
  ILK_CONFIG_ERROR_PERIOD = 4,          /**< `period_us` is not from 125 to 2000. */
  ILK_CONFIG_ERROR_PEDAL_CHANNELS = 5,  /**< `pedal_channels` is not 1 or 2. */
  ILK_CONFIG_ERROR_APP_TIMEOUT = 6,     /**< `app_timeout_ticks` is below 2 or more than 150 ms. */
  ILK_CONFIG_ERROR_LEASE = 7,           /**< `lease_max_ticks` is below 2 or more than 150 ms. */
  ILK_CONFIG_ERROR_PEDAL_DEBOUNCE = 8,  /**< `pedal_debounce_ticks` is zero or more than 50 ms. */
  ILK_CONFIG_ERROR_PEDAL_DISAGREE = 9,  /**< `pedal_disagree_ticks` is zero or more than 50 ms. */
  ILK_CONFIG_ERROR_BAD_FRAMES = 10,     /**< `bad_frame_limit` is not from 1 to 5. */
  ILK_CONFIG_ERROR_OVERRUNS = 11,       /**< `overrun_limit` is not from 1 to 10. */
  ILK_CONFIG_ERROR_NO_AXIS = 12,        /**< No slot has a motor card. */
  ILK_CONFIG_ERROR_CARD = 13,           /**< `card` is not a known card type. */
  ILK_CONFIG_ERROR_FLAG = 14,           /**< `required`, `motor_direction` or `direction_correction` is not 0 or 1. */
  ILK_CONFIG_ERROR_EMPTY_SLOT = 15,     /**< A slot without a motor card has a field that is not zero, `card` and `required` apart; an empty slot is required. */
  ILK_CONFIG_ERROR_LIMIT_SIDE = 16,     /**< `limit_side` is not NONE, LOWER or UPPER. */
  ILK_CONFIG_ERROR_SOFT_LIMITS = 17,    /**< `min_counts` is not below `max_counts`, or a limit is beyond 2^30 counts. */
  ILK_CONFIG_ERROR_HOME_OFFSET = 18,    /**< `home_offset_counts` is outside the soft limits, or leaves no room between where the switch is sure to be open and the coast before the other limit. */
  ILK_CONFIG_ERROR_COAST = 19,          /**< `coast_counts` is zero, shorter than full speed in the latency of the loop, or min + coast is not below max - coast. */
  ILK_CONFIG_ERROR_DEADBAND = 20,       /**< `deadband_counts` is zero or at least half of the range. */
  ILK_CONFIG_ERROR_MAX_DRIVE = 21,      /**< `max_drive` is zero or more than the card's word can carry. */
  ILK_CONFIG_ERROR_UNHOMED_DRIVE = 22,  /**< `unhomed_max_drive` is not above `dead_zone_drive`, or more than a tenth of the way from there to `max_drive`; or `dead_zone_drive` is more than a fifth of `max_drive`. */
  ILK_CONFIG_ERROR_AMPLITUDE = 23,      /**< `max_amplitude` is not from 1 to 255 on a HIGH_FREQUENCY card, or not zero on another; `home_amplitude` exceeds it, or is not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_UNHOMED_TRAVEL = 24, /**< `unhomed_travel_counts` is not above `coast_counts`, or more than a tenth of the range. */
  ILK_CONFIG_ERROR_HOME_DRIVE = 25,     /**< `home_drive` is not above `dead_zone_drive`, or more than `unhomed_max_drive`; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_HOME_TRAVEL = 26,    /**< `home_travel_counts` does not cover the way from either stop with both back-offs and coast, or is more than four times the range; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_HOME_CLEAR = 27,     /**< `home_clear_counts` does not cover tolerance, hysteresis and coast, or the progress that a stall asks for, or is more than a tenth of the range; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_REST = 28,           /**< `rest_ticks` is not above the latency of the loop, shorter than the debounce of the switch, or more than 1000 ms. */
  ILK_CONFIG_ERROR_HOME_TIMEOUT = 29,   /**< `home_timeout_ticks` does not cover the way of homing at its speeds, or is more than ten minutes; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_STALL = 30,          /**< `stall_ticks` is more than 500 ms, or ends before `stall_min_counts`, backlash and noise are travelled at the slowest drive with the latency of the loop, or at full speed after a reversal; or these are not above `noise_counts`. */
  ILK_CONFIG_ERROR_REVERSE = 31,        /**< `reverse_counts` does not cover coast, backlash and noise, or is more than a tenth of the range. */
  ILK_CONFIG_ERROR_DRIFT = 32,          /**< `drift_counts` does not cover coast, backlash and noise, or is more than a tenth of the range. */
  ILK_CONFIG_ERROR_STALL_EFFORT = 33,   /**< `stall_effort_ticks` is more than 200 ms, or too short for five times the coast, backlash and noise at full speed; or zero on an axis that is fast enough for it. */
  ILK_CONFIG_ERROR_MAX_DELTA = 34,      /**< `max_delta_counts` is below full speed and noise in a tick, or more than half of the range. */
  ILK_CONFIG_ERROR_SPEED = 35,          /**< A speed is zero or too high, or a slower drive of homing has a higher one; not zero for homing on an axis without a switch. */
  ILK_CONFIG_ERROR_HOME_TOLERANCE = 36, /**< `home_tolerance_counts` does not cover what homing travels in the debounce time, and noise, or is more than a tenth of the range; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_HOME_SLOW = 37,      /**< `home_slow_drive` is not above `dead_zone_drive`, or more than `home_drive`; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_POWER_UP = 38,       /**< `power_up_ticks` is zero or more than 5000 ms. */
  ILK_CONFIG_ERROR_SWITCH_DEBOUNCE = 39, /**< `switch_debounce_ticks` is below 2 or more than 20 ms. */
  ILK_CONFIG_ERROR_HYSTERESIS = 40,     /**< `switch_hysteresis_counts` is more than a tenth of the range; not zero on an axis without a switch. */
  ILK_CONFIG_ERROR_NOISE = 41,          /**< `noise_counts` or `backlash_counts` is more than a tenth of the range. */
} ilk_config_error_t;

/** Codes of ilk_config_error_t. */
#define ILK_CONFIG_ERROR_COUNT 42u

/** Kinds of motor cards. */
typedef enum {
  ILK_CARD_NONE = 0,           /**< Empty slot. */
  ILK_CARD_PWM = 1,            /**< External driver, PWM: speed and direction in wave 1. */
  ILK_CARD_NON_PWM = 2,        /**< External driver without PWM: speed, direction and enable bit in wave 1. */
  ILK_CARD_ANALOG = 3,         /**< External driver with an analog input: signed level in the analog word. */
  ILK_CARD_HIGH_FREQUENCY = 4, /**< Piezo drive by two waves: lower frequency is faster. */
  ILK_CARD_SENSOR = 5,         /**< No motor; analog inputs only. */
} ilk_card_t;

/** Codes of ilk_card_t. */
#define ILK_CARD_COUNT 6u

/** The end of the axis at which its switch sits. */
typedef enum {
  ILK_LIMIT_NONE = 0,  /**< The axis has no switch. */
  ILK_LIMIT_LOWER = 1, /**< The switch sits at the lower end; it blocks decreasing motion. */
  ILK_LIMIT_UPPER = 2, /**< The switch sits at the upper end; it blocks increasing motion. */
} ilk_limit_side_t;

/** Codes of ilk_limit_side_t. */
#define ILK_LIMIT_COUNT 3u

/** Sense of motion, as the position counts. */
typedef enum {
  ILK_DIRECTION_NONE = 0,       /**< No motion. */
  ILK_DIRECTION_INCREASING = 1, /**< Towards larger positions. */
  ILK_DIRECTION_DECREASING = 2, /**< Towards smaller positions. */
} ilk_direction_t;

/** Codes of ilk_direction_t. */
#define ILK_DIRECTION_COUNT 3u

/** Phases of homing. */
typedef enum {
  ILK_HOMING_NONE = 0,     /**< Not homing. */
  ILK_HOMING_LOOK = 1,     /**< Undriven, until the switch has read one way for the debounce time. */
  ILK_HOMING_LEAVE = 2,    /**< The axis began on its switch and moves away until the switch is open and the axis clear. */
  ILK_HOMING_SEEK = 3,     /**< Moves towards the switch. */
  ILK_HOMING_BACK_OFF = 4, /**< Moves away from the first edge until the switch is open and the axis clear. */
  ILK_HOMING_APPROACH = 5, /**< Moves towards the switch again, slowly. */
  ILK_HOMING_REST = 6,     /**< At the second edge; waits until the axis is at rest. */
} ilk_homing_phase_t;

/** Codes of ilk_homing_phase_t. */
#define ILK_HOMING_COUNT 7u

/** How the position of an axis came to be known. */
typedef enum {
  ILK_HOMED_NOT = 0,       /**< The position has no reference. */
  ILK_HOMED_BY_SWITCH = 1, /**< By HOME, at the switch. */
  ILK_HOMED_BY_HAND = 2,   /**< By SET_HOME, a person's word. */
} ilk_homed_t;

/** Codes of ilk_homed_t. */
#define ILK_HOMED_COUNT 3u

/** What the pedal's channels say together. */
typedef enum {
  ILK_PEDAL_RELEASED = 0, /**< Every channel reads released. */
  ILK_PEDAL_PRESSED = 1,  /**< Every channel reads pressed. */
  ILK_PEDAL_DISAGREE = 2, /**< The channels do not agree, or a contact was not read validly. */
} ilk_pedal_t;

/** Codes of ilk_pedal_t. */
#define ILK_PEDAL_COUNT 3u

/** Lamps of the front panel. */
typedef enum {
  ILK_LAMP_PEDAL = 0,      /**< Green while MOTION holds, red while the E-stop is active, off otherwise. */
  ILK_LAMP_NETWORK = 1,    /**< Green while the app is alive, red otherwise. */
  ILK_LAMP_CONTROLLER = 2, /**< Green in READY and MOTION, red while LOCKED. */
  ILK_LAMP_STALL = 3,      /**< Purple while an axis has a STALL, amber while one has another fault. */
} ilk_lamp_t;

/** Codes of ilk_lamp_t. */
#define ILK_LAMP_COUNT 4u

/** Colours of a lamp. */
typedef enum {
  ILK_COLOUR_OFF = 0,    /**< Dark. */
  ILK_COLOUR_GREEN = 1,  /**< Green. */
  ILK_COLOUR_RED = 2,    /**< Red. */
  ILK_COLOUR_AMBER = 3,  /**< Amber. */
  ILK_COLOUR_PURPLE = 4, /**< Purple. */
} ilk_colour_t;

/** Codes of ilk_colour_t. */
#define ILK_COLOUR_COUNT 5u

#endif
