/**
 * @file
 * The binary state message of the stream: `x-stream` of spec/openapi.yaml.
 */
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "motion/mailbox.hpp"
#include "proposals/proposal_book.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

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

/** Of the moves that are open in the book. */
OpenTargets open_targets(const Robot& robot, const ProposalBook& book);

/** The view at that time, little-endian. Without a kernel everything but magic, version and slot count is
 * zero. */
StreamMessage encode_state(const ControlView& view, const ilk_config_t& config, const OpenTargets& targets,
                           std::chrono::steady_clock::time_point now);

}  // namespace interlock::web
