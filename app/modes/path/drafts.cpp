#include "service/drafts.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "proposals/programs.hpp"
#include "service/alignment_view.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr std::size_t most_ablation_steps = 200;
constexpr double longest_dwell_s = 3600.0;
constexpr double longest_move_s = 3600.0;

Task task_of(RobotMode mode, PathProgram program, const std::string& author) {
  return {PathTask{std::make_shared<const PathProgram>(std::move(program))}, author, mode};
}

/** Axes that the aim asks more of than they can do. */
tl::expected<MoveLeg, Problem> ablation_leg_in(const Robot& robot, const json& step,
                                               const std::string& where) {
  Fields fields(step, {"probe_rotation", "insertion", "dwell_s"}, where);
  const auto turned = fields.number("probe_rotation");
  const auto inserted = fields.number("insertion");
  const auto dwell_s = fields.number("dwell_s", 0.0, longest_dwell_s);
  fields.require({{"probe_rotation", "an angle in rad"},
                  {"insertion", "a depth in mm"},
                  {"dwell_s", "a rest in seconds"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  auto leg = ablation_leg(robot, {*turned, *inserted, *dwell_s});
  if (!leg) {
    return fail(invalid(where, "it is beyond every encoder", "positions within reach of the axes"));
  }
  return *std::move(leg);
}

tl::expected<Task, Problem> coordinated_draft(const Robot& robot, const json& targets,
                                              double minimum_duration_s, const std::string& author) {
  if (!targets.is_object() || targets.empty()) {
    return fail(invalid("targets", "targets name no axis", "an object of positions by axis, at least one"));
  }
  MoveLeg leg;
  leg.minimum_duration_s = minimum_duration_s;
  for (const auto& [name, position] : targets.items()) {
    const Axis* axis = robot.find(name);
    if (axis == nullptr) {
      return fail(invalid("targets." + name, "no axis is called " + name, "a name that /api/motors lists"));
    }
    const auto number = number_of(position);
    const auto counts = number ? axis->to_counts(*number) : std::nullopt;
    if (!counts) {
      const std::string place = "targets." + name;
      return fail(invalid(place, place + " is " + quoted(position) + ".",
                          "a position of the axis, a number in " + std::string(unit_name(axis->unit))));
    }
    leg.targets.push_back({axis->slot, *counts});
  }
  return task_of(RobotMode::coordinated, arriving_from_below(robot, {{std::move(leg)}}), author);
}

tl::expected<Task, Problem> ablation_draft(const Robot& robot, const json& steps, const std::string& author) {
  if (!can_ablate(robot)) {
    return fail(not_found("probe for ablation", "a robot with the mode ablation"));
  }
  if (!steps.is_array() || steps.empty() || steps.size() > most_ablation_steps) {
    return fail(invalid("steps", "steps are none, or too many", "an array of 1 to 200 steps"));
  }
  std::vector<PathLeg> legs;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto leg = ablation_leg_in(robot, steps[i], "steps[" + std::to_string(i) + "]");
    if (!leg) {
      return fail(leg.error());
    }
    legs.emplace_back(*leg);
  }
  return task_of(ablation_mode, arriving_from_below(robot, {std::move(legs)}), author);
}

tl::expected<Task, Problem> coordinated_of(const json& body, const Robot& robot, const std::string& author) {
  Fields fields(body, {"kind", "targets", "duration_s"});
  fields.require({{"targets", "positions by axis"}});
  const double duration_s = fields.number("duration_s", 0.0, longest_move_s).value_or(0.0);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return coordinated_draft(robot, *fields.value("targets"), duration_s, author);
}

tl::expected<Task, Problem> ablation_of(const json& body, const Robot& robot, const std::string& author) {
  Fields fields(body, {"kind", "steps"});
  fields.require({{"steps", "angles, depths and rests"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return ablation_draft(robot, *fields.value("steps"), author);
}

tl::expected<PoseRequest, Problem> pose_of(const json& body) {
  constexpr std::array<std::string_view, 2> poses{"desired", "reachable"};
  Fields fields(body, {"kind", "pose", "insert", "accepted_mm", "accepted_deg"});
  PoseRequest request;
  if (fields.choice("pose", poses) == "reachable") {
    request.accepted_mm = fields.number("accepted_mm", 0.0, 2 * farthest_mm);
    request.accepted_deg = fields.number("accepted_deg", 0.0, 180.0);
    fields.require({{"accepted_mm", "the deviation that you accept, in mm"},
                    {"accepted_deg", "the deviation that you accept, in degrees"}});
  }
  request.insert = fields.boolean("insert").value_or(false);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return request;
}

DraftKind::Reading read_coordinated(const Context& context, json body, std::string author) {
  co_return coordinated_of(body, context.robot, author);
}

/** 409 NOT_ALIGNED when one of the axes that a treatment does not move stands elsewhere than at its target.
 */
std::optional<Problem> not_aligned(const Context& context, const Alignment& alignment, std::uint32_t moved) {
  const ControlView view = context.view();
  std::string elsewhere;
  for (const auto& [slot, counts, clamped] : alignment.setpoints) {
    const std::int64_t now = view.snapshot.state.axis[slot].position_counts;
    if (((moved >> slot) & 1u) == 0 &&
        std::abs(now - counts) > rest_tolerance_counts(context.config.axis[slot])) {
      elsewhere += (elsewhere.empty() ? "" : ", ") + context.robot.at_slot(slot)->title;
    }
  }
  if (elsewhere.empty()) {
    return std::nullopt;
  }
  return Problem{.status = Status::conflict,
                 .code = "NOT_ALIGNED",
                 .detail = "These axes do not stand where entry and target ask: " + elsewhere + ".",
                 .expected = "a robot that is aligned with its target",
                 .next_step = "Line the robot up by a proposal of kind pose, then propose it again."};
}

/** A treatment: at the target by the registration, for as long as the robot stands there. */
DraftKind::Reading read_ablation(const Context& context, json body, std::string author) {
  auto task = ablation_of(body, context.robot, author);
  if (!task) {
    co_return fail(task.error());
  }
  const std::uint32_t revision = context.registry.targeting_revision();
  const auto targeting = co_await present_targeting(context);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  const auto alignment = co_await aligned(context, *targeting);
  if (!alignment) {
    co_return fail(alignment.error());
  }
  const bool was_accepted = std::ranges::any_of(context.registry.newest_first(), [&](const Proposal& each) {
    return each.state == ProposalState::done && each.task->aim && each.task->targeting_revision == revision;
  });
  const auto miss = was_accepted ? std::nullopt : out_of_reach(context.robot, *alignment);
  if (miss) {
    co_return fail(*miss);
  }
  if (const auto elsewhere = not_aligned(context, *alignment, task->work.as<PathTask>().program->mask())) {
    co_return fail(*elsewhere);
  }
  task->aim = ReachedAim{alignment->desired, alignment->reachable, alignment->error_budget};
  task->targeting_revision = revision;
  task->rests_on = standing(context.robot, context.view());
  co_return task;
}

DraftKind::Reading read_pose(const Context& context, json body, std::string author) {
  const auto request = pose_of(body);
  if (!request) {
    co_return fail(request.error());
  }
  co_return co_await pose_draft(context, *request, std::move(author));
}

DraftKind::Reading read_trajectory(const Context& context, json body, std::string author) {
  co_return without_fields(body).and_then([&] { return trajectory_draft(context.trajectory, author); });
}

DraftKind::Reading read_draping(const Context& context, json body, std::string author) {
  co_return without_fields(body).and_then([&] { return draping_draft(context.robot, author); });
}

DraftKind::Reading read_retraction(const Context& context, json body, std::string author) {
  co_return without_fields(body).and_then([&] { return retraction_draft(context.robot, author); });
}

}  // namespace

std::span<const DraftKind> path_drafts();
std::span<const DraftKind> path_drafts() {
  static constexpr DraftKind drafts[] = {
      {"coordinated", "", read_coordinated},         {"pose", "", read_pose},
      {"trajectory", "trajectory", read_trajectory}, {"draping", "draping", read_draping},
      {"retraction", "", read_retraction},           {"ablation", "", read_ablation}};
  return drafts;
}

tl::expected<Task, Problem> draping_draft(const Robot& robot, const std::string& author) {
  if (robot.draping.empty()) {
    return fail(not_found("setpoint for draping", "a [draping] table in the robot's file"));
  }
  return task_of(RobotMode{"draping"}, {{MoveLeg{robot.draping, 0.0, 0.0}}}, author);
}

tl::expected<Task, Problem> retraction_draft(const Robot& robot, const std::string& author) {
  const Axis* insertion = robot.with_role("insertion");
  if (insertion == nullptr) {
    return fail(not_found("axis that inserts the probe", "a robot with such an axis"));
  }
  return task_of(RobotMode::coordinated,
                 {{MoveLeg{{{insertion->slot, insertion->lowest_setpoint_counts()}}, 0.0, 0.0}}}, author);
}

tl::expected<Task, Problem> trajectory_draft(const LoadedTrajectory& loaded, const std::string& author) {
  if (loaded.program == nullptr) {
    return fail(Problem{.status = Status::conflict,
                        .code = "EMPTY",
                        .detail = "No trajectory is loaded; the robot stays in manual mode.",
                        .expected = "a loaded trajectory",
                        .next_step = "Load one by PUT /api/trajectory."});
  }
  return Task{PathTask{loaded.program}, author, RobotMode{"trajectory"}, TaskSource::file,
              loaded.targeting_revision};
}

boost::asio::awaitable<tl::expected<Task, Problem>> pose_draft(const Context& context, PoseRequest request,
                                                               std::string author) {
  const std::uint32_t revision = context.registry.targeting_revision();
  const auto targeting = co_await present_targeting(context);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  const auto alignment = co_await aligned(context, *targeting);
  if (!alignment) {
    co_return fail(alignment.error());
  }
  if (const auto miss = out_of_reach(context.robot, *alignment, request.accepted_mm, request.accepted_deg)) {
    co_return fail(*miss);
  }
  Task task = task_of(
      RobotMode::coordinated,
      arriving_from_below(context.robot, pose_program(context.robot, *alignment, request.insert)), author);
  task.targeting_revision = revision;
  task.aim = ReachedAim{alignment->desired, alignment->reachable, alignment->error_budget};
  co_return task;
}

}  // namespace interlock
