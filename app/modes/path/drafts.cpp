#include "service/drafts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "proposals/line_program.hpp"
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
                                              double minimum_duration_s, bool inserted,
                                              const std::string& author) {
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
  return task_of(RobotMode::coordinated, arriving_from_below(robot, {{std::move(leg)}}, inserted), author);
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
  return task_of(ablation_mode, arriving_from_below(robot, {std::move(legs)}, true), author);
}

tl::expected<Task, Problem> coordinated_of(const json& body, const Robot& robot, bool inserted,
                                           const std::string& author) {
  Fields fields(body, {"kind", "targets", "duration_s"});
  fields.require({{"targets", "positions by axis"}});
  const double duration_s = fields.number("duration_s", 0.0, longest_move_s).value_or(0.0);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return coordinated_draft(robot, *fields.value("targets"), duration_s, inserted, author);
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

/** The straight line that a draft asks for. */
struct LineDraft {
  std::optional<double> along_mm;    /**< along the probe's axis, ahead when above 0 */
  std::optional<Point> target_point; /**< of the treatment point, RAS */
  bool keeps_direction = false;      /**< with `target_point` */
  double deviation_mm = 0.0;
  double speed_mm_s = 0.0;
};

tl::expected<LineDraft, Problem> line_of(const json& body) {
  constexpr std::array<std::string_view, 2> kept{"entry", "direction"};
  constexpr double usual_deviation_mm = 0.1;
  constexpr double usual_speed_mm_s = 5.0;
  Fields fields(body, {"kind", "along_mm", "target_point", "keep", "deviation_mm", "speed_mm_s"});
  LineDraft line;
  line.along_mm = fields.number("along_mm", -longest_line_mm, longest_line_mm);
  if (const auto point = fields.numbers("target_point", 3)) {
    constexpr double farthest_mm = 1e5;
    if (std::ranges::any_of(*point, [](double each) { return std::abs(each) > farthest_mm; })) {
      return fail(invalid("target_point", "it is farther than 100 m from the scanner's origin",
                          "three numbers in mm"));
    }
    line.target_point = Point{(*point)[0], (*point)[1], (*point)[2]};
    fields.require({{"keep", "what the probe keeps: entry or direction"}});
  }
  line.keeps_direction = fields.choice("keep", kept) == "direction";
  line.deviation_mm = fields.number("deviation_mm", 0.001, 100.0).value_or(usual_deviation_mm);
  line.speed_mm_s = fields.number("speed_mm_s", 0.01, 1000.0).value_or(usual_speed_mm_s);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  if (line.along_mm && line.keeps_direction) {
    return fail(invalid("keep", "a line along the probe's axis keeps both, its direction and its entry point",
                        "along_mm without keep, or target_point with it"));
  }
  if (line.along_mm.has_value() == line.target_point.has_value()) {
    return fail(invalid("along_mm", "along_mm and target_point are both given, or neither is.",
                        "along_mm, or target_point with keep"));
  }
  return line;
}

Problem problem_of(const json& found) {
  return {.status = Status::conflict,
          .code = found.at("code"),
          .detail = found.at("text"),
          .expected = "a robot whose place is known",
          .next_step = "Look at GET /api/targeting/alignment."};
}

/** A straight line from where the robot stands, computed on any thread. */
tl::expected<Task, Problem> line_task(const Robot& robot, const ilk_state_t& state,
                                      const Targeting& targeting, const LineDraft& draft,
                                      const std::string& author) {
  // Only a point of the scanner needs to know where the robot is in it.
  const auto setup =
      draft.target_point
          ? pose_setup(robot, targeting)
          : picture_setup(robot, targeting).map([](const PictureSetup& picture) { return picture.poses; });
  const auto from = setup.and_then([&](const PoseSetup&) { return known_positions(robot, state); });
  if (!from) {
    return fail(problem_of(from.error()));
  }
  const RobotKinematics& kinematics = setup->kinematics;
  const Pose scanner_from_zframe = setup->registration.scanner_from_zframe();
  const auto in_zframe = [&](const Point& point) -> Eigen::Vector3d {
    return scanner_from_zframe.inverse() * Eigen::Vector3d(point.data());
  };
  LineRequest request{Eigen::Vector3d::Zero(), entry_at(kinematics, *from), draft.deviation_mm,
                      draft.speed_mm_s};
  if (draft.along_mm) {
    if (const auto pose = kinematics.zframe_from_treatment(*from)) {
      request.end_mm = *pose * Eigen::Vector3d(0.0, 0.0, *draft.along_mm);
    }
  } else {
    request.end_mm = in_zframe(*draft.target_point);
    if (draft.keeps_direction) {
      request.entry_mm.reset();
    } else if (!request.entry_mm && !targeting.entry_point) {
      return fail(Problem{.status = Status::conflict,
                          .code = "NO_TARGET",
                          .detail = "The joints of " + robot.title + " fix no entry point, and none is set.",
                          .expected = "an entry point through which the probe passes",
                          .next_step = "Set entry and target, or keep the direction."});
    } else if (!request.entry_mm) {
      request.entry_mm = in_zframe(*targeting.entry_point);
    }
  }
  auto program = line_program(robot, kinematics, *from, request);
  if (!program) {
    return fail(refused(program.error()));
  }
  Task task = task_of(RobotMode::coordinated, *program, author);
  if (draft.target_point) {
    const TimedTrajectory& trajectory = std::get<TimedLeg>(program->legs.front()).trajectory;
    AxisPositions end = *from;
    for (std::size_t axis = 0; axis < trajectory.axes().size(); ++axis) {
      const auto place = robot.at_slot(trajectory.axes()[axis].slot) - robot.axes.data();
      end[static_cast<std::size_t>(place)] = trajectory.end(axis).position;
    }
    const Pose reached = scanner_from_zframe * *kinematics.zframe_from_treatment(end);
    task.aim = ReachedAim{reached, reached,
                          error_budget_of(robot, kinematics, scanner_from_zframe, end,
                                          {accuracy_of(targeting).registration, {}})};
  }
  return task;
}

DraftKind::Reading read_line(const Context& context, json body, std::string author) {
  const auto draft = line_of(body);
  if (!draft) {
    co_return fail(draft.error());
  }
  if (const auto kernel = context.need_present_state(); !kernel) {
    co_return fail(kernel.error());
  }
  const std::uint32_t revision = context.registry.targeting_revision();
  const auto targeting = co_await present_targeting(context);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  const ControlView& view = context.view();
  auto places = standing(context.robot, view);
  auto work = [robot = &context.robot, state = view.snapshot.state, targeting = *targeting, draft = *draft,
               author = std::move(author)] { return line_task(*robot, state, targeting, draft, author); };
  auto found = co_await context.work.run(std::move(work));
  auto task = found.and_then([](tl::expected<Task, Problem>& made) { return std::move(made); });
  if (!task) {
    co_return fail(task.error());
  }
  if (draft->target_point) {
    task->targeting_revision = revision;
  }
  task->rests_on = std::move(places);
  co_return task;
}

/** As it was seen last: a probe that is not all the way out may be in the patient. */
bool is_inserted(const Context& context) {
  const Axis* const insertion = context.robot.with_role("insertion");
  if (insertion == nullptr) {
    return false;
  }
  const std::int64_t out = std::int64_t{insertion->lowest_setpoint_counts()} +
                           rest_tolerance_counts(context.config.axis[insertion->slot]);
  return context.view().snapshot.state.axis[insertion->slot].position_counts > out;
}

DraftKind::Reading read_coordinated(const Context& context, json body, std::string author) {
  co_return coordinated_of(body, context.robot, is_inserted(context), author);
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
  static constexpr DraftKind drafts[] = {{"coordinated", "", read_coordinated},
                                         {"pose", "", read_pose},
                                         {"trajectory", "trajectory", read_trajectory},
                                         {"draping", "draping", read_draping},
                                         {"retraction", "", read_retraction},
                                         {"ablation", "", read_ablation},
                                         {"line", "", read_line}};
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
