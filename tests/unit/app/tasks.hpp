/**
 * @file
 * Tasks and their approval, as the network's thread makes them.
 */
#pragma once

#include <chrono>
#include <utility>

#include "motion/task.hpp"

namespace interlock::test {

inline TaskReference task_of(std::uint32_t id, Work work) {
  return std::make_shared<const Task>(Task{.work = std::move(work), .author = "edna", .id = id});
}

inline PathTask along(const PathProgram& program) { return {std::make_shared<const PathProgram>(program)}; }

/** One that never is too late. */
inline Approval approval_of(std::uint32_t id, Work work, std::uint32_t stops = 0, Moment held = {}) {
  return {task_of(id, std::move(work)), stops, std::chrono::steady_clock::time_point::max(), held};
}

}  // namespace interlock::test
