/**
 * @file
 * `interlock trajectory check`: whether a robot can follow a trajectory that is written in a file, and where
 * it leads. docs/trajectories.md describes file and answer.
 */
#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"

namespace interlock::cli {

struct TrajectoryOptions {
  std::string robot; /**< name of a robot, or its file */
  std::filesystem::path file;
  std::vector<std::string> max_velocities; /**< AXIS=VALUE in the axis' unit per second */
};

/**
 * Answers with one JSON object: rows, duration and reach of the axes, or the error.
 *
 * @return USAGE for a velocity that is not understood, PRECONDITION when the file cannot be read, REFUSED for a
 * trajectory that the robot cannot follow.
 */
Result<void> check_trajectory(const TrajectoryOptions& options, const Installation& installation,
                              std::ostream& output);

}  // namespace interlock::cli
