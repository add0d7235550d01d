/**
 * @file
 * The names of the Collaborative Robotics Toolkit (CRTK), as the bridges of the dVRK speak them over
 * OpenIGTLink: measured_cp, measured_js, operating_state and so on, each with "arm/" before it, too. Unlike
 * there, lengths are mm, as everywhere in OpenIGTLink.
 */
#pragma once

#include <optional>
#include <string_view>
#include <tl/expected.hpp>

#include "igtl/dialect.hpp"

namespace interlock::igtl {

/** What CRTK tells of that state. */
Outgoings crtk_messages(const RobotState& state);

/** What CRTK tells of a motion that has changed: a status, or a warning when it came to nothing. */
Outgoings crtk_event(const Motion& motion);

/** Of a command of CRTK, in lower case and with or without a namespace before it, what it asks for; nothing
 * for another name. */
std::optional<tl::expected<Command, Unwanted>> crtk_command(std::string_view name, const Message& message);

}  // namespace interlock::igtl
