/**
 * @file
 * What navigation programs ask for, whatever their dialect.
 *
 * Poses and points are in the scanner's frame (RAS), mm. Nothing here moves anything: a command becomes a
 * setting or a proposal elsewhere, or is refused there.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "igtl/message.hpp"
#include "motion/outside_holds.hpp"

namespace interlock::igtl {

/** The robot's pose in the scanner. */
struct SetRegistration {
  Matrix scanner_from_robot;
};

/** Where an imager sees the probe. It is noted, and never takes the encoders' place. */
struct ReportPose {
  Matrix scanner_from_probe;
};

/** Entry or target. */
struct SetPoint {
  bool is_target = false;
  Position3 position{};
};

/** A number of the probe, by its name in the app's interface: "treatment_to_tip_offset". */
struct SetOffset {
  std::string_view field;
  double mm = 0.0;
};

/** A trajectory: rows of a time in s, then for each axis its position, or its position and velocity. */
struct LoadRows {
  std::size_t columns = 0;
  std::vector<double> values; /**< row by row */
};

/** Where the probe's treatment point is to be, and when. */
struct TimedPose {
  double time_s = 0.0;
  Matrix scanner_from_treatment;
};

/** A trajectory of such poses. */
struct LoadPoses {
  std::vector<TimedPose> poses;
};

/** A mode, in lower case. */
struct SetMode {
  std::string mode;
};

/** Ends all motion, whoever asks for it. */
struct Stop {
  bool cuts_power = false; /**< and disables every axis */
  bool is_answered = true; /**< one in a STATUS is not, else two programs would answer each other for ever */
};

/** Homing, unless every axis is homed. */
struct StartUp {};

/** Entry and target by the pose that the probe's treatment point is to have: it comes along the third axis.
 */
struct SetTargetPose {
  Matrix scanner_from_target;
};

/** Aligns the probe with entry and target, then inserts it. */
struct MoveToTarget {};

/** Takes the probe out as far as it goes. */
struct RetractProbe {};

/** Ends motion and disables every axis. */
struct CutPower {};

/** Poses as TDATA, again and again. */
struct Track {
  std::optional<std::int32_t> interval_ms; /**< none: stop it */
};

/** What an imager says of itself. */
struct ImagerStatus {
  std::optional<StatusCode> code; /**< none when it came as a text alone */
  std::string name;               /**< error name; empty of a text */
  std::string text;
};

/** Where an imager sees the needle's tip. It is shown, and takes no encoder's place. */
struct TipPose {
  Matrix scanner_from_tip;
};

/** A word of an imager, for people to see. */
using ImagerWord = std::variant<ImagerStatus, TipPose>;

/** What a breathing gate says, and for how long. */
struct GateSignal {
  bool open = false; /**< the insertion may advance */
  std::chrono::milliseconds validity{0};
};

/** A scan begins, or has ended. */
struct ScanState {
  bool active = false;
};

/** What holds motion still; any program may say it. */
using HoldMessage = std::variant<GateSignal, ScanState>;

/** Heard and noted, and nothing follows. */
struct Noted {
  bool is_answered = true; /**< a STATUS is not, else two programs would answer each other for ever */
  std::optional<ImagerWord> word = {};
};

/** Anything that a message may ask for. */
using Command =
    std::variant<SetRegistration, ReportPose, SetPoint, SetOffset, LoadRows, LoadPoses, SetMode, Stop,
                 StartUp, SetTargetPose, MoveToTarget, RetractProbe, CutPower, Track, Noted>;

/** Why a message is refused. */
struct Unwanted {
  StatusCode code = StatusCode::unknown_error;
  std::string reason;
};

/** What a message asks for, or why it is refused. */
using Reading = tl::expected<Command, Unwanted>;

/** Refuses a message: the status that its sender gets, and the reason in words. */
inline tl::unexpected<Unwanted> unwanted(StatusCode code, std::string reason) {
  return tl::unexpected(Unwanted{code, std::move(reason)});
}

}  // namespace interlock::igtl
