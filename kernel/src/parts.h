/**
 * @file
 * What the parts of the kernel offer each other, file by file.
 */
#ifndef ILK_PARTS_H
#define ILK_PARTS_H

#include "arith.h"
#include "interlock/kernel.h"

/* --- config.c: facts that follow from the configuration alone ---------------------------------- */

/** Eight bits of the frame's word. */
#define ILK_AMPLITUDE_MAX 255u

/** Largest drive that the card's word can carry; 0 for a slot without a motor. */
uint32_t ilk_card_max_drive(uint32_t card);

/* --- crc32.c: CRC-32 of structures of 32-bit words, each least significant byte first ---------- */

#define ILK_CRC32_START 0xffffffffu

/** Remainders of each byte followed by n zero bytes, n the row. */
extern const uint32_t ilk_crc32_table[4][256];

/** The word at these four bytes, as the machines that this runs on store it: lowest byte first. */
static inline uint32_t word_at(const uint8_t bytes[4]) {
  return (uint32_t)bytes[0] | ((uint32_t)bytes[1] << 8u) | ((uint32_t)bytes[2] << 16u) |
         ((uint32_t)bytes[3] << 24u);
}

/** The running CRC after one more word. */
static inline uint32_t ilk_crc32_word(uint32_t crc, uint32_t word) {
  const uint32_t mixed = crc ^ word;
  return ilk_crc32_table[3][mixed & 0xffu] ^ ilk_crc32_table[2][(mixed >> 8) & 0xffu] ^
         ilk_crc32_table[1][(mixed >> 16) & 0xffu] ^ ilk_crc32_table[0][mixed >> 24];
}

/** The running CRC after `words` more words. Start with ILK_CRC32_START; what is stored is XORed with it. */
uint32_t ilk_crc32_words(uint32_t crc, const uint8_t bytes[], uint32_t words);

/* --- frame.c: card frames, spec/frames.md (P16) ------------------------------------------------ */

/** Bit of `card_status`: the card was reset since it started. */
#define ILK_STATUS_WAS_RESET 8u

/** What one incoming frame says. Meaningless unless `intact`. */
typedef struct {
  bool intact; /**< start word and checksum are right */
  bool switch_triggered;
  uint32_t raw;
  uint32_t heartbeat;
  uint32_t card_time_us;
  uint32_t tick_echo;
  uint32_t card_status;
} ilk_reading_t;

/** Phase 2: reads an incoming frame. */
ilk_reading_t ilk_frame_unpack(const uint32_t frame[ILK_FRAME_WORDS]);

/** Phase 8: writes all words of an outgoing frame. No direction or no drive is packed as zero drive. */
void ilk_frame_pack(const ilk_axis_config_t *config, const ilk_command_t *command, uint32_t tick,
                    uint32_t frame[ILK_FRAME_WORDS]);

/* --- axis.c: one axis: what it is seen to do, what it was told to do, its faults (P5, P6, P7) --------- */

/** Phase 2: whether the frame of this tick is valid; bad ones in a row are counted. */
void ilk_card_observe(const ilk_system_t *system, const ilk_reading_t *reading, bool received,
                      ilk_axis_t *axis);

/** True when its last `bad_frame_limit` frames were bad. */
bool ilk_card_is_lost(const ilk_common_config_t *common, const ilk_axis_t *axis);

/**
 * Phase 4: place and marks follow the frame of this tick, and every rule about motion is judged.
 *
 * @param periods loop periods since the tick before, 1 when no deadline was missed.
 * @return true when the axis faulted in this tick.
 */
bool ilk_axis_observe(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                      const ilk_system_t *system, const ilk_reading_t *reading, uint32_t periods,
                      ilk_axis_t *axis);

