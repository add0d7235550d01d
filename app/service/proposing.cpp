#include "proposals/motion_kind.hpp"
#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;

json detail_of(const Robot& robot, const Task& task) {
  json detail = kind_of(task.work).asked(robot, task.work);
  detail["kind"] = kind_of(task.work).name();
  if (task.mode.moves_the_whole()) {
    detail["mode"] = task.mode.name;
  }
  return detail;
}

}  // namespace

tl::expected<const Axis*, Problem> axis_in(const Robot& robot, std::int64_t slot) {
  const Axis* axis = robot.at_slot(static_cast<std::uint32_t>(slot));
  if (axis == nullptr) {
    return fail(not_found("axis in slot " + std::to_string(slot), "a slot that /api/motors lists"));
  }
  return axis;
}

std::vector<AxisCounts> standing(const Robot& robot, const ControlView& view) {
  std::vector<AxisCounts> places;
  for (const Axis& axis : robot.axes) {
    if (!axis.role.empty()) {
      places.push_back({axis.slot, view.snapshot.state.axis[axis.slot].position_counts});
    }
  }
  return places;
}

tl::expected<void, Problem> without_fields(const json& body) {
  const Fields fields(body, {"kind"});
  return fields.problem() ? tl::expected<void, Problem>(fail(*fields.problem()))
                          : tl::expected<void, Problem>();
}

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
