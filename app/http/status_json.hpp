/**
 * @file
 * The view in words: schemas `Status`, `Motor` and the stream's event message of spec/openapi.yaml.
 */
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "motion/mailbox.hpp"
#include "proposals/proposal_book.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

/** Power is on, and has been for long enough that the amplifiers obey. */
bool power_is_up(const ilk_config_t& config, const ilk_snapshot_t& snapshot);

/** Schema `Status`. */
nlohmann::json status_json(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                           std::string_view app_mode, std::chrono::steady_clock::time_point now);

/** Schema `Motor`. */
nlohmann::json motor_json(const Axis& axis, const ilk_config_t& config, const ControlView& view,
                          const ProposalBook& book);

/** Text message of the stream for a kernel event. */
nlohmann::json event_json(const ilk_event_t& event);

/** What a STOP is answered with: the kernel's verdict and tick, null when none came in time. */
nlohmann::json stop_json(const std::optional<StopAnswer>& answer);

/** Text message of the stream that says that `count` events were lost. */
nlohmann::json events_lost_json(std::uint32_t count);

}  // namespace interlock::web
