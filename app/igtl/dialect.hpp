/**
 * @file
 * How a navigation program and the robot talk: which messages mean what, and what is answered in which order.
 *
 * One dialect object serves one connection. It decides what is said and what is requested; it sends nothing
 * and moves nothing.
 */
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "igtl/command.hpp"

namespace interlock::igtl {

/** x, y and z of a translation, then of a rotation, or what belongs to them. */
using Spatial = std::array<double, 6>;

/** What the robot tells of itself. */
struct RobotState {
  std::optional<Matrix> scanner_from_robot; /**< none without a valid registration */
  std::string registration_problem;         /**< why there is none, and so no pose; empty: there is one */
  std::optional<Matrix> measured_cp;        /**< treatment point by the encoders; none while it is unknown */
  std::optional<Matrix> desired_cp;         /**< treatment point at entry and target; none without these */
  /** Velocity of the treatment point along and about the scanner's axes, mm/s and rad/s. */
  std::optional<Spatial> measured_cv;
  /** Force on the needle along the scanner's axes, N, then zeroes; of a robot with a sensor for it. */
  std::optional<Spatial> measured_cf;
  std::optional<Position3> entry;
  std::optional<Position3> target;
  double treatment_to_tip_mm = 0.0;
  double robot_to_entry_mm = 0.0;
  double cannula_to_treatment_mm = 0.0;
  double treatment_to_robot_at_home_mm = 0.0;
  std::string mode;                /**< "manual" */
  std::string operating_state;     /**< of CRTK: DISABLED, PAUSED, ENABLED or FAULT */
  std::vector<double> measured_jp; /**< axes in the order of the robot's file, in their units */
  std::vector<double> measured_jv; /**< their velocities, units/s; empty while unknown */
  std::vector<double> desired_jp;
  bool is_probe_out = false; /**< homed, and as far out as it goes */
  Status health;
};

/** A message to be sent: its name, and what is in it. */
using Outgoing = std::pair<std::string, Body>;
/** Messages that go out, in their order. */
using Outgoings = std::vector<Outgoing>;

/** What became of a command. */
struct Outcome {
  Status status;
  std::optional<std::uint32_t> proposal = {}; /**< that it became; the motion has its own end */
  std::optional<Matrix> target = {};          /**< treatment point that entry and target ask for now */
  std::optional<Matrix> reachable = {};       /**< the nearest to it that the axes can do */
};

/** A motion that came of a command has changed. */
struct Motion {
  std::uint32_t proposal = 0; /**< its number */
  bool is_over = false;
  Status status;
};

/** What follows from a message or an outcome. */
struct Reaction {
  Outgoings replies;                      /**< to be sent at once, in this order */
  std::optional<Command> command;         /**< to be carried out; its outcome is for `finish` */
  std::optional<std::uint32_t> ends = {}; /**< a proposal that is wanted no more */
  std::string refused = {};            /**< why the message is refused, for the log; empty when it is not */
  std::optional<ImagerWord> word = {}; /**< of an imager, to be kept and shown */
};

/** Names of messages that stop the robot, whatever their type and content. */
enum class StopName : std::uint8_t { stop, emergency };

/** Which of them it is, in upper or lower case; nothing when it is none. */
std::optional<StopName> stop_name(std::string_view device);

/** Whether a text under that name is a request of some dialect, be it for a STOP. */
bool may_ask_to_stop(std::string_view device);

/** Whether it stops the robot in some dialect, by its name or by its text. */
bool asks_to_stop(const Message& message);

/** What a STRING says that is named BREATHING_GATE, in upper or lower case ("hold", "open", or "open 300":
 * valid for so many ms), or SCAN ("on", "off"), in every dialect; nothing of any other message. */
std::optional<tl::expected<HoldMessage, Unwanted>> read_hold(const Message& message);

/** Names and order of messages: what a message asks for, and how state and answers are told. */
class Dialect {
 public:
  /** A time of the clock that dialects run on. */
  using Time = std::chrono::steady_clock::time_point;

  Dialect() = default;
  Dialect(const Dialect&) = delete;
  Dialect& operator=(const Dialect&) = delete;
  virtual ~Dialect() = default;

  /** A message came; `controls`: from the controller. One that is named STOP or EMERGENCY stops the robot,
   * whatever else it says and whoever sends it. */
  Reaction take(const Message& message, const RobotState& state, bool controls);

  /** A message came that cannot be read, but for its name: STOP and EMERGENCY stop the robot. */
  Reaction take_broken(const std::string& device, const Status& fault);

  /** A command that came under that name was carried out or refused. */
  virtual Reaction finish(const std::string& device, const Command& command, const Outcome& outcome) = 0;

  /** A motion has changed. */
  virtual Outgoings follow(const Motion& motion, const RobotState& state) = 0;

  /** What is to be told whenever it changes. */
  [[nodiscard]] virtual Outgoings told(const RobotState& state) const = 0;

  /** What is due by now; asked ten times a second and more. `has_to_hear`: something at least, by which it is
   * seen whether the peer is still there. */
  virtual Outgoings heartbeat(Time now, const RobotState& state, bool has_to_hear) = 0;

 protected:
  /** A message of another name than STOP and EMERGENCY. */
  virtual Reaction take_named(const Message& message, const RobotState& state, bool controls) = 0;

  /** What to say of a message that cannot be read. */
  [[nodiscard]] virtual Outgoings refuse_broken(const std::string& device, const Status& fault) const = 0;

  /** A message of that name came, which stops the robot. */
  virtual Reaction stop(StopName name) = 0;
};

/** The dialect of that name of the robot's file, for one connection; null when there is none. */
std::unique_ptr<Dialect> make_dialect(std::string_view name);

/** Whether a command changes what the robot will do, hence is the controller's alone. */
bool needs_control(const Command& command) noexcept;

/** The poses as one TDATA message. */
TrackingData tracking_of(const RobotState& state);

/** What a query asks for: of `known`, what bears that name, or all of that type when the name is empty; else
 * what every dialect knows. STATUS 4 when there is no such thing. */
Reaction answer_query(const Query& query, const std::string& device, const Outgoings& known,
                      const RobotState& state);

/** A name in lower case. */
std::string lower(std::string_view text);

}  // namespace interlock::igtl
