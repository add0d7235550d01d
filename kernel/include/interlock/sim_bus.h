/**
 * @file
 * The simulated bus: one Unix seqpacket record each way per tick between kernel and plant.
 *
 * The kernel connects and sends one `ilk_sim_hello_t`; the plant answers with the same record, its own
 * values filled in, or closes. From then on the kernel sends one `ilk_sim_exchange_t` a tick and the plant
 * answers each with one `ilk_sim_reply_t`. As on the real bus the exchange is full duplex: a reply tells
 * what the card latched before it saw the frame of the same exchange. All words are native-endian.
 * Each exchange is answered, also one that fails as a whole: its reply has ILK_SIM_FAILED for magic, the
 * exchange's tick, and nothing else that counts.
 */
#ifndef INTERLOCK_SIM_BUS_H
#define INTERLOCK_SIM_BUS_H

#include "interlock/types.h"

/** First word of each message. */
#define ILK_SIM_MAGIC 0x534b4c49u /* "ILKS" */
/** First word of a reply that says that the whole transaction failed. */
#define ILK_SIM_FAILED 0u
/** Of the format; another one is refused. */
#define ILK_SIM_VERSION 2u

/** Who decides how plant time passes. */
typedef enum {
  ILK_CLOCK_REAL = 0, /**< plant time is the wall clock; card watchdogs run between exchanges, too */
  ILK_CLOCK_SIM = 1   /**< plant time advances by one period with each exchange, and only then */
} ilk_clock_t;

/** First message of the kernel. */
typedef struct {
  uint32_t magic;       /**< ILK_SIM_MAGIC */
  uint32_t version;     /**< ILK_SIM_VERSION */
  uint32_t frame_words; /**< ILK_FRAME_WORDS of the sender */
  uint32_t period_us;   /**< control period */
  uint32_t clock;       /**< ilk_clock_t */
  uint32_t config_crc;  /**< of the kernel's configuration, for the record */
} ilk_sim_hello_t;

/** What goes to the cards in one tick. */
typedef struct {
  uint32_t magic;                             /**< ILK_SIM_MAGIC */
  uint32_t tick;                              /**< kernel tick, for the record */
  uint32_t power;                             /**< 1: the amplifiers have power */
  uint32_t lamp[ILK_LAMP_COUNT];              /**< ilk_colour_t of each lamp */
  uint32_t frame[ILK_SLOTS][ILK_FRAME_WORDS]; /**< to the card of each slot */
} ilk_sim_exchange_t;

/** What the cards and contacts answer. */
typedef struct {
  uint32_t magic;                             /**< ILK_SIM_MAGIC, or ILK_SIM_FAILED */
  uint32_t tick;                              /**< of the exchange that this answers */
  uint32_t frames_received;                   /**< bit n: slot n answered */
  uint32_t pedal_no_closed;                   /**< normally open contact: 1 closed */
  uint32_t pedal_nc_closed;                   /**< normally closed contact: 1 closed */
  uint32_t estop_loop_closed;                 /**< 1 while nobody pulls it */
  uint32_t frame[ILK_SLOTS][ILK_FRAME_WORDS]; /**< from the card of each slot */
} ilk_sim_reply_t;

#endif
