/**
 * @file
 * A proposal: one wished-for motion, a move of one axis, homing, or a path of several axes, its author and
 * what became of it.
 *
 *     drafted -> checked -> approved -> executing <-> paused
 *        |          |          |            |
 *        +----------+----------+------------+--> done, refused, aborted or expired, which are final
 */
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interlock/link.h"
#include "kinematics/pose.hpp"
#include "motion/biopsy_run.hpp"
#include "motion/order.hpp"
#include "motion/path_program.hpp"
#include "proposals/check_list.hpp"
#include "robot/modes.hpp"
#include "time/utc_time.hpp"

namespace interlock {

/** Where a proposal stands on its way. */
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

/** Whether the proposal is open and nothing but the pedal keeps it from motion. */
bool is_approved(ProposalState state) noexcept;

/** Whether the proposal may go from one state to the other. */
bool may_become(ProposalState from, ProposalState to) noexcept;

/** A wish for a move of one axis. */
struct MoveDraft {
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;
  std::optional<std::uint32_t> drive; /**< upper bound; empty: the axis' own */
  std::string author;
  bool held = false; /**< a jog: it ends unless its hold is renewed */
};

/** Who thought of a motion. */
enum class ProposalSource : std::uint8_t {
  console,    /**< somebody who watches the robot: proposing it approves it */
  file,       /**< a loaded trajectory: somebody has to approve it, unless the robot file says otherwise */
  openigtlink /**< a navigation program: as a file */
};

/** As the interface spells it. */
constexpr std::string_view source_name(ProposalSource source) noexcept {
  constexpr std::string_view names[] = {"console", "file", "openigtlink"};
  return names[static_cast<std::size_t>(source)];
}

/** A wish for homing: of one axis, of one step, or of all steps in the order of the robot's file. */
struct HomeDraft {
  std::optional<std::uint32_t> slot;
  std::optional<std::string> step; /**< name; not together with `slot` */
  std::string author;
  ProposalSource source = ProposalSource::console;
};

/** A wish for a motion of several axes together. */
struct PathDraft {
  RobotMode mode = RobotMode::coordinated;
  std::shared_ptr<const PathProgram> program; /**< never null */
  ProposalSource source = ProposalSource::console;
  /** It follows from registration, probe and target of that revision: stale once these change. */
  std::optional<std::uint32_t> targeting_revision;
  std::string author;
};

/** A wish to turn a high-frequency axis at one frequency after the other. */
struct SweepDraft {
  std::uint32_t slot = 0;
  FrequencySteps steps;
  std::string author;
};

/** A wish to take a biopsy at a target. */
struct BiopsyDraft {
  std::shared_ptr<BiopsyRun> run;    /**< never null; the control thread's once it is approved */
  std::array<double, 3> target_mm{}; /**< in the guide frame of motion/biopsy_run.hpp */
  std::string author;
  std::uint32_t start_tick = 0; /**< kernel tick of the run's time 0 */
  /** The guide frame in the scanner's, where the target was given in that. */
  std::optional<Pose> scanner_from_guide;
  std::optional<std::uint32_t> targeting_revision; /**< as of a `PathDraft` */
};

/** What would move. */
enum class ProposalKind : std::uint8_t { move, home, path, sweep, biopsy };

/** As the interface spells it. */
constexpr std::string_view kind_name(ProposalKind kind) noexcept {
  constexpr std::string_view names[] = {"move", "home", "path", "sweep", "biopsy"};
  return names[static_cast<std::size_t>(kind)];
}

/** One motion that somebody proposed. */
struct Proposal {
  std::uint32_t id = 0;
  ProposalKind kind = ProposalKind::move;
  MoveDraft move;                         /**< of kind move */
  HomeDraft home;                         /**< of kind home */
  PathDraft path;                         /**< of kind path */
  BiopsyDraft biopsy;                     /**< of kind biopsy */
  SweepDraft sweep;                       /**< of kind sweep */
  std::string author;                     /**< name of the user */
  std::vector<std::uint32_t> slots;       /**< of all axes that it moves, each once */
  std::vector<std::string> axes;          /**< their names */
  std::string axis;                       /**< name of the axis; empty when there are several */
  double target = 0.0;                    /**< in the axis' unit; of kind move */
  std::uint32_t first_step = 0;           /**< index of the robot's home steps; of kind home */
  std::uint32_t step_count = 0;           /**< home steps; 0: none but the axis alone */
  std::string step;                       /**< name of the home step that runs or is next; else empty */
  std::vector<AxisCounts> ends;           /**< where the axes come to rest; of kind path, once checked */
  double duration_s = 0.0;                /**< of the planned motion; of kind path, once checked */
  std::uint32_t leg = 0;                  /**< index of the leg that runs or is next; of kind path */
  std::vector<float> speeds_counts_per_s; /**< measured at each frequency that is over; of kind sweep */
  ProposalState state = ProposalState::drafted;
  UtcTime created;
  std::uint32_t created_tick = 0; /**< kernel tick */
  std::optional<UtcTime> ended;
  std::optional<std::string> verdict; /**< that refused or ended it */
  std::vector<CheckResult> checks;    /**< as last made, in their order */
  /** The kernel as it was when the checks were last made; null before. Plans begin there. */
  std::shared_ptr<const ilk_snapshot_t> checked_against;
  std::string detail; /**< why it is in this state, for people */
};

/** Of registration, probe and target from which the proposal followed; nothing: from none. */
std::optional<std::uint32_t> targeting_revision(const Proposal& proposal) noexcept;

/** Who thought of it. */
ProposalSource source_of(const Proposal& proposal) noexcept;

/** The mode in which the proposal is carried out. */
RobotMode robot_mode(const Proposal& proposal) noexcept;

}  // namespace interlock
