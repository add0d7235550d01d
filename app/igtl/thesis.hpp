/**
 * @file
 * The dialect of the thesis (section 4.2.6): what a message of a navigation program asks for, by its name,
 * and what the robot tells of itself. Names are taken in upper or lower case; each message is answered by a
 * STATUS under its name.
 */
#pragma once

#include <tl/expected.hpp>

#include "igtl/dialect.hpp"

namespace interlock::igtl {

class Thesis final : public Dialect {
 public:
  Reaction take(const Message& message, const RobotState& state, bool controls) override;
  Outgoings take_broken(const std::string& device, const Status& fault) override;
  Reaction finish(const std::string& device, const Command& command, const Outcome& outcome) override;
  Outgoings follow(const Motion& motion, const RobotState& state) override;
  [[nodiscard]] Outgoings told(const RobotState& state) const override;
  Outgoings heartbeat(Time now, const RobotState& state, bool has_to_hear) override;
};

/** What the message, which is no query, asks for. */
tl::expected<Command, Unwanted> read_change(const Message& message);

/** Everything that the robot tells, under the names of the thesis and its successors and under those of CRTK
 * (setpoint_cp, measured_js). */
Outgoings messages_of(const RobotState& state);

}  // namespace interlock::igtl
