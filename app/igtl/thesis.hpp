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
  Reaction finish(const std::string& device, const Command& command, const Outcome& outcome) override;
  Outgoings follow(const Motion& motion, const RobotState& state) override;
  [[nodiscard]] Outgoings told(const RobotState& state) const override;
  Outgoings heartbeat(Time now, const RobotState& state, bool has_to_hear) override;

 protected:
  Reaction take_named(const Message& message, const RobotState& state, bool controls) override;
  [[nodiscard]] Outgoings refuse_broken(const std::string& device, const Status& fault) const override;
  Reaction stop(StopName name) override;
};

/** What the message asks for, which is no query and not named STOP or EMERGENCY. */
tl::expected<Command, Unwanted> read_change(const Message& message);

/** Everything that the robot tells, under the names of the thesis and its successors and under those of CRTK
 * (setpoint_cp, measured_js). */
Outgoings messages_of(const RobotState& state);

}  // namespace interlock::igtl
