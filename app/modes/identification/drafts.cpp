#include "service/drafts.hpp"

#include "proposals/checks.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr RobotMode identification_mode{"identification"};

Problem case_in_hand(std::int64_t number) {
  return {.status = Status::conflict,
          .code = "CASE",
          .detail = "Case " + std::to_string(number) + " is not closed, so there may be a patient.",
          .expected = "no case that is open or suspended",
          .next_step = "Take the robot away from the patient, close the case, then propose it again."};
}

/** Between the soft limits, and where its linkage lets it go while the other slider stands where it is. */
MeasuringRange range_of(const Context& context, const Axis& axis) {
  const ControlView& view = context.view();
  const auto end = [&](std::int32_t counts) {
    return linked_end(context.robot, states_of(view), {axis.slot, counts});
  };
  return measuring_range(context.config.axis[axis.slot], end(axis.lowest_setpoint_counts()),
                         end(axis.highest_setpoint_counts()));
}

/** What stands still meanwhile: nothing that is measured here says where it is. */
std::vector<AxisCounts> others(const Context& context, std::uint32_t slot) {
  std::vector<AxisCounts> places = standing(context.robot, context.view());
  std::erase_if(places, [&](const AxisCounts& each) { return each.slot == slot; });
  return places;
}

DraftKind::Reading read_identify(const Context& context, json body, std::string author) {
  Fields fields(body, {"kind", "axis", "cleared"});
  const auto name = fields.text("axis");
  const auto cleared = fields.boolean("cleared");
  fields.require({{"axis", "the name of an axis"},
                  {"cleared",
                   "true: no patient is at the robot, needle and probe are taken off, and nobody's "
                   "hands are near the axis"}});
  if (fields.problem()) {
    co_return fail(*fields.problem());
  }
  const Axis* axis = context.robot.find(*name);
  if (axis == nullptr) {
    co_return fail(invalid("axis", *name + " is no axis of the robot", "the name of an axis in /api/motors"));
  }
  if (!*cleared) {
    co_return fail(
        invalid("cleared", "nobody says that the robot is clear",
                "true, once no patient is at the robot, needle and probe are taken off, and nobody's "
                "hands are near the axis"));
  }
  const std::uint32_t revision = context.registry.targeting_revision();
  const auto targeting = co_await present_targeting(context);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  if (targeting->case_number != 0) {
    co_return fail(case_in_hand(targeting->case_number));
  }
  Task task{IdentificationTask{axis->slot, range_of(context, *axis)}, author, identification_mode};
  // A case that is opened meanwhile ends it, as it ends whatever followed from the targeting before.
  task.targeting_revision = revision;
  task.rests_on = others(context, axis->slot);
  co_return task;
}

}  // namespace

std::span<const DraftKind> identification_drafts();
std::span<const DraftKind> identification_drafts() {
  static constexpr DraftKind drafts[] = {{"identify", "", read_identify}};
  return drafts;
}

}  // namespace interlock
