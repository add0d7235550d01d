/**
 * @file
 * Tasks and their approval, as the network's thread makes them.
 */
#pragma once

#include <chrono>
#include <utility>
#include <vector>

#include "motion/task.hpp"
#include "proposals/motion_registry.hpp"

namespace interlock::test {

inline TaskReference task_of(std::uint32_t id, Work work) {
  return std::make_shared<const Task>(Task{.work = std::move(work), .author = "edna", .id = id});
}

/** The same, which is right only while these axes stand there. */
inline TaskReference task_of(std::uint32_t id, Work work, std::vector<AxisCounts> rests_on) {
  Task task = *task_of(id, std::move(work));
  task.rests_on = std::move(rests_on);
  return std::make_shared<const Task>(std::move(task));
}

inline PathTask along(const PathProgram& program) { return {std::make_shared<const PathProgram>(program)}; }

/** One that never is too late. */
inline Approval approval_of(std::uint32_t id, Work work, std::uint32_t stops = 0, Moment held = {}) {
  return {task_of(id, std::move(work)), stops, std::chrono::steady_clock::time_point::max(), held};
}

/** The proposal of that task, which somebody approves when it waits for that. */
inline tl::expected<Proposal, Refusal> approved(MotionRegistry& registry, Task task,
                                                const ControlView& view) {
  auto made = registry.propose(std::move(task), view);
  return made && made->state == ProposalState::checked ? registry.approve(made->id, view) : made;
}

}  // namespace interlock::test
