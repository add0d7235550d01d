/**
 * @file
 * `interlock kinematics fk|ik`: one JSON object a line in, one out, for scripts and for checking against
 * other implementations. docs/kinematics.md describes the objects.
 */
#pragma once

#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "cli/kinematics_lines.hpp"

namespace interlock::cli {

struct KinematicsOptions {
  std::string robot; /**< name of a robot, or its file */
  std::vector<std::string>
      settings; /**< KEY=VALUE in place of what the file says in [kinematics] and [probe] */
};

/**
 * Answers every line, also bad ones, with an object of its own, until the input ends.
 *
 * @return USAGE for a setting that is not understood, REFUSED for a robot whose geometry cannot work and,
 * once the input has ended, when a line had no answer.
 */
Result<void> answer_kinematics(KinematicsTask task, const KinematicsOptions& options,
                               const Installation& installation, std::istream& input, std::ostream& output);

}  // namespace interlock::cli
