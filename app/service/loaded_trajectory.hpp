/**
 * @file
 * The trajectory that is loaded, until it was carried out or somebody takes it away.
 */
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "motion/path_program.hpp"
#include "robot/robot.hpp"
#include "system/utc_time.hpp"
#include "trajectory/trajectory_builder.hpp"

namespace interlock {

/** Belongs to the network thread. */
struct LoadedTrajectory {
  std::shared_ptr<const PathProgram> program; /**< null: none is loaded; else one leg, timed */
  std::string author;
  UtcTime loaded;
  /** It follows from registration, probe and target of that revision: stale once these change. */
  std::optional<std::uint32_t> targeting_revision = std::nullopt;
};

/** Schema `LoadedTrajectory` of spec/openapi.yaml. */
nlohmann::json to_json(const LoadedTrajectory& loaded);

}  // namespace interlock
