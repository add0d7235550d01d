/**
 * @file
 * What the robot is and does, as JSON and as messages of the stream.
 */
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "motion/realtime_channel.hpp"
#include "proposals/motion_registry.hpp"
#include "robot/robot.hpp"

namespace interlock {

// The view in words: schemas `Status`, `Motor` and the stream's event message of spec/openapi.yaml.

/** Power is on, and has been for long enough that the amplifiers obey. */
bool power_is_up(const ilk_config_t& config, const ilk_snapshot_t& snapshot);

/** Schema `Status`. */
nlohmann::json status_json(const Robot& robot, const ilk_config_t& config, const ControlView& view,
                           std::string_view app_mode, std::chrono::steady_clock::time_point now);

/** Schema `Motor`. */
nlohmann::json motor_json(const Axis& axis, const ilk_config_t& config, const ControlView& view,
                          const MotionRegistry& registry);

/** Text message of the stream for a kernel event. */
nlohmann::json event_json(const ilk_event_t& event);

/** The same in a sentence, for the log. */
std::string event_words(const Robot& robot, const ilk_event_t& event);

/** What a STOP is answered with: the kernel's verdict and tick, null when none came in time. */
nlohmann::json stop_json(const std::optional<StopAnswer>& answer);

/** Text message of the stream that says that `count` events were lost. */
nlohmann::json events_lost_json(std::uint32_t count);

// The binary state message of the stream: `x-stream` of spec/openapi.yaml.

constexpr std::uint32_t stream_magic = 0x53574b49;
constexpr std::uint32_t stream_version = 3;
constexpr std::size_t stream_header_words = 20;
constexpr std::size_t stream_slot_words = 16;
constexpr std::size_t stream_state_words = sizeof(ilk_state_t) / 4;
constexpr std::size_t stream_bytes =
    4 * (stream_header_words + ILK_SLOTS * stream_slot_words + stream_state_words);

/** One binary message. */
using StreamMessage = std::array<std::uint8_t, stream_bytes>;

/** Target of the open proposal of each axis that has one. */
struct OpenTarget {
  bool open = false;
  std::int32_t target_counts = 0;
};
/** For each slot, where its open proposal leads. */
using OpenTargets = std::array<OpenTarget, ILK_SLOTS>;

/** Of the moves that are open in the registry. */
OpenTargets open_targets(const Robot& robot, const MotionRegistry& registry);

/** The view at that time, little-endian. Without a kernel everything but magic, version and slot count is
 * zero. */
StreamMessage encode_state(const ControlView& view, const ilk_config_t& config, const OpenTargets& targets,
                           std::chrono::steady_clock::time_point now);

}  // namespace interlock
