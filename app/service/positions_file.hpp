/**
 * @file
 * Positions of the axes as a file: schemas `PositionsFile` and `PositionsComparison` of spec/openapi.yaml.
 */
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "robot/robot.hpp"
#include "service/reply.hpp"
#include "service/status_json.hpp"
#include "system/utc_time.hpp"

namespace interlock {

/** One axis of a saved file. Only the position is ever put back. */
struct SavedAxis {
  std::uint32_t slot = 0;
  std::int32_t position_counts = 0;
  std::optional<std::int32_t> setpoint_counts; /**< of the proposal that was open */
  bool enabled = false;
  bool homed = false;
};

/** A saved file that belongs to this robot and configuration. */
struct SavedPositions {
  UtcTime saved;
  std::vector<SavedAxis> axes; /**< every axis of the robot, in the order of its file */

  /** The saved axis of that slot, or null. */
  [[nodiscard]] const SavedAxis* at_slot(std::uint32_t slot) const;
};

/** The present positions as a file. It names the configuration that the kernel runs. */
nlohmann::json positions_file(const Robot& robot, const ControlView& view, const OpenTargets& targets,
                              UtcTime now);

/** Name to save it under: "neuro-positions-20240501T123456Z.json". */
std::string positions_file_name(const Robot& robot, UtcTime now);

/**
 * Reads a saved file, strictly: every field, no other, each axis of the robot once.
 *
 * 409 POSITIONS_VERSION, POSITIONS_ROBOT or POSITIONS_CONFIG for a file of another version, robot or
 * configuration, in this order; 422 INVALID names the field that is wrong.
 *
 * @param where place of the file in the body; empty: it is the body
 */
tl::expected<SavedPositions, Problem> read_positions(const nlohmann::json& file, const Robot& robot,
                                                     const ilk_config_t& config, const std::string& where);

/** The saved positions beside the present ones. */
nlohmann::json compare_positions(const SavedPositions& saved, const Robot& robot, const ilk_config_t& config,
                                 const ControlView& view);

}  // namespace interlock
