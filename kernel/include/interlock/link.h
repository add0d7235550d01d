/**
 * @file
 * The link between kernel and app: two sealed memory regions handed over a Unix socket.
 *
 * The kernel process creates both regions for each attachment and passes their descriptors with
 * SCM_RIGHTS in one `ilk_link_hello_t`. The app can map the kernel's region for reading only: it is
 * sealed against future writable mappings. The app's region is the only memory that the app writes;
 * the kernel maps it read-only and treats each byte of it as hostile. The app maps it once, and says so by
 * sending ILK_LINK_MAGIC, one word, on the socket: then the kernel seals it too, so that no page can be taken
 * out of it, and begins to serve the app.
 *
 * Every word is accessed with atomic builtins: relaxed for data, acquire/release for the counters that
 * publish them.
 *
 * One app is attached at a time; a further connection is closed without a hello. Each attachment starts
 * with fresh regions, generation + 1, and all counters at 0. Closing the socket, or sending anything else on
 * it, ends the attachment.
 *
 * Waiting for the next snapshot: `FUTEX_WAIT` (not `FUTEX_PRIVATE_FLAG`) on `snapshot_lock` works on the
 * read-only mapping. The kernel wakes at most ILK_LINK_WAITERS waiters after each snapshot, so that
 * the time of its tick does not depend on how many there are; wait with a timeout.
 */
#ifndef INTERLOCK_LINK_H
#define INTERLOCK_LINK_H

#include "interlock/types.h"

/** First word of both regions and of the hello. */
#define ILK_LINK_MAGIC 0x4c4b4c49u /* "ILKL" */
/** Of the format; another one is refused. */
#define ILK_LINK_VERSION 2u

/** Requests in flight. A power of two; four ticks' worth. */
#define ILK_LINK_REQUESTS 64u
/** Events kept for a slow app. A power of two. */
#define ILK_LINK_EVENTS 1024u
/** Threads of the app that can wait for a snapshot at the same time. */
#define ILK_LINK_WAITERS 4u
/** Simulated clock: ticks that the kernel runs ahead of `seen_tick` at most, while an app is attached. */
#define ILK_LINK_TICKS_AHEAD 10u
/** Buckets of a time histogram: bucket n counts durations from 2^n to 2^(n+1) nanoseconds. */
#define ILK_LINK_BUCKETS 32u

/** Parts of a tick whose time is measured. */
typedef enum {
  ILK_PHASE_WAKE = 0,    /**< from the deadline to running code (real clock only) */
  ILK_PHASE_BUS = 1,     /**< bus transaction */
  ILK_PHASE_STEP = 2,    /**< ring reader and `ilk_step` */
  ILK_PHASE_PUBLISH = 3, /**< snapshot and events */
  ILK_PHASE_COUNT = 4    /**< how many there are */
} ilk_phase_t;

/** Real-time measures; bit n of `granted` is set when the executive got it. */
typedef enum {
  ILK_RT_FIFO = 0,   /**< SCHED_FIFO priority */
  ILK_RT_MLOCK = 1,  /**< all memory locked */
  ILK_RT_PINNED = 2, /**< runs on the core asked for */
  ILK_RT_TIMER = 3   /**< timer slack of one nanosecond */
} ilk_rt_measure_t;

/** How often each part of a tick took how long. */
typedef struct {
  uint32_t bucket[ILK_PHASE_COUNT][ILK_LINK_BUCKETS]; /**< counts, saturating */
  uint32_t max_ns[ILK_PHASE_COUNT];                   /**< largest seen, saturating */
} ilk_timing_t;

/** How long simulated time waited for the host: all of it since the start, no tick is made up for later. */
typedef struct {
  uint32_t second_us; /**< in the newest second of wall time that is over, saturating */
  uint32_t worst_us;  /**< longest wait, saturating */
  uint32_t total_ms;  /**< since the start, saturating */
} ilk_lateness_t;

