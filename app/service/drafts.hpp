/**
 * @file
 * From what somebody asks for to a task, and from a task to a proposal.
 */
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "igtl/command.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"
#include "service/context.hpp"
#include "service/reply.hpp"
#include "service/targeting.hpp"
#include "trajectory/timed_trajectory.hpp"
#include "trajectory/trajectory_error.hpp"

namespace interlock {

/** A kind of `ProposalDraft` (spec/openapi.yaml). */
struct DraftKind {
  /** A task, or why there is none. */
  using Reading = boost::asio::awaitable<tl::expected<Task, Problem>>;

  std::string_view name; /**< field `kind` of the draft; empty: it is asked for by its mode alone */
  std::string_view
      mode; /**< that PUT /api/mode asks for by this draft without fields; empty: it needs some */
  /** Reads the draft, `kind` included. */
  Reading (*read)(const Context& context, nlohmann::json body, std::string author);
};

/** Every kind, by the names of the folders below app/modes; each has `FOLDER_drafts()` in its drafts.cpp. */
std::span<const DraftKind> draft_kinds();

/** The axis in that slot; 404 NOT_FOUND when there is none. */
tl::expected<const Axis*, Problem> axis_in(const Robot& robot, std::int64_t slot);

/** Where every axis stands by which one knows where the probe is: what a treatment rests on. */
std::vector<AxisCounts> standing(const Robot& robot, const ControlView& view);

/** Nothing, where a draft has no field but its kind; else 422 INVALID. */
tl::expected<void, Problem> without_fields(const nlohmann::json& body);

// Trajectories as navigation programs send them, without a header: rows of numbers, or poses in time.
//
// Both are read whole or refused with the number of the first bad row, counted from 1, and its column.

/** A time, then of each axis in the file's order its position, or its position and its velocity. */
tl::expected<TimedTrajectory, Problem> trajectory_of(const Robot& robot, const igtl::LoadRows& rows);

/**
 * Each pose becomes the setpoints of the alignment with it (targeting/alignment.hpp); between poses the axes
 * go straight. A pose says where the treatment point is and which way the probe comes; how the probe is
 * turned about that way is not taken over. A pose that an axis ends before is refused, not moved.
 */
tl::expected<TimedTrajectory, Problem> trajectory_of(const Robot& robot, const Targeting& targeting,
                                                     const igtl::LoadPoses& poses);

// How a trajectory comes to be the loaded one, by whichever way it came.

/** 422 with the code of the error: nothing was loaded. */
Problem unreadable(const TrajectoryError& error);

/**
 * Records it and loads it; nothing is loaded when that fails, or the caller lost session or control
 * meanwhile (`Context::announce`). `targeting_revision`: of registration, probe and target from which it
 * followed, if it did.
 */
boost::asio::awaitable<tl::expected<void, Problem>> load_trajectory(
    const Context& context, Caller caller, TimedTrajectory trajectory,
    std::optional<std::uint32_t> targeting_revision = std::nullopt);

// Motions of several axes that somebody may propose, out of what the robot's file, the targeting or the
// loaded trajectory say.

/** How far an alignment goes. */
struct PoseRequest {
  bool insert = false; /**< insert the probe once it is aligned */
  /** Deviation of the reachable pose that somebody has accepted, in place of what the robot's file allows. */
  std::optional<double> accepted_mm = std::nullopt;
  std::optional<double> accepted_deg = std::nullopt;
};

/** The setpoints in which the robot is draped; 404 NOT_FOUND when its file has none. */
tl::expected<Task, Problem> draping_draft(const Robot& robot, const std::string& author);

/** The probe out as far as it goes, whatever registration and case are; 404 NOT_FOUND when none is inserted.
 */
tl::expected<Task, Problem> retraction_draft(const Robot& robot, const std::string& author);

/** The loaded trajectory; 409 EMPTY when none is. */
tl::expected<Task, Problem> trajectory_draft(const LoadedTrajectory& loaded, const std::string& author);

/**
 * Aligns the probe with entry and target: takes the probe out as far as it goes, moves all other axes
 * together, then inserts the probe, if that is requested. 409 UNREACHABLE when the axes miss the pose by more
 * than is allowed or was accepted; or a problem of `alignment_with`.
 */
boost::asio::awaitable<tl::expected<Task, Problem>> pose_draft(const Context& context, PoseRequest request,
                                                               std::string author);

// Sweeps of frequency that somebody may propose.

/**
 * What a `ProposalDraft` (spec/openapi.yaml) of kind `sweep` asks for; 404 NOT_FOUND for a robot without the
 * mode. Whether the frequencies are in the band of the axis is not judged here.
 */
tl::expected<Task, Problem> sweep_draft(const Robot& robot, const nlohmann::json& body,
                                        const std::string& author);

/** The whole band of the robot's first high-frequency axis, in published steps of a second each. */
tl::expected<Task, Problem> whole_sweep_draft(const Robot& robot, const std::string& author);

// A biopsy that somebody may propose, at a point of the guide frame or at the target of the targeting.

/**
 * A biopsy at `target_mm` in the guide frame (motion/biopsy_run.hpp), or without it at the target point of
 * the targeting, seen from where registration and encoders say that the needle is. Then also 409 NO_TARGET
 * and NOT_HOMED, a problem of the kinematics, or UNREACHABLE when the target lies farther beside the needle's
 * way than the needle can bend; and the proposal ends when registration, probe or target change.
 */
boost::asio::awaitable<tl::expected<Task, Problem>> biopsy_draft(
    const Context& context, std::optional<std::array<double, 3>> target_mm, std::string author);

// From a task that somebody wants to a proposal in the registry.

/**
 * Records the task in the audit, then proposes it. Nothing is proposed when that fails (503 STORE), when the
 * caller lost session or control meanwhile (401 LOGIN, 409 CONTROL), when STOP was pressed meanwhile
 * (409 STOPPED), without a kernel or a present state of it (503 NO_KERNEL), or when the registry refuses (its
 * refusal).
 */
boost::asio::awaitable<tl::expected<Proposal, Problem>> propose(const Context& context, const Caller& caller,
                                                                Task task);

// What there is to look at before somebody approves a proposal: its checks, the profile of its motion, and
// its ghost, the robot and the way of its tip in the scanner. Schema `ProposalPlan` of spec/openapi.yaml.

/** Takes some tens of milliseconds for a long path: no work for the network thread. */
nlohmann::json proposal_plan(const Robot& robot, const ilk_config_t& config, const Targeting& targeting,
                             const Proposal& proposal);

}  // namespace interlock
