/**
 * @file
 * The dialect of the thesis (section 4.2.6): what a message of a navigation program asks for, by its name,
 * and what the robot tells of itself.
 *
 * Poses and points are in the scanner's frame (RAS), mm. Names are taken in upper or lower case. Nothing here
 * moves anything: a wish becomes a setting or a proposal elsewhere, or is refused there.
 */
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "igtl/message.hpp"

namespace interlock::igtl {

/** REGISTRATION: the robot's pose in the scanner. */
struct SetRegistration {
  Matrix scanner_from_robot;
};

/** CURRENT_POSE: where an imager sees the probe. It is noted, and never takes the encoders' place. */
struct ReportPose {
  Matrix scanner_from_probe;
};

/** ENTRY_POINT or TARGET_POINT. */
struct SetPoint {
  bool is_target = false;
  Position3 position{};
};

/** A number of the probe, by its name in the app's interface: "treatment_to_tip_offset". */
struct SetOffset {
  std::string_view field;
  double mm = 0.0;
};

/** TRAJECTORY: rows of a time in s, then for each axis its position, or its position and velocity. */
struct LoadRows {
  std::size_t columns = 0;
  std::vector<double> values; /**< row by row */
};

/** MODE, in lower case. */
struct SetMode {
  std::string mode;
};

/** STOP and EMERGENCY. */
struct Stop {};

/** GET_ of something: every message of that name, or of that type when the name is empty. */
struct Show {
  Query query;
  std::string device;
};

/** STT_TDATA and STP_TDATA. */
struct Track {
  std::optional<std::int32_t> interval_ms; /**< none: stop it */
};

/** Heard and noted, and nothing follows: TIP_POSE, IMAGER_STATUS, any STATUS, what a client can do. */
struct Noted {
  bool is_answered = true; /**< a STATUS is not, else two programs would answer each other for ever */
};

using Wish = std::variant<SetRegistration, ReportPose, SetPoint, SetOffset, LoadRows, SetMode, Stop, Show,
                          Track, Noted>;

/** Why a message is refused. */
struct Unwanted {
  StatusCode code = StatusCode::unknown_error;
  std::string reason;
};

/** What the message asks for. */
tl::expected<Wish, Unwanted> read_wish(const Message& message);

/** Whether a wish changes what the robot will do, hence is the controller's alone. */
bool needs_control(const Wish& wish) noexcept;

/** What the robot tells of itself. */
struct RobotState {
  Matrix scanner_from_robot = Transform{}.matrix;
  std::optional<Matrix> measured_cp; /**< treatment point by the encoders; none while it is unknown */
  std::optional<Matrix> desired_cp;  /**< treatment point at entry and target; none without these */
  std::optional<Position3> entry;
  std::optional<Position3> target;
  double treatment_to_tip_mm = 0.0;
  double robot_to_entry_mm = 0.0;
  double cannula_to_treatment_mm = 0.0;
  double treatment_to_robot_at_home_mm = 0.0;
  std::string mode;                /**< "manual" */
  std::vector<double> measured_jp; /**< axes in the order of the robot's file, in their units */
  std::vector<double> measured_jv; /**< their velocities, units/s; empty while unknown */
  std::vector<double> desired_jp;
  Status health;
};

/** A message to be sent: its name, and what is in it. */
using Outgoing = std::pair<std::string, Body>;

/** Everything that the robot tells, under the names of the thesis and its successors and under those of CRTK
 * (setpoint_cp, measured_js). */
std::vector<Outgoing> messages_of(const RobotState& state);

/** The poses as one TDATA message. */
TrackingData tracking_of(const RobotState& state);

}  // namespace interlock::igtl
