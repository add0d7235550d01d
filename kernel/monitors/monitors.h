/**
 * @file
 * One monitor per property of the kernel (docs: kernel.md, edition 2), over what can be seen from outside.
 *
 * A monitor reads the configuration, the inputs, the requests with their verdicts, the outputs, the published
 * snapshot before and after the tick, and the ghost: what the judge itself remembers. It never reads a
 * counter or a mark of the kernel. The code is integer only, saturates, has bounded loops and no heap.
 *
 * One tick:
 *   ghost_observe(&ghost, &tick);   what the inputs of this tick say
 *   ghost_requests(&ghost, &tick);  what the accepted requests of this tick change
 *   judge_...(&ghost, &tick);       every monitor
 *   ghost_settle(&ghost, &tick);    what the drive of this tick means for the next
 */
#ifndef JUDGE_MONITORS_H
#define JUDGE_MONITORS_H

#include <stdbool.h>
#include <stdint.h>

#include "interlock/kernel.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the kernel publishes of one axis after a tick. */
typedef struct {
  uint32_t state;
  uint32_t fault;
  uint32_t homed;
  int32_t position;
} ilk_axis_view_t;

/** What the kernel publishes after a tick. */
typedef struct {
  uint32_t mode;
  uint32_t cause;
  uint32_t consent;
  ilk_axis_view_t axis[ILK_SLOTS];
} ilk_view_t;

/** One tick as seen from outside. */
typedef struct {
  const ilk_config_t* config;
  bool config_valid;
  const ilk_inputs_t* in;
  const ilk_request_t* requests;
  uint32_t count;
  const ilk_outputs_t* out;
  const ilk_view_t* before;
  const ilk_view_t* after;
} ilk_tick_t;

/** Readings that lie within a bound of each other. */
typedef struct {
  uint32_t origin;
  int32_t low;
  int32_t high;
  uint32_t ticks;
  uint32_t low_age;
  uint32_t high_age;
  uint32_t apart_age; /**< ticks since the older of two readings that were too far apart */
  uint32_t steady;    /**< ticks since the run began or became wider */
} ilk_still_t;

#define ILK_JUDGE_EDGES 4u

/** Edges of the switch since HOME that the order of P17 allows, newest first; older ones are forgotten. */
typedef struct {
  uint32_t first[ILK_JUDGE_EDGES]; /**< each as e1 */
  bool slow[ILK_JUDGE_EDGES]; /**< the axis was clear of it, and not driven above `home_slow_drive` since */
  uint32_t second[ILK_JUDGE_EDGES]; /**< each as e2: an e1 within the tolerance came before it */
  uint32_t firsts;
  uint32_t seconds;
} ilk_edges_t;

