#include "control/frequency_map.hpp"
#include "service/drafts.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;

json detail_of(const Robot& robot, const MoveTask& move) {
  json detail{{"axis", robot.at_slot(move.slot)->name}, {"target_counts", move.target_counts}};
  if (move.drive) {
    detail["drive"] = *move.drive;
  }
  return detail;
}

json detail_of(const Robot& robot, const HomeTask& homing) {
  if (homing.step_count == 0) {
    return {{"axis", robot.at_slot(homing.slots.front())->name}};
  }
  return homing.step_count == 1 ? json{{"step", robot.home_steps[homing.first_step].name}} : json::object();
}

json detail_of(const Robot& robot, const PathTask& path) {
  json axes = json::array();
  for (const Axis& axis : robot.axes) {
    if (((path.program->mask() >> axis.slot) & 1u) != 0) {
      axes.push_back(axis.name);
    }
  }
  return {{"axes", std::move(axes)}};
}

json detail_of(const Robot& robot, const SweepTask& sweep) {
  return {{"axis", robot.at_slot(sweep.slot)->name},
          {"from_hz", frequency_map::hz_of(sweep.steps.word(0))},
          {"to_hz", frequency_map::hz_of(sweep.steps.word(sweep.steps.count - 1))},
          {"count", sweep.steps.count}};
}

json detail_of(const Robot& /*robot*/, const BiopsyTask& insertion) {
  return {{"target_mm", insertion.target_mm}};
}

json detail_of(const Robot& robot, const Task& task) {
  json detail = std::visit([&](const auto& work) { return detail_of(robot, work); }, task.work);
  detail["kind"] = kind_name(task.kind());
  if (task.mode > RobotMode::home) {
    detail["mode"] = mode_name(task.mode);
  }
  return detail;
}

}  // namespace

boost::asio::awaitable<tl::expected<Proposal, Problem>> propose(const Context& context, const Caller& caller,
                                                                Task task) {
  const std::uint32_t stops = context.control.stops();
  json asked{{"asked", detail_of(context.robot, task)}};
  const auto announced = co_await context.record_then_recheck(caller, AuditKind::proposal, std::move(asked));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (context.control.stops() != stops) {
    co_return fail(stopped_meanwhile("the proposal"));
  }
  if (const auto kernel = context.need_present_state(); !kernel) {
    co_return fail(kernel.error());
  }
  auto made = context.registry.propose(std::move(task), context.view(), caller.asked);
  if (made && made->work<BiopsyTask>() != nullptr) {
    context.biopsy.begin(made->id);
  }
  co_return std::move(made).map_error(refused);
}

}  // namespace interlock
