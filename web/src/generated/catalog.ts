// Generated from spec/catalog.toml by `make generate`. Do not edit.

/** One code. Texts that a family does not carry are empty. */
export interface CatalogEntry {
  readonly number: number;
  readonly name: string;
  readonly meaning: string;
  readonly cause: string;
  readonly next_step: string;
  readonly clears: string;
  readonly properties: readonly string[];
}

/** Every code that kernel, app and console share, by family and rising number. */
export const catalog = {
  /** System modes. */
  mode: [
    {"number": 0, "name": "INIT", "meaning": "The kernel has no valid configuration; every output is zero.", "cause": "The configuration file was refused.", "next_step": "Correct the robot file, compile it again and restart the kernel.", "clears": "A valid configuration is loaded at start.", "properties": ["P2", "P13"]},
    {"number": 1, "name": "LOCKED", "meaning": "Motion is latched off; the first cause is kept.", "cause": "See the cause that is shown.", "next_step": "Remove the cause, release the pedal, then press Unlock.", "clears": "An accepted RESET.", "properties": ["P2", "P8"]},
    {"number": 2, "name": "READY", "meaning": "All is clear; the kernel waits for the pedal.", "cause": "The system was unlocked, or motion ended.", "next_step": "Release the pedal, then press and hold it.", "clears": "The armed pedal is pressed for the debounce time, with power up, the app alive, every required card valid and no DISABLED axis moving.", "properties": ["P2", "P9"]},
    {"number": 3, "name": "MOTION", "meaning": "The pedal is held after fresh consent; accepted moves drive their axes.", "cause": "The armed pedal was pressed in READY.", "next_step": "Release the pedal to stop.", "clears": "Pedal released, STOP, silence of the app, a new fault, a lost required card or a change of control holder.", "properties": ["P1", "P12"]},
  ],
  /** States of an axis. */
  axis_state: [
    {"number": 0, "name": "DISABLED", "meaning": "The axis is not driven; outside of MOTION it may be moved by hand.", "cause": "Start, DISABLE, CLEAR_FAULT or a lock.", "next_step": "Enable the axis.", "clears": "An accepted ENABLE.", "properties": ["P1"]},
    {"number": 1, "name": "ENABLED", "meaning": "The axis is ready for a move and stands still.", "cause": "ENABLE, or the last move ended.", "next_step": "Propose a move or home the axis.", "clears": "MOVE, HOME, DISABLE, a fault or a lock.", "properties": ["P1", "P6"]},
    {"number": 2, "name": "MOVING", "meaning": "A move is held by its lease.", "cause": "An accepted MOVE.", "next_step": "None; release the pedal to stop.", "clears": "The lease runs out, MOTION ends, DISABLE or a fault.", "properties": ["P1", "P4", "P5"]},
    {"number": 3, "name": "HOMING", "meaning": "The kernel runs the axis to its switch to reference it.", "cause": "An accepted HOME.", "next_step": "Hold the pedal until the axis is homed.", "clears": "The axis is homed, MOTION ends, DISABLE or a fault.", "properties": ["P1", "P3", "P7"]},
    {"number": 4, "name": "FAULTED", "meaning": "The axis broke a rule and is not driven.", "cause": "See the fault that is shown.", "next_step": "Remove the cause, release the pedal, wait until the axis rests, clear the fault and enable the axis again.", "clears": "An accepted CLEAR_FAULT.", "properties": ["P5", "P6", "P8"]},
  ],
  /** Requests of the app. `fields` are read by the kernel; `checks` are the verdicts that can refuse it, in order, after CHECKSUM, SEQUENCE, UNKNOWN and AXIS. */
  request: [
    {"number": 1, "name": "HEARTBEAT", "meaning": "The app is alive; `holder` is in control.", "cause": "", "next_step": "", "clears": "", "properties": ["P10"]},
    {"number": 2, "name": "STOP", "meaning": "End MOTION now, or take back a pedal that is armed.", "cause": "", "next_step": "", "clears": "", "properties": ["P2", "P9"]},
    {"number": 3, "name": "RESET", "meaning": "Unlock.", "cause": "", "next_step": "", "clears": "", "properties": ["P8"]},
    {"number": 4, "name": "DISABLE", "meaning": "Take the axis out of motion.", "cause": "", "next_step": "", "clears": "", "properties": ["P1"]},
    {"number": 5, "name": "ENABLE", "meaning": "Let the axis be moved, from where it stands.", "cause": "", "next_step": "", "clears": "", "properties": ["P1", "P12"]},
    {"number": 6, "name": "CLEAR_FAULT", "meaning": "Acknowledge the fault of the axis.", "cause": "", "next_step": "", "clears": "", "properties": ["P8"]},
    {"number": 7, "name": "MOVE", "meaning": "Drive the axis towards a setpoint for as long as the lease holds.", "cause": "", "next_step": "", "clears": "", "properties": ["P1", "P4", "P7", "P12"]},
    {"number": 8, "name": "HOME", "meaning": "Reference the axis at its switch.", "cause": "", "next_step": "", "clears": "", "properties": ["P3", "P7", "P12", "P17"]},
    {"number": 9, "name": "SET_HOME", "meaning": "Declare that the axis stands at its home position.", "cause": "", "next_step": "", "clears": "", "properties": ["P4", "P6"]},
    {"number": 10, "name": "RESTORE", "meaning": "Set the position from a saved one; the axis is not homed afterwards.", "cause": "", "next_step": "", "clears": "", "properties": ["P4", "P6"]},
  ],
  /** The one answer to a request. */
  verdict: [
    {"number": 0, "name": "ACCEPTED", "meaning": "The request takes effect in this tick.", "cause": "Every check passed.", "next_step": "None.", "clears": "Does not apply.", "properties": ["P11"]},
    {"number": 1, "name": "CHECKSUM", "meaning": "The request's CRC does not match its words.", "cause": "The record was damaged or written by a faulty app.", "next_step": "Restart the app; if it happens again, report it with the log.", "clears": "A request with a correct CRC.", "properties": ["P11"]},
    {"number": 2, "name": "SEQUENCE", "meaning": "The sequence number is not newer than the last one.", "cause": "The request was repeated or came out of order.", "next_step": "Restart the app; if it happens again, report it with the log.", "clears": "A request with a newer number, or a new attachment.", "properties": ["P11"]},
    {"number": 3, "name": "UNKNOWN", "meaning": "There is no such request.", "cause": "App and kernel are of different versions.", "next_step": "Install app and kernel from the same release.", "clears": "A request of a known kind.", "properties": ["P11"]},
    {"number": 4, "name": "AXIS", "meaning": "No axis in that slot.", "cause": "The slot is empty, holds a sensor card or does not exist.", "next_step": "Choose an axis of this robot.", "clears": "A request that names an axis.", "properties": ["P11"]},
    {"number": 5, "name": "MODE", "meaning": "The request is not allowed in this mode.", "cause": "For a move: the pedal is not held. For RESET: the system is not locked.", "next_step": "Look at the mode in the header: unlock, or press and hold the pedal.", "clears": "The mode allows the request.", "properties": ["P9", "P11"]},
    {"number": 6, "name": "PEDAL_DOWN", "meaning": "The pedal must be released first.", "cause": "The pedal is pressed, or its channels do not agree.", "next_step": "Release the pedal and try again.", "clears": "All channels read released.", "properties": ["P9", "P11"]},
    {"number": 7, "name": "CAUSE_PRESENT", "meaning": "What locked the system or faulted the axis is still there.", "cause": "E-stop pulled, bus lost, app silent, configuration damaged, an axis that runs away, a card that is not valid, an axis that is not at rest or a fault of this very tick.", "next_step": "Remove the cause, then try again.", "clears": "The cause is gone.", "properties": ["P8", "P11"]},
    {"number": 8, "name": "FAULTED", "meaning": "The axis is faulted.", "cause": "See the fault of the axis.", "next_step": "Clear the fault first.", "clears": "An accepted CLEAR_FAULT.", "properties": ["P8", "P11"]},
    {"number": 9, "name": "CARD", "meaning": "The axis' card gave no valid frame in this tick.", "cause": "Card unplugged, resetting or disturbed.", "next_step": "Check the card's row in the status panel and try again.", "clears": "A valid frame.", "properties": ["P11"]},
    {"number": 10, "name": "NO_FAULT", "meaning": "There is no fault to clear.", "cause": "The axis is not faulted.", "next_step": "None.", "clears": "Does not apply.", "properties": ["P11"]},
    {"number": 11, "name": "DISABLED", "meaning": "The axis is not enabled.", "cause": "It was never enabled, or a lock or DISABLE took it out.", "next_step": "Enable the axis.", "clears": "An accepted ENABLE.", "properties": ["P1", "P11"]},
    {"number": 12, "name": "BUSY", "meaning": "The axis is homing or not at rest, or power is not up.", "cause": "Homing runs, the counter still changes, or power came on a moment ago.", "next_step": "Wait until the axis rests and power is up.", "clears": "Homing ended, the axis rests, power is up.", "properties": ["P11"]},
    {"number": 13, "name": "LEASE", "meaning": "The lease is zero or too long.", "cause": "The app asked for a lease outside the configured bounds.", "next_step": "Report it with the log.", "clears": "A lease from 1 to `lease_max_ticks`.", "properties": ["P10", "P11"]},
    {"number": 14, "name": "DRIVE", "meaning": "Drive is zero, or drive or amplitude is above its bound.", "cause": "The axis is not homed and allows only slow motion, or the app asked for too much.", "next_step": "Home the axis, or ask for less.", "clears": "Drive and amplitude within their bounds.", "properties": ["P7", "P11"]},
    {"number": 15, "name": "RANGE", "meaning": "The setpoint or position is outside the allowed range.", "cause": "It is nearer than the coasting distance to a soft limit, behind the switch, or farther than an axis that is not homed may travel.", "next_step": "Choose a position inside the range that is shown; home the axis for the full range.", "clears": "A position inside the range.", "properties": ["P4", "P7", "P11"]},
    {"number": 16, "name": "NO_SWITCH", "meaning": "The axis has no limit switch to home at.", "cause": "The robot file names no limit side.", "next_step": "Bring the axis to its home position and press Set Home.", "clears": "Does not apply.", "properties": ["P11"]},
    {"number": 17, "name": "CONSENT", "meaning": "The request carries the number of another press of the pedal.", "cause": "It was approved, delayed or repeated before this press.", "next_step": "Look at the motion again, approve it, and press the pedal anew.", "clears": "A request with the number of this press.", "properties": ["P11", "P12"]},
    {"number": 18, "name": "BUDGET", "meaning": "Homing has used up its travel or time for this press of the pedal.", "cause": "Earlier attempts of this press took it.", "next_step": "Release and press the pedal, then home again; look for what keeps the axis from its switch.", "clears": "The pedal is pressed anew.", "properties": ["P7", "P11"]},
  ],
  /** Why the system is LOCKED. */
  cause: [
    {"number": 0, "name": "NONE", "meaning": "Not locked.", "cause": "Does not apply.", "next_step": "None.", "clears": "Does not apply.", "properties": ["P8"]},
    {"number": 1, "name": "BOOT", "meaning": "The kernel has just started.", "cause": "Start or restart of the kernel.", "next_step": "Check that the robot is safe to move, then press Unlock.", "clears": "RESET.", "properties": ["P8", "P13"]},
    {"number": 2, "name": "ESTOP", "meaning": "The E-stop was pulled, or its loop is broken. Value: the contact as read.", "cause": "Somebody pulled the E-stop, or a wire of the loop is open.", "next_step": "Make sure that the robot is safe, release the E-stop, then press Unlock.", "clears": "Loop closed, then RESET.", "properties": ["P2", "P8"]},
    {"number": 3, "name": "BUS", "meaning": "No card answered, or transactions failed. Value: bad ticks in a row.", "cause": "Card power off, cable unplugged, bus driver failed.", "next_step": "Check power and cable of the card rack, then press Unlock.", "clears": "A valid frame from a card, then RESET.", "properties": ["P2", "P8"]},
    {"number": 4, "name": "PEDAL", "meaning": "The pedal's channels disagree. Value: contacts as read, normally open in bit 0, normally closed in bit 1.", "cause": "A broken contact or wire of the pedal, or a pedal pressed half-way.", "next_step": "Release the pedal; if the channels still disagree, replace the pedal.", "clears": "Channels agree on released, then RESET.", "properties": ["P2", "P8"]},
    {"number": 5, "name": "INTEGRITY", "meaning": "Memory of the kernel was damaged. Value: the seal of the damaged state, or the CRC that was found over the configuration; 0 when one of its words that drive rests on had changed.", "cause": "A memory fault or a stray write.", "next_step": "Restart the kernel; if it happens again, take the computer out of service.", "clears": "State rebuilt or configuration sound, then RESET. Positions must be homed again.", "properties": ["P8", "P14"]},
    {"number": 6, "name": "OVERRUN", "meaning": "The control loop missed its deadline several times in a row. Value: misses in a row.", "cause": "The computer is overloaded or not set up for real time.", "next_step": "Look at the timing histogram, stop other load, then press Unlock.", "clears": "Deadlines met, then RESET.", "properties": ["P8"]},
    {"number": 7, "name": "RUNAWAY", "meaning": "A faulted axis goes on moving although its drive is zero; power was taken away. Value: its slot.", "cause": "Amplifier fault, or an outside force.", "next_step": "Keep clear of the robot until the axis rests; check the amplifier, then press Unlock.", "clears": "The axis at rest or its card lost, then RESET.", "properties": ["P6", "P8"]},
  ],
  /** Why an axis is FAULTED. */
  fault: [
    {"number": 0, "name": "NONE", "meaning": "No fault.", "cause": "Does not apply.", "next_step": "None.", "clears": "Does not apply.", "properties": ["P8"]},
    {"number": 1, "name": "STALL", "meaning": "The axis was driven without making progress. Value: progress in counts.", "cause": "The axis is blocked, the motor is not powered, or the encoder does not count; the axis is no longer homed.", "next_step": "Look for an obstacle and at the encoder cable, then clear the fault, enable and home the axis.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P5", "P8"]},
    {"number": 2, "name": "REVERSE", "meaning": "The axis moved against its command. Value: counts against the command.", "cause": "Motor or encoder wired the wrong way round, wrong direction in the robot file, or an outside force; the axis is no longer homed.", "next_step": "Do not drive the axis until its directions are checked; then clear the fault, enable and home the axis.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P6", "P8"]},
    {"number": 3, "name": "DRIFT", "meaning": "The axis moved although it was not driven. Value: counts from its mark.", "cause": "Amplifier fault, an outside force, or a motor that does not hold.", "next_step": "Check what moves the axis; then clear the fault and enable.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P6", "P8"]},
    {"number": 4, "name": "JUMP", "meaning": "The counter jumped farther than the axis can move. Value: counts of the jump.", "cause": "Encoder disturbed or counts lost; the axis is no longer homed.", "next_step": "Check encoder and cable, clear the fault, enable and home the axis.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P6", "P8"]},
    {"number": 5, "name": "CARD", "meaning": "The card gave no valid frame several times in a row; the axis is no longer homed. Value: bad frames in a row.", "cause": "Card unplugged, without power, or the bus is disturbed.", "next_step": "Check the card and its cable, clear the fault, enable and home the axis.", "clears": "Valid frames and the axis at rest, then CLEAR_FAULT.", "properties": ["P1", "P8"]},
    {"number": 6, "name": "HOMING_TRAVEL", "meaning": "Homing has used up its travel for this press of the pedal. Value: counts travelled.", "cause": "The limit switch is broken or unplugged, sits at the other end, or bounces for too long.", "next_step": "Check the switch, clear the fault, enable and home again.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P7", "P8"]},
    {"number": 7, "name": "HOMING_TIMEOUT", "meaning": "Homing has used up its time for this press of the pedal. Value: homing phase.", "cause": "The axis is too slow, or does not come to rest at the switch.", "next_step": "Check the axis for friction, clear the fault, enable and home again.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P7", "P8"]},
    {"number": 8, "name": "CARD_RESET", "meaning": "The card was reset, so that its counter means another place. Value: heartbeats since the last valid frame.", "cause": "The card lost power or restarted; the axis is no longer homed.", "next_step": "Check the card's supply, clear the fault, enable and home the axis.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P8", "P17"]},
    {"number": 9, "name": "SWITCH", "meaning": "The switch contradicts the position, or the two edges of homing differ. Value: counts from the place where it homed, or between the edges.", "cause": "A limit switch that is disturbed, loose or broken, or counts lost; the axis is no longer homed.", "next_step": "Check the switch and its cable, clear the fault, enable and home the axis.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P8", "P17"]},
    {"number": 10, "name": "INTEGRITY", "meaning": "Memory of the kernel was damaged; nothing is known of the axis.", "cause": "A memory fault or a stray write.", "next_step": "Restart the kernel; if it happens again, take the computer out of service.", "clears": "The axis at rest, then CLEAR_FAULT.", "properties": ["P8", "P14"]},
  ],
  /** The conditions between a wish and a driven axis, in the order in which they are checked. The first that does not hold blocks. */
  gate: [
    {"number": 0, "name": "OPEN", "meaning": "The axis is driven.", "cause": "Every gate is open.", "next_step": "None.", "clears": "Does not apply.", "properties": ["P1"]},
    {"number": 1, "name": "MODE", "meaning": "The system is not in MOTION.", "cause": "The pedal is not held, or the system is locked.", "next_step": "Unlock if locked, then release, press and hold the pedal.", "clears": "MOTION.", "properties": ["P1", "P2"]},
    {"number": 2, "name": "PEDAL", "meaning": "Not every channel of the pedal reads pressed.", "cause": "The pedal is released or half-way.", "next_step": "Press the pedal fully and hold it.", "clears": "All channels read pressed.", "properties": ["P1", "P2"]},
    {"number": 3, "name": "ESTOP", "meaning": "The E-stop is active.", "cause": "It was pulled.", "next_step": "Release the E-stop and unlock.", "clears": "Loop closed.", "properties": ["P1", "P2"]},
    {"number": 4, "name": "CARD", "meaning": "The card's frame is not valid in this tick.", "cause": "A disturbed, late or repeated frame.", "next_step": "Look at the card's row in the status panel.", "clears": "A valid frame.", "properties": ["P1"]},
    {"number": 5, "name": "ENABLE", "meaning": "The axis is not enabled, or is faulted.", "cause": "See the state of the axis.", "next_step": "Clear the fault if there is one, then enable the axis.", "clears": "The axis is enabled.", "properties": ["P1"]},
    {"number": 6, "name": "LEASE", "meaning": "No move holds the axis.", "cause": "No MOVE was accepted, or its lease ran out.", "next_step": "Propose a move.", "clears": "An accepted MOVE or HOME.", "properties": ["P1", "P10", "P12"]},
    {"number": 7, "name": "SETPOINT", "meaning": "The axis is at its setpoint, or homing waits for rest.", "cause": "The move has arrived.", "next_step": "Propose another move.", "clears": "A setpoint outside the deadband.", "properties": ["P1"]},
    {"number": 8, "name": "HARD_LIMIT", "meaning": "The axis stands at its switch and may only move away from it.", "cause": "The limit switch is triggered or was not read validly.", "next_step": "Move the axis the other way.", "clears": "The switch opens, or the move leads away.", "properties": ["P3"]},
    {"number": 9, "name": "SOFT_LIMIT", "meaning": "The axis is at its soft limit and may only move inward.", "cause": "The position is at the limit less the coasting distance, or where the switch may close.", "next_step": "Move the axis the other way.", "clears": "The position is inside the range, or the move leads inward.", "properties": ["P4"]},
    {"number": 10, "name": "UNHOMED_TRAVEL", "meaning": "The axis is not homed and has used up its travel for this press of the pedal.", "cause": "An axis that is not homed moves only a short way.", "next_step": "Release and press the pedal for another stretch, or home the axis.", "clears": "The pedal is pressed anew, or the axis is homed.", "properties": ["P7"]},
    {"number": 11, "name": "DRIVE", "meaning": "The drive that was asked for is above its bound.", "cause": "The axis lost its reference, or its configuration is damaged.", "next_step": "Home the axis, or ask for less drive.", "clears": "A drive within its bound.", "properties": ["P7"]},
    {"number": 12, "name": "STALL", "meaning": "The axis was driven as long as it may be without progress.", "cause": "The axis is blocked, the motor is not powered, or the encoder does not count.", "next_step": "Look for an obstacle and at the encoder cable.", "clears": "Progress, or an accepted CLEAR_FAULT of the stall.", "properties": ["P5"]},
  ],
  /** The first rule that a refused configuration breaks. */
  config_error: [
    {"number": 0, "name": "NONE", "meaning": "The configuration is valid.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "VERSION", "meaning": "`version` is not the kernel's configuration version.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "SIZE", "meaning": "`size_bytes` is not the size of the kernel's configuration.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 3, "name": "CRC", "meaning": "`crc` does not match the words before it.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 4, "name": "PERIOD", "meaning": "`period_us` is not from 125 to 2000.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 5, "name": "PEDAL_CHANNELS", "meaning": "`pedal_channels` is not 1 or 2.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 6, "name": "APP_TIMEOUT", "meaning": "`app_timeout_ticks` is below 2 or more than 150 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 7, "name": "LEASE", "meaning": "`lease_max_ticks` is below 2 or more than 150 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 8, "name": "PEDAL_DEBOUNCE", "meaning": "`pedal_debounce_ticks` is zero or more than 50 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 9, "name": "PEDAL_DISAGREE", "meaning": "`pedal_disagree_ticks` is zero or more than 50 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 10, "name": "BAD_FRAMES", "meaning": "`bad_frame_limit` is not from 1 to 5.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 11, "name": "OVERRUNS", "meaning": "`overrun_limit` is not from 1 to 10.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 12, "name": "NO_AXIS", "meaning": "No slot has a motor card.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 13, "name": "CARD", "meaning": "`card` is not a known card type.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 14, "name": "FLAG", "meaning": "`required`, `motor_direction` or `direction_correction` is not 0 or 1.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 15, "name": "EMPTY_SLOT", "meaning": "A slot without a motor card has a field that is not zero, `card` and `required` apart; an empty slot is required.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 16, "name": "LIMIT_SIDE", "meaning": "`limit_side` is not NONE, LOWER or UPPER.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 17, "name": "SOFT_LIMITS", "meaning": "`min_counts` is not below `max_counts`, or a limit is beyond 2^30 counts.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 18, "name": "HOME_OFFSET", "meaning": "`home_offset_counts` is outside the soft limits, or leaves no room between where the switch is sure to be open and the coast before the other limit.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 19, "name": "COAST", "meaning": "`coast_counts` is zero, shorter than full speed in the latency of the loop, or min + coast is not below max - coast.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 20, "name": "DEADBAND", "meaning": "`deadband_counts` is zero or at least half of the range.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 21, "name": "MAX_DRIVE", "meaning": "`max_drive` is zero or more than the card's word can carry.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 22, "name": "UNHOMED_DRIVE", "meaning": "`unhomed_max_drive` is not above `dead_zone_drive`, or more than a tenth of the way from there to `max_drive`; or `dead_zone_drive` is more than a fifth of `max_drive`.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 23, "name": "AMPLITUDE", "meaning": "`max_amplitude` is not from 1 to 255 on a HIGH_FREQUENCY card, or not zero on another; `home_amplitude` exceeds it, or is not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 24, "name": "UNHOMED_TRAVEL", "meaning": "`unhomed_travel_counts` is not above `coast_counts`, or more than a tenth of the range.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 25, "name": "HOME_DRIVE", "meaning": "`home_drive` is not above `dead_zone_drive`, or more than `unhomed_max_drive`; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 26, "name": "HOME_TRAVEL", "meaning": "`home_travel_counts` does not cover the way from either stop with both back-offs and coast, or is more than four times the range; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 27, "name": "HOME_CLEAR", "meaning": "`home_clear_counts` does not cover tolerance, hysteresis and coast, or the progress that a stall asks for, or is more than a tenth of the range; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 28, "name": "REST", "meaning": "`rest_ticks` is not above the latency of the loop, shorter than the debounce of the switch, or more than 1000 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 29, "name": "HOME_TIMEOUT", "meaning": "`home_timeout_ticks` does not cover the way of homing at its speeds, or is more than ten minutes; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 30, "name": "STALL", "meaning": "`stall_ticks` is more than 500 ms, or ends before `stall_min_counts`, backlash and noise are travelled at the slowest drive with the latency of the loop, or at full speed after a reversal; or these are not above `noise_counts`.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 31, "name": "REVERSE", "meaning": "`reverse_counts` does not cover coast, backlash and noise, or is more than a tenth of the range.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 32, "name": "DRIFT", "meaning": "`drift_counts` does not cover coast, backlash and noise, or is more than a tenth of the range.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 33, "name": "STALL_EFFORT", "meaning": "`stall_effort_ticks` is more than 200 ms, or too short for five times the coast, backlash and noise at full speed; or zero on an axis that is fast enough for it.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 34, "name": "MAX_DELTA", "meaning": "`max_delta_counts` is below full speed and noise in a tick, or more than half of the range.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 35, "name": "SPEED", "meaning": "A speed is zero or too high, or a slower drive of homing has a higher one; not zero for homing on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 36, "name": "HOME_TOLERANCE", "meaning": "`home_tolerance_counts` does not cover what homing travels in the debounce time, and noise, or is more than a tenth of the range; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 37, "name": "HOME_SLOW", "meaning": "`home_slow_drive` is not above `dead_zone_drive`, or more than `home_drive`; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 38, "name": "POWER_UP", "meaning": "`power_up_ticks` is zero or more than 5000 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 39, "name": "SWITCH_DEBOUNCE", "meaning": "`switch_debounce_ticks` is below 2 or more than 20 ms.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 40, "name": "HYSTERESIS", "meaning": "`switch_hysteresis_counts` is more than a tenth of the range; not zero on an axis without a switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 41, "name": "NOISE", "meaning": "`noise_counts` or `backlash_counts` is more than a tenth of the range.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** Kinds of motor cards. */
  card: [
    {"number": 0, "name": "NONE", "meaning": "Empty slot.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "PWM", "meaning": "External driver, PWM: speed and direction in wave 1.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "NON_PWM", "meaning": "External driver without PWM: speed, direction and enable bit in wave 1.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 3, "name": "ANALOG", "meaning": "External driver with an analog input: signed level in the analog word.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 4, "name": "HIGH_FREQUENCY", "meaning": "Piezo drive by two waves: lower frequency is faster.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 5, "name": "SENSOR", "meaning": "No motor; analog inputs only.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** The end of the axis at which its switch sits. */
  limit_side: [
    {"number": 0, "name": "NONE", "meaning": "The axis has no switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "LOWER", "meaning": "The switch sits at the lower end; it blocks decreasing motion.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "UPPER", "meaning": "The switch sits at the upper end; it blocks increasing motion.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** Sense of motion, as the position counts. */
  direction: [
    {"number": 0, "name": "NONE", "meaning": "No motion.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "INCREASING", "meaning": "Towards larger positions.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "DECREASING", "meaning": "Towards smaller positions.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** Phases of homing. */
  homing_phase: [
    {"number": 0, "name": "NONE", "meaning": "Not homing.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "LOOK", "meaning": "Undriven, until the switch has read one way for the debounce time.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "LEAVE", "meaning": "The axis began on its switch and moves away until the switch is open and the axis clear.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 3, "name": "SEEK", "meaning": "Moves towards the switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 4, "name": "BACK_OFF", "meaning": "Moves away from the first edge until the switch is open and the axis clear.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 5, "name": "APPROACH", "meaning": "Moves towards the switch again, slowly.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 6, "name": "REST", "meaning": "At the second edge; waits until the axis is at rest.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** How the position of an axis came to be known. */
  homed: [
    {"number": 0, "name": "NOT", "meaning": "The position has no reference.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "BY_SWITCH", "meaning": "By HOME, at the switch.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "BY_HAND", "meaning": "By SET_HOME, a person's word.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** What the pedal's channels say together. */
  pedal: [
    {"number": 0, "name": "RELEASED", "meaning": "Every channel reads released.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "PRESSED", "meaning": "Every channel reads pressed.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "DISAGREE", "meaning": "The channels do not agree, or a contact was not read validly.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** Lamps of the front panel. */
  lamp: [
    {"number": 0, "name": "PEDAL", "meaning": "Green while MOTION holds, red while the E-stop is active, off otherwise.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "NETWORK", "meaning": "Green while the app is alive, red otherwise.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "CONTROLLER", "meaning": "Green in READY and MOTION, red while LOCKED.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 3, "name": "STALL", "meaning": "Purple while an axis has a STALL, amber while one has another fault.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
  /** Colours of a lamp. */
  colour: [
    {"number": 0, "name": "OFF", "meaning": "Dark.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 1, "name": "GREEN", "meaning": "Green.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 2, "name": "RED", "meaning": "Red.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 3, "name": "AMBER", "meaning": "Amber.", "cause": "", "next_step": "", "clears": "", "properties": []},
    {"number": 4, "name": "PURPLE", "meaning": "Purple.", "cause": "", "next_step": "", "clears": "", "properties": []},
  ],
} as const satisfies Readonly<Record<string, readonly CatalogEntry[]>>;

export type Family = keyof typeof catalog;

/** The names of a family, e.g. `CodeName<"mode">`. */
export type CodeName<F extends Family> = (typeof catalog)[F][number]["name"];

/** The code of that number or name, or a safe entry named "UNKNOWN_<code>" that tells what to do. */
export function entry(family: Family, code: number | string): CatalogEntry {
  const codes: readonly CatalogEntry[] = catalog[family];
  const found = codes.find((candidate) => candidate.number === code || candidate.name === code);
  return found ?? { ...unknown, name: `UNKNOWN_${code}` };
}

const unknown: CatalogEntry = {"number": -1, "name": "UNKNOWN", "meaning": "The catalog of this program does not have the code.", "cause": "App, kernel and console are of different versions.", "next_step": "Do not move the robot; install all parts from the same release.", "clears": "A code of the catalog.", "properties": []};