/** What the judge remembers of one slot. */
typedef struct {
  /* the frame of this tick */
  bool valid;         /**< this tick's frame is valid */
  bool first;         /**< it is the first after start or after a lost card */
  bool jump;          /**< it lies farther from the last reading than the axis can move */
  bool reset;         /**< it says for sure that the card was reset */
  bool seen;          /**< a last valid frame exists */
  bool lost;          /**< the card is lost */
  uint32_t bad_run;   /**< bad frames in a row */
  uint32_t heartbeat; /**< of the last valid frame */
  uint32_t status;    /**< of the last valid frame */
  uint32_t raw;       /**< counter of the last valid frame */
  uint32_t periods;   /**< loop periods since it */
  bool triggered;     /**< its switch reading */
  uint32_t run;       /**< valid readings in a row that say so */
  uint32_t run_raw;   /**< counter at the first of them */
  /* rest and drift */
  ilk_still_t rest;       /**< undriven, valid, within noise */
  uint32_t quiet;         /**< ticks in a row that were undriven and had a valid frame */
  uint32_t since_disable; /**< ticks since the last DISABLE */
  ilk_still_t calm;       /**< valid, within drift_counts */
  bool drift_known;
  uint32_t drift_mark;
  uint32_t fault_mark; /**< reading of the fault, of the last jump, reset or first frame, or where a runaway
                          rested */
  int32_t
      mark_low; /**< between these, from there, the mark lies: where a runaway came to rest is known so far */
  int32_t mark_high;
  int32_t delta;  /**< motion that the last valid frame showed */
  bool ran;       /**< a runaway, and not at rest for sure since */
  bool resting;   /**< and perhaps at rest since: the mark is a reading from then on */
  bool maybe_ran; /**< beyond drift_counts of a place where the mark may be, and not at rest for sure since */
  bool maybe_runaway;  /**< seen in this tick: beyond drift_counts of a place where the mark may be */
  bool runaway;        /**< seen in this tick: FAULTED and beyond drift_counts of its mark, or jumped on */
  bool drifted;        /**< seen in this tick, to be judged */
  bool reversed;       /**< seen in this tick, to be judged */
  bool maybe_reversed; /**< the same, but frames were lost since the drive */
  int32_t distance;    /**< counts that the rule of this tick measured */
  bool driven;         /**< in the last tick */
  uint32_t direction;  /**< commanded in the last driven tick */
  uint32_t reverse_direction;
  uint32_t reverse_mark;
  /* stall */
  uint32_t stall_direction;
  uint32_t stall_mark;
  uint32_t effort_mark;
  uint32_t stall_ticks;
  uint64_t effort;
  bool stalled; /**< a bound was reached before this tick's drive */
  /* travel while not homed */
  bool path_known;
  uint32_t path;
  bool path_homing;
  uint32_t move_travel;
  uint32_t homing_travel;
  uint32_t homing_ticks;
  /* orders */
  uint32_t lease; /**< ticks that the MOVE still allows, this one included */
  int32_t setpoint;
  uint32_t order_drive;
  uint32_t order_consent;
  uint32_t state; /**< as it should be while requests are judged, afterwards at the end of the tick */
  uint32_t homed; /**< as it should be */
  bool cleared;   /**< CLEAR_FAULT accepted in this tick */
  bool set_home;  /**< SET_HOME accepted in this tick */
  bool restored;  /**< RESTORE accepted in this tick */
  int32_t restored_to;
  /* reference */
  bool seeks;            /**< HOME was accepted, and nothing ended it */
  uint32_t home_run;     /**< valid readings in a row since HOME that say the same */
  uint32_t home_run_raw; /**< counter at the first of them */
  bool home_open;        /**< open for the debounce time since the last edge */
  ilk_edges_t edges;
  uint32_t reference; /**< counter at the edge where it homed */
  bool just_homed;
  bool position_known;
  int32_t position;     /**< as it should be published */
  uint32_t implausible; /**< valid readings in a row in which the switch contradicts the position */
} ilk_ghost_slot_t;

/** What the judge remembers of the whole. */
typedef struct {
  uint32_t tick;
  uint32_t frames_sent;
  uint32_t link_generation;
  uint32_t last_sequence;
  uint32_t holder;
  uint32_t app_age;
  bool app_alive;
  uint32_t pedal; /**< ilk_pedal_t */
  bool estop;
  uint32_t pressed_ticks;
  uint32_t released_ticks;
  uint32_t disagree_ticks;
  uint32_t bus_bad_ticks;
  uint32_t missed_in_row; /**< periods missed, summed over ticks in a row that missed some */
  uint32_t missed_ticks;  /**< ticks in a row that missed some */
  uint32_t powered_ticks; /**< ticks before this one with power on, in a row */
  uint32_t armed_ticks;   /**< released in READY with the app alive since the last event that disarms */
  bool armed;             /**< those reached the debounce time */
  bool armed_weakly;      /**< the pedal had been released for the debounce time at a tick since that event */
  bool bus_ok_now;
  bool bus_lost;
  bool required_lost;
  bool runaway;   /**< an axis ran away in this tick */
  bool new_fault; /**< by the published states */
  uint32_t mode;  /**< as it should be, phase by phase */
  bool mode_sure; /**< the text decides the mode */
  bool entered;   /**< MOTION was entered in this tick */
  bool runaway_unsure;
  bool calm_unsure;       /**< of a DISABLED axis too little was seen to tell */
  bool drift_of_disabled; /**< a DISABLED axis moved in the last rest_ticks */
  uint32_t last_consent;  /**< of the press before */
  bool reset_accepted;
  bool stop_accepted;
  bool holder_changed;
  uint32_t weak_entries; /**< how often MOTION began though only weakly armed */
  uint32_t choice[4]; /**< what the kernel does where the text is open: locks by periods missed, or does not;
                         locks when the channels disagree for just pedal_disagree_ticks, or does not */
  uint32_t order_error; /**< 1 + index of the first request whose verdict contradicts the text */
  uint32_t expected;    /**< verdict that the text demands of it */
  bool consent_error;   /**< a MOVE or HOME was accepted with a number that is not that of this press */
  ilk_ghost_slot_t slot[ILK_SLOTS];
} ilk_ghost_t;

