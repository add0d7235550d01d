#include "service/reply.hpp"

namespace interlock {

Problem login_needed() {
  return {.status = Status::unauthorized,
          .code = "LOGIN",
          .detail = "Nobody is logged in, or the session ended.",
          .next_step = "Log in."};
}

Problem control_lost() {
  return {.status = Status::conflict,
          .code = "CONTROL",
          .detail = "Control changed hands before this was kept.",
          .expected = "control of the robot",
          .next_step = "Request control."};
}

Problem not_found(const std::string& what, const std::string& expected) {
  return {.status = Status::not_found,
          .code = "NOT_FOUND",
          .detail = "There is no " + what + ".",
          .expected = expected};
}

bool has_waited_too_long(std::chrono::steady_clock::time_point asked) {
  return std::chrono::steady_clock::now() - asked > approval_timeout;
}

Problem too_late() {
  return {
      .status = Status::service_unavailable,
      .code = "LATE",
      .detail =
          "It waited for more than a second, or the robot was stopped after it was sent. Nothing of it was "
          "done.",
      .next_step = "Look at the robot, and ask again."};
}

Problem no_kernel(const std::string& detail) {
  return {.status = Status::service_unavailable,
          .code = "NO_KERNEL",
          .detail = detail,
          .next_step = "Start interlock-kernel, or look at its log; the app attaches by itself."};
}

Problem stopped_meanwhile(const std::string& what) {
  return {.status = Status::conflict,
          .code = "STOPPED",
          .detail = "STOP came before " + what + " was sent.",
          .next_step = "Ask for it again, if it is still wanted."};
}

Problem refused(const Refusal& refusal) {
  Status status = Status::conflict;
  if (refusal.code == "OVERLOADED") {
    status = Status::service_unavailable;
  } else if (refusal.code == "NOT_FOUND") {
    status = Status::not_found;
  }
  return {.status = status,
          .code = refusal.code,
          .detail = refusal.detail,
          .expected = refusal.expected,
          .next_step = refusal.next_step};
}

}  // namespace interlock
