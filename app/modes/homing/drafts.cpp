#include "service/drafts.hpp"

#include "proposals/checks.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock {
namespace {

using nlohmann::json;

tl::expected<Task, Problem> home_of(const json& body, const Robot& robot, const std::string& author) {
  Fields fields(body, {"kind", "slot", "step"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto step = fields.text("step");
  if (fields.has("slot") && fields.has("step")) {
    fields.reject("step", "and slot: at most one of them", "a slot, a step, or neither");
  }
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  if (slot) {
    return axis_in(robot, *slot).map([&](const Axis* axis) {
      return Task{home_axis(axis->slot), author, RobotMode::home};
    });
  }
  return (step ? home_step(robot, *step) : home_all(robot))
      .map([&](HomeTask homing) { return Task{std::move(homing), author, RobotMode::home}; })
      .map_error(refused);
}

DraftKind::Reading read_home(const Context& context, json body, std::string author) {
  co_return home_of(body, context.robot, author);
}

}  // namespace

std::span<const DraftKind> homing_drafts();
std::span<const DraftKind> homing_drafts() {
  static constexpr DraftKind drafts[] = {{"home", "home", read_home}};
  return drafts;
}

}  // namespace interlock