/** Holds when `clause` is NULL; otherwise the first clause that is violated, with its values. */
typedef struct {
  const char* clause;
  uint32_t slot;
  int64_t found;
  int64_t bound;
} ilk_judgement_t;

/** Before the first tick of a kernel. */
void ghost_init(ilk_ghost_t* ghost);
/**
 * In the middle of a run: what the state between two ticks tells, and of the rest nothing. A verdict that
 * what came before decides passes, whichever it is, until the ghost has seen as much itself.
 */
void ghost_adopt(ilk_ghost_t* ghost, const ilk_config_t* config, const ilk_state_t* state);
void ghost_observe(ilk_ghost_t* ghost, const ilk_tick_t* tick);
void ghost_requests(ilk_ghost_t* ghost, const ilk_tick_t* tick);
void ghost_settle(ilk_ghost_t* ghost, const ilk_tick_t* tick);

ilk_judgement_t judge_P1(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P2(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P3(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P4(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P5(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P6(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P7(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P8(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P9(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P10(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P11(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P12(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P13(const ilk_ghost_t* ghost, const ilk_tick_t* tick);
ilk_judgement_t judge_P17(const ilk_ghost_t* ghost, const ilk_tick_t* tick);

/* More than the properties ask: rules of the text that can be seen from outside. */
ilk_judgement_t judge_wire(const ilk_ghost_t* ghost,
                           const ilk_tick_t* tick); /**< frames say what the commands say */
ilk_judgement_t judge_mode(const ilk_ghost_t* ghost, const ilk_tick_t* tick); /**< the table of modes */
ilk_judgement_t judge_rows(const ilk_ghost_t* ghost, const ilk_tick_t* tick); /**< the table of requests */
ilk_judgement_t judge_states(const ilk_ghost_t* ghost,
                             const ilk_tick_t* tick); /**< states, homed, lost cards, switch */

/** Rules of "A valid configuration can work" that the text states in numbers; the first that a configuration
 * breaks. */
ilk_judgement_t judge_config(const ilk_config_t* config);

typedef ilk_judgement_t (*ilk_judge_t)(const ilk_ghost_t*, const ilk_tick_t*);
#define JUDGE_COUNT 18u
extern const ilk_judge_t ilk_judges[JUDGE_COUNT];
extern const char* const ilk_judge_names[JUDGE_COUNT];

/** True motion `to - from` in the sense of the position, modulo 2^32. */
int32_t judge_counts(const ilk_axis_config_t* config, uint32_t to, uint32_t from);

/** A card's outgoing frame is at zero drive: words 2, 3, 4, 5, 6 and 14. */
bool judge_is_zero_drive(const uint32_t* frame);

/** What the snapshot publishes of a state. */
void judge_view(const ilk_state_t* state, ilk_view_t* view);

#ifdef __cplusplus
}
#endif

#endif
