// Generated from spec/catalog.toml by `make generate`. Do not edit.
#include "catalog.hpp"

#include <algorithm>
#include <array>

namespace interlock::catalog {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 2> kMode0Properties{"P2", "P13"};
constexpr std::array<std::string_view, 2> kMode1Properties{"P2", "P8"};
constexpr std::array<std::string_view, 2> kMode2Properties{"P2", "P9"};
constexpr std::array<std::string_view, 2> kMode3Properties{"P1", "P12"};
constexpr std::array<Entry, 4> kMode{
    Entry{0, "INIT", "The kernel has no valid configuration; every output is zero.", "The configuration file was refused.", "Correct the robot file, compile it again and restart the kernel.", "A valid configuration is loaded at start.", kMode0Properties},
    Entry{1, "LOCKED", "Motion is latched off; the first cause is kept.", "See the cause that is shown.", "Remove the cause, release the pedal, then press Unlock.", "An accepted RESET.", kMode1Properties},
    Entry{2, "READY", "All is clear; the kernel waits for the pedal.", "The system was unlocked, or motion ended.", "Release the pedal, then press and hold it.", "The armed pedal is pressed for the debounce time, with power up, the app alive, every required card valid and no DISABLED axis moving.", kMode2Properties},
    Entry{3, "MOTION", "The pedal is held after fresh consent; accepted moves drive their axes.", "The armed pedal was pressed in READY.", "Release the pedal to stop.", "Pedal released, STOP, silence of the app, a new fault, a lost required card or a change of control holder.", kMode3Properties},
};
constexpr std::array<std::string_view, 1> kAxisState0Properties{"P1"};
constexpr std::array<std::string_view, 2> kAxisState1Properties{"P1", "P6"};
constexpr std::array<std::string_view, 3> kAxisState2Properties{"P1", "P4", "P5"};
constexpr std::array<std::string_view, 3> kAxisState3Properties{"P1", "P3", "P7"};
constexpr std::array<std::string_view, 3> kAxisState4Properties{"P5", "P6", "P8"};
constexpr std::array<Entry, 5> kAxisState{
    Entry{0, "DISABLED", "The axis is not driven; outside of MOTION it may be moved by hand.", "Start, DISABLE, CLEAR_FAULT or a lock.", "Enable the axis.", "An accepted ENABLE.", kAxisState0Properties},
    Entry{1, "ENABLED", "The axis is ready for a move and stands still.", "ENABLE, or the last move ended.", "Propose a move or home the axis.", "MOVE, HOME, DISABLE, a fault or a lock.", kAxisState1Properties},
    Entry{2, "MOVING", "A move is held by its lease.", "An accepted MOVE.", "None; release the pedal to stop.", "The lease runs out, MOTION ends, DISABLE or a fault.", kAxisState2Properties},
    Entry{3, "HOMING", "The kernel runs the axis to its switch to reference it.", "An accepted HOME.", "Hold the pedal until the axis is homed.", "The axis is homed, MOTION ends, DISABLE or a fault.", kAxisState3Properties},
    Entry{4, "FAULTED", "The axis broke a rule and is not driven.", "See the fault that is shown.", "Remove the cause, release the pedal, wait until the axis rests, clear the fault and enable the axis again.", "An accepted CLEAR_FAULT.", kAxisState4Properties},
};
constexpr std::array<std::string_view, 1> kRequest1Properties{"P10"};
constexpr std::array<std::string_view, 2> kRequest2Properties{"P2", "P9"};
constexpr std::array<std::string_view, 1> kRequest3Properties{"P8"};
constexpr std::array<std::string_view, 1> kRequest4Properties{"P1"};
constexpr std::array<std::string_view, 2> kRequest5Properties{"P1", "P12"};
constexpr std::array<std::string_view, 1> kRequest6Properties{"P8"};
constexpr std::array<std::string_view, 4> kRequest7Properties{"P1", "P4", "P7", "P12"};
constexpr std::array<std::string_view, 4> kRequest8Properties{"P3", "P7", "P12", "P17"};
constexpr std::array<std::string_view, 2> kRequest9Properties{"P4", "P6"};
constexpr std::array<std::string_view, 2> kRequest10Properties{"P4", "P6"};
constexpr std::array<Entry, 10> kRequest{
    Entry{1, "HEARTBEAT", "The app is alive; `holder` is in control.", "", "", "", kRequest1Properties},
    Entry{2, "STOP", "End MOTION now, or take back a pedal that is armed.", "", "", "", kRequest2Properties},
    Entry{3, "RESET", "Unlock.", "", "", "", kRequest3Properties},
    Entry{4, "DISABLE", "Take the axis out of motion.", "", "", "", kRequest4Properties},
    Entry{5, "ENABLE", "Let the axis be moved, from where it stands.", "", "", "", kRequest5Properties},
    Entry{6, "CLEAR_FAULT", "Acknowledge the fault of the axis.", "", "", "", kRequest6Properties},
    Entry{7, "MOVE", "Drive the axis towards a setpoint for as long as the lease holds.", "", "", "", kRequest7Properties},
    Entry{8, "HOME", "Reference the axis at its switch.", "", "", "", kRequest8Properties},
    Entry{9, "SET_HOME", "Declare that the axis stands at its home position.", "", "", "", kRequest9Properties},
    Entry{10, "RESTORE", "Set the position from a saved one; the axis is not homed afterwards.", "", "", "", kRequest10Properties},
};
constexpr std::array<std::string_view, 1> kVerdict0Properties{"P11"};
constexpr std::array<std::string_view, 1> kVerdict1Properties{"P11"};
constexpr std::array<std::string_view, 1> kVerdict2Properties{"P11"};
constexpr std::array<std::string_view, 1> kVerdict3Properties{"P11"};
constexpr std::array<std::string_view, 1> kVerdict4Properties{"P11"};
constexpr std::array<std::string_view, 2> kVerdict5Properties{"P9", "P11"};
constexpr std::array<std::string_view, 2> kVerdict6Properties{"P9", "P11"};
constexpr std::array<std::string_view, 2> kVerdict7Properties{"P8", "P11"};
constexpr std::array<std::string_view, 2> kVerdict8Properties{"P8", "P11"};
constexpr std::array<std::string_view, 1> kVerdict9Properties{"P11"};
constexpr std::array<std::string_view, 1> kVerdict10Properties{"P11"};
constexpr std::array<std::string_view, 2> kVerdict11Properties{"P1", "P11"};
constexpr std::array<std::string_view, 1> kVerdict12Properties{"P11"};
constexpr std::array<std::string_view, 2> kVerdict13Properties{"P10", "P11"};
constexpr std::array<std::string_view, 2> kVerdict14Properties{"P7", "P11"};
constexpr std::array<std::string_view, 3> kVerdict15Properties{"P4", "P7", "P11"};
constexpr std::array<std::string_view, 1> kVerdict16Properties{"P11"};
constexpr std::array<std::string_view, 2> kVerdict17Properties{"P11", "P12"};
constexpr std::array<std::string_view, 2> kVerdict18Properties{"P7", "P11"};
constexpr std::array<Entry, 19> kVerdict{
    Entry{0, "ACCEPTED", "The request takes effect in this tick.", "Every check passed.", "None.", "Does not apply.", kVerdict0Properties},
    Entry{1, "CHECKSUM", "The request's CRC does not match its words.", "The record was damaged or written by a faulty app.", "Restart the app; if it happens again, report it with the log.", "A request with a correct CRC.", kVerdict1Properties},
    Entry{2, "SEQUENCE", "The sequence number is not newer than the last one.", "The request was repeated or came out of order.", "Restart the app; if it happens again, report it with the log.", "A request with a newer number, or a new attachment.", kVerdict2Properties},
    Entry{3, "UNKNOWN", "There is no such request.", "App and kernel are of different versions.", "Install app and kernel from the same release.", "A request of a known kind.", kVerdict3Properties},
    Entry{4, "AXIS", "No axis in that slot.", "The slot is empty, holds a sensor card or does not exist.", "Choose an axis of this robot.", "A request that names an axis.", kVerdict4Properties},
    Entry{5, "MODE", "The request is not allowed in this mode.", "For a move: the pedal is not held. For RESET: the system is not locked.", "Look at the mode in the header: unlock, or press and hold the pedal.", "The mode allows the request.", kVerdict5Properties},
    Entry{6, "PEDAL_DOWN", "The pedal must be released first.", "The pedal is pressed, or its channels do not agree.", "Release the pedal and try again.", "All channels read released.", kVerdict6Properties},
    Entry{7, "CAUSE_PRESENT", "What locked the system or faulted the axis is still there.", "E-stop pulled, bus lost, app silent, configuration damaged, an axis that runs away, a card that is not valid, an axis that is not at rest or a fault of this very tick.", "Remove the cause, then try again.", "The cause is gone.", kVerdict7Properties},
    Entry{8, "FAULTED", "The axis is faulted.", "See the fault of the axis.", "Clear the fault first.", "An accepted CLEAR_FAULT.", kVerdict8Properties},
    Entry{9, "CARD", "The axis' card gave no valid frame in this tick.", "Card unplugged, resetting or disturbed.", "Check the card's row in the status panel and try again.", "A valid frame.", kVerdict9Properties},
    Entry{10, "NO_FAULT", "There is no fault to clear.", "The axis is not faulted.", "None.", "Does not apply.", kVerdict10Properties},
    Entry{11, "DISABLED", "The axis is not enabled.", "It was never enabled, or a lock or DISABLE took it out.", "Enable the axis.", "An accepted ENABLE.", kVerdict11Properties},
    Entry{12, "BUSY", "The axis is homing or not at rest, or power is not up.", "Homing runs, the counter still changes, or power came on a moment ago.", "Wait until the axis rests and power is up.", "Homing ended, the axis rests, power is up.", kVerdict12Properties},
    Entry{13, "LEASE", "The lease is zero or too long.", "The app asked for a lease outside the configured bounds.", "Report it with the log.", "A lease from 1 to `lease_max_ticks`.", kVerdict13Properties},
    Entry{14, "DRIVE", "Drive is zero, or drive or amplitude is above its bound.", "The axis is not homed and allows only slow motion, or the app asked for too much.", "Home the axis, or ask for less.", "Drive and amplitude within their bounds.", kVerdict14Properties},
    Entry{15, "RANGE", "The setpoint or position is outside the allowed range.", "It is nearer than the coasting distance to a soft limit, behind the switch, or farther than an axis that is not homed may travel.", "Choose a position inside the range that is shown; home the axis for the full range.", "A position inside the range.", kVerdict15Properties},
    Entry{16, "NO_SWITCH", "The axis has no limit switch to home at.", "The robot file names no limit side.", "Bring the axis to its home position and press Set Home.", "Does not apply.", kVerdict16Properties},
    Entry{17, "CONSENT", "The request carries the number of another press of the pedal.", "It was approved, delayed or repeated before this press.", "Look at the motion again, approve it, and press the pedal anew.", "A request with the number of this press.", kVerdict17Properties},
    Entry{18, "BUDGET", "Homing has used up its travel or time for this press of the pedal.", "Earlier attempts of this press took it.", "Release and press the pedal, then home again; look for what keeps the axis from its switch.", "The pedal is pressed anew.", kVerdict18Properties},
};
constexpr std::array<std::string_view, 1> kCause0Properties{"P8"};
constexpr std::array<std::string_view, 2> kCause1Properties{"P8", "P13"};
constexpr std::array<std::string_view, 2> kCause2Properties{"P2", "P8"};
constexpr std::array<std::string_view, 2> kCause3Properties{"P2", "P8"};
constexpr std::array<std::string_view, 2> kCause4Properties{"P2", "P8"};
constexpr std::array<std::string_view, 2> kCause5Properties{"P8", "P14"};
constexpr std::array<std::string_view, 1> kCause6Properties{"P8"};
constexpr std::array<std::string_view, 2> kCause7Properties{"P6", "P8"};
constexpr std::array<Entry, 8> kCause{
    Entry{0, "NONE", "Not locked.", "Does not apply.", "None.", "Does not apply.", kCause0Properties},
    Entry{1, "BOOT", "The kernel has just started.", "Start or restart of the kernel.", "Check that the robot is safe to move, then press Unlock.", "RESET.", kCause1Properties},
    Entry{2, "ESTOP", "The E-stop was pulled, or its loop is broken. Value: the contact as read.", "Somebody pulled the E-stop, or a wire of the loop is open.", "Make sure that the robot is safe, release the E-stop, then press Unlock.", "Loop closed, then RESET.", kCause2Properties},
    Entry{3, "BUS", "No card answered, or transactions failed. Value: bad ticks in a row.", "Card power off, cable unplugged, bus driver failed.", "Check power and cable of the card rack, then press Unlock.", "A valid frame from a card, then RESET.", kCause3Properties},
    Entry{4, "PEDAL", "The pedal's channels disagree. Value: contacts as read, normally open in bit 0, normally closed in bit 1.", "A broken contact or wire of the pedal, or a pedal pressed half-way.", "Release the pedal; if the channels still disagree, replace the pedal.", "Channels agree on released, then RESET.", kCause4Properties},
    Entry{5, "INTEGRITY", "Memory of the kernel was damaged. Value: the seal of the damaged state, or the CRC that was found over the configuration; 0 when one of its words that drive rests on had changed.", "A memory fault or a stray write.", "Restart the kernel; if it happens again, take the computer out of service.", "State rebuilt or configuration sound, then RESET. Positions must be homed again.", kCause5Properties},
    Entry{6, "OVERRUN", "The control loop missed its deadline several times in a row. Value: misses in a row.", "The computer is overloaded or not set up for real time.", "Look at the timing histogram, stop other load, then press Unlock.", "Deadlines met, then RESET.", kCause6Properties},
    Entry{7, "RUNAWAY", "A faulted axis goes on moving although its drive is zero; power was taken away. Value: its slot.", "Amplifier fault, or an outside force.", "Keep clear of the robot until the axis rests; check the amplifier, then press Unlock.", "The axis at rest or its card lost, then RESET.", kCause7Properties},
};
constexpr std::array<std::string_view, 1> kFault0Properties{"P8"};
constexpr std::array<std::string_view, 2> kFault1Properties{"P5", "P8"};
constexpr std::array<std::string_view, 2> kFault2Properties{"P6", "P8"};
constexpr std::array<std::string_view, 2> kFault3Properties{"P6", "P8"};
constexpr std::array<std::string_view, 2> kFault4Properties{"P6", "P8"};
constexpr std::array<std::string_view, 2> kFault5Properties{"P1", "P8"};
constexpr std::array<std::string_view, 2> kFault6Properties{"P7", "P8"};
constexpr std::array<std::string_view, 2> kFault7Properties{"P7", "P8"};
constexpr std::array<std::string_view, 2> kFault8Properties{"P8", "P17"};
constexpr std::array<std::string_view, 2> kFault9Properties{"P8", "P17"};
constexpr std::array<std::string_view, 2> kFault10Properties{"P8", "P14"};
constexpr std::array<Entry, 11> kFault{
    Entry{0, "NONE", "No fault.", "Does not apply.", "None.", "Does not apply.", kFault0Properties},
    Entry{1, "STALL", "The axis was driven without making progress. Value: progress in counts.", "The axis is blocked, the motor is not powered, or the encoder does not count; the axis is no longer homed.", "Look for an obstacle and at the encoder cable, then clear the fault, enable and home the axis.", "The axis at rest, then CLEAR_FAULT.", kFault1Properties},
    Entry{2, "REVERSE", "The axis moved against its command. Value: counts against the command.", "Motor or encoder wired the wrong way round, wrong direction in the robot file, or an outside force; the axis is no longer homed.", "Do not drive the axis until its directions are checked; then clear the fault, enable and home the axis.", "The axis at rest, then CLEAR_FAULT.", kFault2Properties},
    Entry{3, "DRIFT", "The axis moved although it was not driven. Value: counts from its mark.", "Amplifier fault, an outside force, or a motor that does not hold.", "Check what moves the axis; then clear the fault and enable.", "The axis at rest, then CLEAR_FAULT.", kFault3Properties},
    Entry{4, "JUMP", "The counter jumped farther than the axis can move. Value: counts of the jump.", "Encoder disturbed or counts lost; the axis is no longer homed.", "Check encoder and cable, clear the fault, enable and home the axis.", "The axis at rest, then CLEAR_FAULT.", kFault4Properties},
    Entry{5, "CARD", "The card gave no valid frame several times in a row; the axis is no longer homed. Value: bad frames in a row.", "Card unplugged, without power, or the bus is disturbed.", "Check the card and its cable, clear the fault, enable and home the axis.", "Valid frames and the axis at rest, then CLEAR_FAULT.", kFault5Properties},
    Entry{6, "HOMING_TRAVEL", "Homing has used up its travel for this press of the pedal. Value: counts travelled.", "The limit switch is broken or unplugged, sits at the other end, or bounces for too long.", "Check the switch, clear the fault, enable and home again.", "The axis at rest, then CLEAR_FAULT.", kFault6Properties},
    Entry{7, "HOMING_TIMEOUT", "Homing has used up its time for this press of the pedal. Value: homing phase.", "The axis is too slow, or does not come to rest at the switch.", "Check the axis for friction, clear the fault, enable and home again.", "The axis at rest, then CLEAR_FAULT.", kFault7Properties},
    Entry{8, "CARD_RESET", "The card was reset, so that its counter means another place. Value: heartbeats since the last valid frame.", "The card lost power or restarted; the axis is no longer homed.", "Check the card's supply, clear the fault, enable and home the axis.", "The axis at rest, then CLEAR_FAULT.", kFault8Properties},
    Entry{9, "SWITCH", "The switch contradicts the position, or the two edges of homing differ. Value: counts from the place where it homed, or between the edges.", "A limit switch that is disturbed, loose or broken, or counts lost; the axis is no longer homed.", "Check the switch and its cable, clear the fault, enable and home the axis.", "The axis at rest, then CLEAR_FAULT.", kFault9Properties},
    Entry{10, "INTEGRITY", "Memory of the kernel was damaged; nothing is known of the axis.", "A memory fault or a stray write.", "Restart the kernel; if it happens again, take the computer out of service.", "The axis at rest, then CLEAR_FAULT.", kFault10Properties},
};
constexpr std::array<std::string_view, 1> kGate0Properties{"P1"};
constexpr std::array<std::string_view, 2> kGate1Properties{"P1", "P2"};
constexpr std::array<std::string_view, 2> kGate2Properties{"P1", "P2"};
constexpr std::array<std::string_view, 2> kGate3Properties{"P1", "P2"};
constexpr std::array<std::string_view, 1> kGate4Properties{"P1"};
constexpr std::array<std::string_view, 1> kGate5Properties{"P1"};
constexpr std::array<std::string_view, 3> kGate6Properties{"P1", "P10", "P12"};
constexpr std::array<std::string_view, 1> kGate7Properties{"P1"};
constexpr std::array<std::string_view, 1> kGate8Properties{"P3"};
constexpr std::array<std::string_view, 1> kGate9Properties{"P4"};
constexpr std::array<std::string_view, 1> kGate10Properties{"P7"};
constexpr std::array<std::string_view, 1> kGate11Properties{"P7"};
constexpr std::array<std::string_view, 1> kGate12Properties{"P5"};
constexpr std::array<Entry, 13> kGate{
    Entry{0, "OPEN", "The axis is driven.", "Every gate is open.", "None.", "Does not apply.", kGate0Properties},
    Entry{1, "MODE", "The system is not in MOTION.", "The pedal is not held, or the system is locked.", "Unlock if locked, then release, press and hold the pedal.", "MOTION.", kGate1Properties},
    Entry{2, "PEDAL", "Not every channel of the pedal reads pressed.", "The pedal is released or half-way.", "Press the pedal fully and hold it.", "All channels read pressed.", kGate2Properties},
    Entry{3, "ESTOP", "The E-stop is active.", "It was pulled.", "Release the E-stop and unlock.", "Loop closed.", kGate3Properties},
    Entry{4, "CARD", "The card's frame is not valid in this tick.", "A disturbed, late or repeated frame.", "Look at the card's row in the status panel.", "A valid frame.", kGate4Properties},
    Entry{5, "ENABLE", "The axis is not enabled, or is faulted.", "See the state of the axis.", "Clear the fault if there is one, then enable the axis.", "The axis is enabled.", kGate5Properties},
    Entry{6, "LEASE", "No move holds the axis.", "No MOVE was accepted, or its lease ran out.", "Propose a move.", "An accepted MOVE or HOME.", kGate6Properties},
    Entry{7, "SETPOINT", "The axis is at its setpoint, or homing waits for rest.", "The move has arrived.", "Propose another move.", "A setpoint outside the deadband.", kGate7Properties},
    Entry{8, "HARD_LIMIT", "The axis stands at its switch and may only move away from it.", "The limit switch is triggered or was not read validly.", "Move the axis the other way.", "The switch opens, or the move leads away.", kGate8Properties},
    Entry{9, "SOFT_LIMIT", "The axis is at its soft limit and may only move inward.", "The position is at the limit less the coasting distance, or where the switch may close.", "Move the axis the other way.", "The position is inside the range, or the move leads inward.", kGate9Properties},
    Entry{10, "UNHOMED_TRAVEL", "The axis is not homed and has used up its travel for this press of the pedal.", "An axis that is not homed moves only a short way.", "Release and press the pedal for another stretch, or home the axis.", "The pedal is pressed anew, or the axis is homed.", kGate10Properties},
    Entry{11, "DRIVE", "The drive that was asked for is above its bound.", "The axis lost its reference, or its configuration is damaged.", "Home the axis, or ask for less drive.", "A drive within its bound.", kGate11Properties},
    Entry{12, "STALL", "The axis was driven as long as it may be without progress.", "The axis is blocked, the motor is not powered, or the encoder does not count.", "Look for an obstacle and at the encoder cable.", "Progress, or an accepted CLEAR_FAULT of the stall.", kGate12Properties},
};
constexpr std::array<Entry, 42> kConfigError{
    Entry{0, "NONE", "The configuration is valid.", "", "", "", Names{}},
    Entry{1, "VERSION", "`version` is not the kernel's configuration version.", "", "", "", Names{}},
    Entry{2, "SIZE", "`size_bytes` is not the size of the kernel's configuration.", "", "", "", Names{}},
    Entry{3, "CRC", "`crc` does not match the words before it.", "", "", "", Names{}},
    Entry{4, "PERIOD", "`period_us` is not from 125 to 2000.", "", "", "", Names{}},
    Entry{5, "PEDAL_CHANNELS", "`pedal_channels` is not 1 or 2.", "", "", "", Names{}},
    Entry{6, "APP_TIMEOUT", "`app_timeout_ticks` is below 2 or more than 150 ms.", "", "", "", Names{}},
    Entry{7, "LEASE", "`lease_max_ticks` is below 2 or more than 150 ms.", "", "", "", Names{}},
    Entry{8, "PEDAL_DEBOUNCE", "`pedal_debounce_ticks` is zero or more than 50 ms.", "", "", "", Names{}},
    Entry{9, "PEDAL_DISAGREE", "`pedal_disagree_ticks` is zero or more than 50 ms.", "", "", "", Names{}},
    Entry{10, "BAD_FRAMES", "`bad_frame_limit` is not from 1 to 5.", "", "", "", Names{}},
    Entry{11, "OVERRUNS", "`overrun_limit` is not from 1 to 10.", "", "", "", Names{}},
    Entry{12, "NO_AXIS", "No slot has a motor card.", "", "", "", Names{}},
    Entry{13, "CARD", "`card` is not a known card type.", "", "", "", Names{}},
    Entry{14, "FLAG", "`required`, `motor_direction` or `direction_correction` is not 0 or 1.", "", "", "", Names{}},
    Entry{15, "EMPTY_SLOT", "A slot without a motor card has a field that is not zero, `card` and `required` apart; an empty slot is required.", "", "", "", Names{}},
    Entry{16, "LIMIT_SIDE", "`limit_side` is not NONE, LOWER or UPPER.", "", "", "", Names{}},
    Entry{17, "SOFT_LIMITS", "`min_counts` is not below `max_counts`, or a limit is beyond 2^30 counts.", "", "", "", Names{}},
    Entry{18, "HOME_OFFSET", "`home_offset_counts` is outside the soft limits, or leaves no room between where the switch is sure to be open and the coast before the other limit.", "", "", "", Names{}},
    Entry{19, "COAST", "`coast_counts` is zero, shorter than full speed in the latency of the loop, or min + coast is not below max - coast.", "", "", "", Names{}},
    Entry{20, "DEADBAND", "`deadband_counts` is zero or at least half of the range.", "", "", "", Names{}},
    Entry{21, "MAX_DRIVE", "`max_drive` is zero or more than the card's word can carry.", "", "", "", Names{}},
    Entry{22, "UNHOMED_DRIVE", "`unhomed_max_drive` is not above `dead_zone_drive`, or more than a tenth of the way from there to `max_drive`; or `dead_zone_drive` is more than a fifth of `max_drive`.", "", "", "", Names{}},
    Entry{23, "AMPLITUDE", "`max_amplitude` is not from 1 to 255 on a HIGH_FREQUENCY card, or not zero on another; `home_amplitude` exceeds it, or is not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{24, "UNHOMED_TRAVEL", "`unhomed_travel_counts` is not above `coast_counts`, or more than a tenth of the range.", "", "", "", Names{}},
    Entry{25, "HOME_DRIVE", "`home_drive` is not above `dead_zone_drive`, or more than `unhomed_max_drive`; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{26, "HOME_TRAVEL", "`home_travel_counts` does not cover the way from either stop with both back-offs and coast, or is more than four times the range; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{27, "HOME_CLEAR", "`home_clear_counts` does not cover tolerance, hysteresis and coast, or the progress that a stall asks for, or is more than a tenth of the range; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{28, "REST", "`rest_ticks` is not above the latency of the loop, shorter than the debounce of the switch, or more than 1000 ms.", "", "", "", Names{}},
    Entry{29, "HOME_TIMEOUT", "`home_timeout_ticks` does not cover the way of homing at its speeds, or is more than ten minutes; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{30, "STALL", "`stall_ticks` is more than 500 ms, or ends before `stall_min_counts`, backlash and noise are travelled at the slowest drive with the latency of the loop, or at full speed after a reversal; or these are not above `noise_counts`.", "", "", "", Names{}},
    Entry{31, "REVERSE", "`reverse_counts` does not cover coast, backlash and noise, or is more than a tenth of the range.", "", "", "", Names{}},
    Entry{32, "DRIFT", "`drift_counts` does not cover coast, backlash and noise, or is more than a tenth of the range.", "", "", "", Names{}},
    Entry{33, "STALL_EFFORT", "`stall_effort_ticks` is more than 200 ms, or too short for five times the coast, backlash and noise at full speed; or zero on an axis that is fast enough for it.", "", "", "", Names{}},
    Entry{34, "MAX_DELTA", "`max_delta_counts` is below full speed and noise in a tick, or more than half of the range.", "", "", "", Names{}},
    Entry{35, "SPEED", "A speed is zero or too high, or a slower drive of homing has a higher one; not zero for homing on an axis without a switch.", "", "", "", Names{}},
    Entry{36, "HOME_TOLERANCE", "`home_tolerance_counts` does not cover what homing travels in the debounce time, and noise, or is more than a tenth of the range; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{37, "HOME_SLOW", "`home_slow_drive` is not above `dead_zone_drive`, or more than `home_drive`; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{38, "POWER_UP", "`power_up_ticks` is zero or more than 5000 ms.", "", "", "", Names{}},
    Entry{39, "SWITCH_DEBOUNCE", "`switch_debounce_ticks` is below 2 or more than 20 ms.", "", "", "", Names{}},
    Entry{40, "HYSTERESIS", "`switch_hysteresis_counts` is more than a tenth of the range; not zero on an axis without a switch.", "", "", "", Names{}},
    Entry{41, "NOISE", "`noise_counts` or `backlash_counts` is more than a tenth of the range.", "", "", "", Names{}},
};
constexpr std::array<Entry, 6> kCard{
    Entry{0, "NONE", "Empty slot.", "", "", "", Names{}},
    Entry{1, "PWM", "External driver, PWM: speed and direction in wave 1.", "", "", "", Names{}},
    Entry{2, "NON_PWM", "External driver without PWM: speed, direction and enable bit in wave 1.", "", "", "", Names{}},
    Entry{3, "ANALOG", "External driver with an analog input: signed level in the analog word.", "", "", "", Names{}},
    Entry{4, "HIGH_FREQUENCY", "Piezo drive by two waves: lower frequency is faster.", "", "", "", Names{}},
    Entry{5, "SENSOR", "No motor; analog inputs only.", "", "", "", Names{}},
};
constexpr std::array<Entry, 3> kLimitSide{
    Entry{0, "NONE", "The axis has no switch.", "", "", "", Names{}},
    Entry{1, "LOWER", "The switch sits at the lower end; it blocks decreasing motion.", "", "", "", Names{}},
    Entry{2, "UPPER", "The switch sits at the upper end; it blocks increasing motion.", "", "", "", Names{}},
};
constexpr std::array<Entry, 3> kDirection{
    Entry{0, "NONE", "No motion.", "", "", "", Names{}},
    Entry{1, "INCREASING", "Towards larger positions.", "", "", "", Names{}},
    Entry{2, "DECREASING", "Towards smaller positions.", "", "", "", Names{}},
};
constexpr std::array<Entry, 7> kHomingPhase{
    Entry{0, "NONE", "Not homing.", "", "", "", Names{}},
    Entry{1, "LOOK", "Undriven, until the switch has read one way for the debounce time.", "", "", "", Names{}},
    Entry{2, "LEAVE", "The axis began on its switch and moves away until the switch is open and the axis clear.", "", "", "", Names{}},
    Entry{3, "SEEK", "Moves towards the switch.", "", "", "", Names{}},
    Entry{4, "BACK_OFF", "Moves away from the first edge until the switch is open and the axis clear.", "", "", "", Names{}},
    Entry{5, "APPROACH", "Moves towards the switch again, slowly.", "", "", "", Names{}},
    Entry{6, "REST", "At the second edge; waits until the axis is at rest.", "", "", "", Names{}},
};
constexpr std::array<Entry, 3> kHomed{
    Entry{0, "NOT", "The position has no reference.", "", "", "", Names{}},
    Entry{1, "BY_SWITCH", "By HOME, at the switch.", "", "", "", Names{}},
    Entry{2, "BY_HAND", "By SET_HOME, a person's word.", "", "", "", Names{}},
};
constexpr std::array<Entry, 3> kPedal{
    Entry{0, "RELEASED", "Every channel reads released.", "", "", "", Names{}},
    Entry{1, "PRESSED", "Every channel reads pressed.", "", "", "", Names{}},
    Entry{2, "DISAGREE", "The channels do not agree, or a contact was not read validly.", "", "", "", Names{}},
};
constexpr std::array<Entry, 4> kLamp{
    Entry{0, "PEDAL", "Green while MOTION holds, red while the E-stop is active, off otherwise.", "", "", "", Names{}},
    Entry{1, "NETWORK", "Green while the app is alive, red otherwise.", "", "", "", Names{}},
    Entry{2, "CONTROLLER", "Green in READY and MOTION, red while LOCKED.", "", "", "", Names{}},
    Entry{3, "STALL", "Purple while an axis has a STALL, amber while one has another fault.", "", "", "", Names{}},
};
constexpr std::array<Entry, 5> kColour{
    Entry{0, "OFF", "Dark.", "", "", "", Names{}},
    Entry{1, "GREEN", "Green.", "", "", "", Names{}},
    Entry{2, "RED", "Red.", "", "", "", Names{}},
    Entry{3, "AMBER", "Amber.", "", "", "", Names{}},
    Entry{4, "PURPLE", "Purple.", "", "", "", Names{}},
};

constexpr Entry kUnknown{UINT32_MAX, "UNKNOWN", "The catalog of this program does not have the code.", "App, kernel and console are of different versions.", "Do not move the robot; install all parts from the same release.", "A code of the catalog.", Names{}};

}  // namespace

std::span<const Entry> entries(Family family) noexcept {
  switch (family) {
    case Family::mode:
      return kMode;
    case Family::axis_state:
      return kAxisState;
    case Family::request:
      return kRequest;
    case Family::verdict:
      return kVerdict;
    case Family::cause:
      return kCause;
    case Family::fault:
      return kFault;
    case Family::gate:
      return kGate;
    case Family::config_error:
      return kConfigError;
    case Family::card:
      return kCard;
    case Family::limit_side:
      return kLimitSide;
    case Family::direction:
      return kDirection;
    case Family::homing_phase:
      return kHomingPhase;
    case Family::homed:
      return kHomed;
    case Family::pedal:
      return kPedal;
    case Family::lamp:
      return kLamp;
    case Family::colour:
      return kColour;
  }
  return {};
}

const Entry* find(Family family, std::uint32_t number) noexcept {
  const auto codes = entries(family);
  const auto found = std::ranges::find(codes, number, &Entry::number);
  return found == codes.end() ? nullptr : &*found;
}

const Entry* find(Family family, std::string_view name) noexcept {
  const auto codes = entries(family);
  const auto found = std::ranges::find(codes, name, &Entry::name);
  return found == codes.end() ? nullptr : &*found;
}

const Entry& entry(Family family, std::uint32_t number) noexcept {
  const Entry* found = find(family, number);
  return found == nullptr ? kUnknown : *found;
}

std::string name(Family family, std::uint32_t number) {
  const Entry* found = find(family, number);
  return found == nullptr ? "UNKNOWN_" + std::to_string(number) : std::string(found->name);
}

}  // namespace interlock::catalog
