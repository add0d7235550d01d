/**
 * @file
 * How the command line ends when it cannot do what was asked.
 */
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "robot/robot_error.hpp"

namespace interlock::cli {

/** Exit codes of `interlock`, as `interlock --help` lists them. */
enum class ExitCode : int {
  done = 0,    /**< done; `run`: stopped by a signal */
  refused = 1, /**< a robot file, a trajectory or a line of `kinematics` that is not valid, a broken audit, a
                  rule of the store */
  usage = 2,   /**< the command line is not understood */
  precondition =
      3, /**< something stands in the way: busy port, second instance, missing file, no permission */
  process_ended = 4,   /**< kernel or simulator ended, or did not start */
  app_kept_ending = 5, /**< the app ended more often than it may be restarted */
  no_answer = 6,       /**< no app answers, or its answer is not understood */
};

/** Why a command ends early: what, where, what was expected, what to do. */
struct Failure {
  ExitCode code;
  std::string text;
};

/** Why a robot file was not taken: one that is missing stands in the way, another is refused. */
inline Failure robot_failure(const RobotError& error) {
  return {error.is_missing ? ExitCode::precondition : ExitCode::refused, error.message()};
}

/** What a command gives, or why it ends and with which exit code. */
template <typename Value>
using Result = tl::expected<Value, Failure>;

/** A failure as the error side of any `Result`. */
inline tl::unexpected<Failure> failed(ExitCode code, std::string text) {
  return tl::unexpected(Failure{code, std::move(text)});
}

}  // namespace interlock::cli
