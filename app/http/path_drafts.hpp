/**
 * @file
 * Motions of several axes that somebody may propose, out of what the robot's file, the targeting or the
 * loaded trajectory say.
 */
#pragma once

#include "http/context.hpp"

namespace interlock::web {

/** How far an alignment goes. */
struct PoseWish {
  bool reachable = false; /**< take the reachable pose where the desired one cannot be had */
  bool insert = false;    /**< insert the probe once it is aligned */
};

/** Positions in the axes' units by name, reached together in `minimum_duration_s` at least. */
tl::expected<Task, Problem> coordinated_draft(const Robot& robot, const nlohmann::json& targets,
                                              double minimum_duration_s, const std::string& author);

/**
 * Turns and inserts the probe through `steps`, an array of `AblationStep` (spec/openapi.yaml), resting at
 * each; 404 NOT_FOUND for a robot without a probe to turn.
 */
tl::expected<Task, Problem> ablation_draft(const Robot& robot, const nlohmann::json& steps,
                                           const std::string& author);

/** The setpoints in which the robot is draped; 404 NOT_FOUND when its file has none. */
tl::expected<Task, Problem> draping_draft(const Robot& robot, const std::string& author);

/** The loaded trajectory; 409 EMPTY when none is. */
tl::expected<Task, Problem> trajectory_draft(const LoadedTrajectory& loaded, const std::string& author);

/**
 * Aligns the probe with entry and target: takes the probe out as far as it goes, moves all other axes
 * together, then inserts the probe, if that is wished for. 409 UNREACHABLE when an axis would have to go
 * beyond its range and the reachable pose was not asked for; or a problem of `alignment_with`.
 */
boost::asio::awaitable<tl::expected<Task, Problem>> pose_draft(const Context& context, PoseWish wish,
                                                               std::string author);

}  // namespace interlock::web