/** In the last `rest_ticks` ticks undriven, read validly, and still within `noise_counts`. */
bool ilk_axis_is_at_rest(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Driven as long, or with as much drive, as is allowed without progress. */
bool ilk_axis_has_stalled(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** The switch has read one way for the debounce time. */
bool ilk_switch_is_steady(const ilk_common_config_t *common, const ilk_axis_t *axis, bool triggered);

/** Drops setpoint, lease and homing. */
void ilk_axis_drop_motion(ilk_axis_t *axis);

/** DISABLED, unless FAULTED; it must come to rest anew. */
void ilk_axis_disable(ilk_axis_t *axis);

/** A new press: the budgets of travel and of homing are whole. */
void ilk_axis_begin_press(ilk_axis_t *axis);

/** ENABLED where it stands: marks of motion begin there. */
void ilk_axis_enable(ilk_axis_t *axis);

/** Takes the fault back. A stall that was acknowledged is forgotten, no other fault excuses one. */
void ilk_axis_clear_fault(ilk_axis_t *axis);

/** Phase 7: the axis is driven in this tick. */
void ilk_axis_note_drive(const ilk_command_t *command, ilk_axis_t *axis);

/** Phase 7: the axis stands in the deadband of a live move. */
void ilk_axis_note_arrival(const ilk_axis_config_t *config, ilk_axis_t *axis);

/* --- homing.c: two edges of the switch, the second one slowly, and rest at it (P17) ------------ */

/** A fault that is about to be raised, or NONE, with what was measured. */
typedef struct {
  ilk_fault_t fault;
  int32_t value;
} ilk_finding_t;

/** HOME was accepted: the axis is not homed until the end. */
void ilk_homing_begin(ilk_axis_t *axis);

/** Phase 4, in each tick of HOMING: what this tick's frame means for it, and its budget. */
ilk_finding_t ilk_homing_advance(const ilk_common_config_t *common, const ilk_axis_config_t *config,
                                 ilk_axis_t *axis);

/** What homing wants in its phase. */
ilk_command_t ilk_homing_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Travel and time of this press are not used up (HOME: BUDGET). */
bool ilk_homing_has_budget(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** What is left of the travel of this press, coast kept back; 0 when nothing is. */
uint32_t ilk_homing_travel_left(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/* --- mode.c: the only writer of `mode`, of the cause and of the consent (P2, P8, P9, P12) ------ */

/** What the tick has seen that ends MOTION or locks, besides what the state itself tells. */
typedef struct {
  bool new_fault;             /**< an axis faulted in this tick */
  bool required_card_lost;    /**< a required card is lost */
  bool configuration_damaged; /**< a pass ended with another CRC, or what P1 to P3 rest on changed */
  uint32_t configuration_crc; /**< the CRC that the pass found; 0 within a pass */
} ilk_alarms_t;

/** Phase 3: pedal, E-stop, age of the app, overruns. */
void ilk_system_observe(const ilk_common_config_t *common, const ilk_inputs_t *in, ilk_system_t *system);

/** Phase 5: at most one transition per rule of the mode table. */
void ilk_mode_decide(const ilk_config_t *config, const ilk_inputs_t *in, const ilk_alarms_t *alarms,
                     ilk_state_t *state);

/** Enters `mode`, without a cause, and drops what does not survive the change. */
void ilk_mode_enter(ilk_mode_t mode, uint32_t boot_nonce, ilk_state_t *state);

/** Takes back the consent that the pedal gave: it must be released and pressed anew. */
void ilk_pedal_disarm(ilk_system_t *system);

/** True while something that locks is there, or the app or the bus is not (RESET: CAUSE_PRESENT). */
bool ilk_cause_is_present(const ilk_state_t *state);

/** Power is on in READY and MOTION only. */
bool ilk_power_is_on(const ilk_system_t *system);

/* --- integrity.c: state and configuration (P14) ------------------------------------------------ */

/** Phase 1: puts a new state in place of a damaged one, and looks for damage in the configuration. */
ilk_alarms_t ilk_integrity_check(const ilk_config_t *config, ilk_state_t *state);

/** The digest of all words is the one that was written. */
bool ilk_state_is_sealed(const ilk_state_t *state);

/** Phase 8: writes the seal that the next tick looks for. */
void ilk_state_seal(ilk_state_t *state);

/* --- request.c: one verdict each (P11) --------------------------------------------------------- */

/** Phase 6: judges one request and carries it out when it is accepted. */
ilk_verdict_record_t ilk_request_take(const ilk_config_t *config, const ilk_request_t *request,
                                      ilk_state_t *state);

/* --- gate.c: what an axis wants, and the only place from which a drive can leave (P1 to P5, P7) --- */

/** Phase 7: towards the setpoint, none within the deadband; or as homing asks. */
ilk_command_t ilk_wanted_command(const ilk_axis_config_t *config, const ilk_axis_t *axis);

/** Phase 7: the first gate that blocks `wanted`; OPEN when it may leave. */
ilk_gate_t ilk_output_gate(const ilk_axis_config_t *config, const ilk_system_t *system,
                           const ilk_axis_t *axis, const ilk_command_t *wanted);

#endif