/** What the kernel shows of itself, whole, once a tick. */
typedef struct {
  uint32_t clock;            /**< ilk_clock_t of sim_bus.h */
  uint32_t simulated;        /**< 1: the bus is a simulator */
  uint32_t degraded;         /**< 1: real clock without the real-time measures it needs */
  uint32_t granted;          /**< bits by ilk_rt_measure_t */
  uint32_t period_us;        /**< control period */
  uint32_t config_crc;       /**< of the configuration that runs */
  uint32_t requests_dropped; /**< records skipped because the ring was overrun, saturating */
  uint32_t overruns;         /**< ticks that began more than a period late (real clock), saturating; counted
                                  also when degraded, while `state.overruns` counts those that can lock */
  uint32_t pace_ns;          /**< simulated clock: wall time from tick to tick; 0: as fast as possible */
  ilk_lateness_t lateness;   /**< of the host; 0 unless the simulated clock has a pace */
  ilk_state_t state;         /**< all of it, sealed */
  ilk_inputs_t inputs;       /**< of this tick */
  ilk_command_t command[ILK_SLOTS]; /**< what goes to each card */
  uint32_t gate[ILK_SLOTS];         /**< ilk_gate_t: the first that blocks each axis */
  uint32_t power;                   /**< 1: the amplifiers have power */
  uint32_t lamp[ILK_LAMP_COUNT];    /**< ilk_colour_t of each lamp */
  ilk_timing_t timing;              /**< how long each part of a tick took */
} ilk_snapshot_t;

/** Kinds of events. */
typedef enum {
  ILK_EVENT_VERDICT = 1, /**< a request was judged: value = sequence, kind, axis, verdict */
  ILK_EVENT_MODE = 2,    /**< the mode changed: value = from, to, cause, cause_value */
  ILK_EVENT_FAULT = 3,   /**< an axis faulted: value = slot, fault, fault_value, 0 */
  ILK_EVENT_AXIS = 4     /**< an axis changed state or `homed`: value = slot, from, to, homed */
} ilk_event_kind_t;

/** One thing that happened. */
typedef struct {
  uint32_t number;   /**< 1 for the first event of the attachment; written last, 0 while being written */
  uint32_t kind;     /**< ilk_event_kind_t */
  uint32_t tick;     /**< in which it happened */
  uint32_t value[4]; /**< meaning by kind */
} ilk_event_t;

/** Written by the kernel, readable by the app. */
typedef struct {
  uint32_t magic;          /**< ILK_LINK_MAGIC */
  uint32_t version;        /**< ILK_LINK_VERSION */
  uint32_t layout_hash;    /**< `ilk_link_layout_hash` */
  uint32_t generation;     /**< counts attachments */
  uint32_t request_tail;   /**< requests consumed; the app may write up to ILK_LINK_REQUESTS beyond it */
  uint32_t event_head;     /**< events written, wrapping */
  uint32_t snapshot_lock;  /**< seqlock: odd while the snapshot is being written, 0 until the first one;
                                also the futex to wait on */
  ilk_snapshot_t snapshot; /**< whole while `snapshot_lock` is even and unchanged */
  ilk_event_t event[ILK_LINK_EVENTS]; /**< ring, by number */
} ilk_link_kernel_region_t;

/** Written by the app, readable by the kernel. */
typedef struct {
  uint32_t magic;        /**< ILK_LINK_MAGIC */
  uint32_t request_head; /**< requests written, wrapping */
  uint32_t seen_tick;    /**< newest tick whose snapshot the app has handled; paces the simulated clock.
                              Wake its futex after writing: a kernel that waits for it then goes on at
                              once, else within a millisecond. An app that keeps the kernel waiting for
                              2 s of wall time is no longer waited for until it has caught up; meanwhile
                              simulated time passes no faster than the wall's. The real clock never waits */
  ilk_request_t request[ILK_LINK_REQUESTS]; /**< ring, by count */
} ilk_link_app_region_t;

/** First and only message of the kernel on the socket, with both descriptors: kernel region, then app region.
 */
typedef struct {
  uint32_t magic;               /**< ILK_LINK_MAGIC */
  uint32_t version;             /**< ILK_LINK_VERSION */
  uint32_t layout_hash;         /**< `ilk_link_layout_hash` of the kernel's build */
  uint32_t generation;          /**< counts attachments */
  uint32_t kernel_region_bytes; /**< size of the first descriptor's region */
  uint32_t app_region_bytes;    /**< size of the second descriptor's region */
} ilk_link_hello_t;

#ifdef __cplusplus
extern "C" {
#endif

/** CRC-32 over the sizes and offsets of everything shared; both sides must agree on it. */
uint32_t ilk_link_layout_hash(void);

#ifdef __cplusplus
}
#endif

#endif
