/**
 * @file
 * A proposal: one wished-for motion, its author and what became of it.
 *
 *     drafted -> checked -> approved -> executing <-> paused
 *        |          |          |            |
 *        +----------+----------+------------+--> done, refused, aborted or expired, which are final
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "time/utc_time.hpp"

namespace interlock {

enum class ProposalState : std::uint8_t {
  drafted,
  checked,
  approved,
  executing,
  paused,
  done,
  refused,
  aborted,
  expired
};

/** As the interface spells it: "drafted". */
std::string_view state_name(ProposalState state) noexcept;

/** Whether the proposal can still become motion. */
bool is_open(ProposalState state) noexcept;

/** Whether the proposal may go from one state to the other. */
bool may_become(ProposalState from, ProposalState to) noexcept;

/** A wish for a move of one axis. */
struct MoveDraft {
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;
  std::optional<std::uint32_t> drive; /**< upper bound; empty: the axis' own */
  std::string author;
};

struct Proposal {
  std::uint32_t id = 0;
  MoveDraft move;
  std::string axis;    /**< name of the axis */
  double target = 0.0; /**< in the axis' unit */
  ProposalState state = ProposalState::drafted;
  UtcTime created;
  std::uint32_t created_tick = 0; /**< kernel tick */
  std::optional<UtcTime> ended;
  std::optional<std::string> verdict; /**< that refused or ended it */
  std::string detail;                 /**< why it is in this state, for people */
};

}  // namespace interlock
