/**
 * @file
 * Whole ticks against the monitors: the objects of a proof, and what ties the judge's memory to the kernel's.
 *
 * A tick is cut before its requests (answer_requests of step.c):
 *   A  from R at its start, phases 1 to 5 lead to M;
 *   B  one request and its verdict keep M, and lead to a state that may_follow;
 *   C  from M, phases 7 and 8 satisfy the claims and lead to R.
 * By induction over requests and ticks, the claims hold in every tick. What the snapshot will say after the
 * tick is read by the judge in A and B already: it is that of any state that may follow by requests.
 */
#ifndef INTERLOCK_TICK_H
#define INTERLOCK_TICK_H

#include <stdbool.h>

#include "interlock/kernel.h"

/* Parts of the relations R and M, a bit each. */
#define FRAMES 0x1u   /**< the frame that was last seen */
#define SYSTEM 0x2u   /**< pedal, app, bus, power, sequence */
#define MODE 0x4u     /**< modes, states and consent of the kernel by themselves */
#define ORDERS 0x8u   /**< lease, drive and consent of what an axis was told */
#define PEDAL 0x10u   /**< arming and press */
#define PATH 0x20u    /**< travel and time of this press */
#define MARKS 0x40u   /**< what reverse motion and drift are measured from */
#define REST 0x80u    /**< rest */
#define STALL 0x200u  /**< marks and sums of progress */
#define EDGES 0x400u  /**< edges of the switch since HOME */
#define NUMBER 0x800u /**< MOTION has a number */
#define PRESS 0x1000u /**< whose number is not that of the press before */

/** What must be possible, so that no claim holds for want of a case. */
#ifdef ILK_COVER
#define GOAL(condition) __CPROVER_cover(condition)
#else
#define GOAL(condition) ((void)0)
#endif

#define HOLDS_IF(condition, consequence) (!(condition) || (consequence))

extern ilk_config_t config;
extern ilk_state_t state;
extern ilk_inputs_t in;
extern ilk_inputs_t twin_in; /**< of a robot that differs in other axes (P18) */
extern ilk_outputs_t out;
extern ilk_request_t requests[1];

/** What `ilk_config_validate` guarantees, as far as the proofs need it. */
bool config_is_valid(void);

/** R at the end of a tick, or M between its requests: shown, or taken for granted. */
void relate(bool shown, bool middle, unsigned parts);

/** What any number of requests can make of a state, as far as the snapshot tells: reflexive and transitive.
 */
bool may_follow(const ilk_state_t* from, const ilk_state_t* to);

/** Nothing but counters has changed. */
bool is_inert(const ilk_state_t* from, const ilk_state_t* to);

/** Zero drive on the wire. */
bool is_still(const uint32_t* frame);

/** Whether the checksum of a frame of `in` is right: arbitrary, but the same whoever asks. */
bool stand_in_checksum(const uint32_t* frame);
bool right_checksum(const uint32_t* frame);

/** The number of the press that begins in this tick, and whether it is that of the press before, in another
 * tick. */
uint32_t number_of(uint32_t boot_nonce, uint32_t tick);
bool is_number_of_another(uint32_t boot_nonce, uint32_t tick, uint32_t number);

/** What the steps that take PRESS for granted assume of each tick besides, and no others. */
bool may_be_this_tick(void);

/** The snapshots of this tick. */
void see_before(void);
void see_after(const ilk_state_t* end);
bool after_is_seen(void);

/** The judge's half of A, B and C. */
void begin_judging(void);
void judge_inputs(void);
void claim_home(void); /**< P17 */
void judge_request(void);
void judge_drive(void);
void some_memory(void);
void first_memory(void);

#endif
