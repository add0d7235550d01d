#include "service/navigation_commands.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "service/alignment_view.hpp"
#include "service/drafts.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"
#include "targeting/targeting_json.hpp"

namespace interlock {
namespace {

namespace asio = boost::asio;
using igtl::StatusCode;
using nlohmann::json;
using Done = tl::expected<igtl::Outcome, Problem>;
using Sent = tl::expected<TimedTrajectory, Problem>;

constexpr const char* known_modes = "manual, home, trajectory, draping, targeting or insertion";

/** Sub-codes of a target's STATUS. */
constexpr std::int64_t invalid_target = 1;
constexpr std::int64_t unreachable_target = 2;
constexpr std::int64_t missed_target = 3;

igtl::Outcome well(std::string text) { return {{StatusCode::ok, 0, "OK", std::move(text)}}; }

igtl::Outcome proposed(const Proposal& proposal) {
  igtl::Outcome outcome = well("Proposal " + std::to_string(proposal.id) + ": " + proposal.detail);
  outcome.proposal = proposal.id;
  return outcome;
}

StatusCode status_code(const Problem& problem) {
  static const std::map<std::string, StatusCode> codes{
      {"CONTROL", StatusCode::access_denied},    {"LOGIN", StatusCode::access_denied},
      {"ROLE", StatusCode::access_denied},       {"OVERLOADED", StatusCode::busy},
      {"UNREACHABLE", StatusCode::unreachable},  {"INVALID", StatusCode::configuration},
      {"MODE", StatusCode::unknown_instruction}, {"NOT_FOUND", StatusCode::not_found},
      {"INTERNAL", StatusCode::unknown_error}};
  const auto found = codes.find(problem.code);
  if (found != codes.end()) {
    return found->second;
  }
  return problem.status == Status::unprocessable_entity ? StatusCode::configuration : StatusCode::not_ready;
}

/** What the body of a change of targeting says, and who reads it. */
struct Asked {
  TargetingChange make;
  json body;
};

std::optional<Asked> targeting_of(const igtl::Command& command) {
  if (const auto* registration = std::get_if<igtl::SetRegistration>(&command)) {
    return Asked{with_registration, {{"registration", registration->scanner_from_robot}}};
  }
  if (const auto* pose = std::get_if<igtl::ReportPose>(&command)) {
    return Asked{with_reported_pose, {{"current_position", pose->scanner_from_probe}}};
  }
  if (const auto* point = std::get_if<igtl::SetPoint>(&command)) {
    return Asked{with_target, {{point->is_target ? "target_point" : "entry_point", point->position}}};
  }
  if (const auto* offset = std::get_if<igtl::SetOffset>(&command)) {
    return Asked{with_target, {{std::string(offset->field), offset->mm}}};
  }
  return std::nullopt;
}

asio::awaitable<Done> change(const Context& context, const Caller& caller, const igtl::Command& command) {
  auto asked = targeting_of(command);
  if (!asked) {
    co_return fail({.code = "INTERNAL", .detail = "Nobody carries out such a wish."});
  }
  const auto changed = co_await change_targeting(context, caller, TaskSource::openigtlink, asked->make,
                                                 std::move(asked->body));
  if (!changed) {
    co_return fail(changed.error());
  }
  igtl::Outcome outcome = well("It was stored.");
  const auto alignment = co_await aligned(context, *changed);
  if (alignment) {
    outcome.target = row_major(alignment->desired);
    outcome.reachable = row_major(alignment->reachable);
  }
  co_return outcome;
}

asio::awaitable<Done> load(const Context& context, const Caller& caller, Sent sent,
                           std::optional<std::uint32_t> targeting_revision) {
  if (!sent) {
    co_return fail(sent.error());
  }
  const auto loaded = co_await load_trajectory(context, caller, std::move(*sent), targeting_revision);
  co_return loaded.map([] { return well("The trajectory was loaded."); });
}

asio::awaitable<Done> load_rows(const Context& context, const Caller& caller, igtl::LoadRows rows) {
  auto work = [rows = std::move(rows), robot = &context.robot] { return trajectory_of(*robot, rows); };
  auto done = co_await context.work.run(std::move(work));
  if (!done) {
    co_return fail(done.error());
  }
  co_return co_await load(context, caller, std::move(*done), std::nullopt);
}

/** Where poses lead the axes depends on registration and probe, so that the trajectory is stale when these
 * change. */
asio::awaitable<Done> load_poses(const Context& context, const Caller& caller, igtl::LoadPoses poses) {
  const std::uint32_t revision = context.registry.targeting_revision();
  const auto targeting = co_await present_targeting(context);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  std::vector<Point> points;
  for (const igtl::TimedPose& each : poses.poses) {
    points.push_back(
        {each.scanner_from_treatment[3], each.scanner_from_treatment[7], each.scanner_from_treatment[11]});
  }
  if (const auto ours = co_await check_points(context, std::move(points)); !ours) {
    co_return fail(ours.error());
  }
  auto work = [poses = std::move(poses), targeting = *targeting, robot = &context.robot] {
    return trajectory_of(*robot, targeting, poses);
  };
  auto done = co_await context.work.run(std::move(work));
  if (!done) {
    co_return fail(done.error());
  }
  co_return co_await load(context, caller, std::move(*done), revision);
}

Done go_manual(const Context& context, const Caller& caller) {
  (void)context.view();
  const Proposal* home = context.registry.open_home();
  const Proposal* open = home == nullptr ? context.registry.open_mode() : home;
  if (open != nullptr) {
    if (const auto ended = context.registry.abort(open->id, caller.user); !ended) {
      return fail(refused(ended.error()));
    }
  }
  return well("The robot is in manual mode.");
}

asio::awaitable<Done> propose_path(const Context& context, const Caller& caller,
                                   tl::expected<Task, Problem> draft) {
  if (!draft) {
    co_return fail(draft.error());
  }
  draft->source = TaskSource::openigtlink;
  Task task = std::move(*draft);
  const auto made = co_await propose(context, caller, std::move(task));
  co_return made.map(proposed);
}

asio::awaitable<Done> enter_mode(const Context& context, const Caller& caller, std::string mode) {
  if (mode == "manual") {
    co_return go_manual(context, caller);
  }
  tl::expected<Task, Problem> draft = fail({.status = Status::conflict,
                                            .code = "MODE",
                                            .detail = "\"" + mode + "\" cannot be had from here.",
                                            .expected = known_modes,
                                            .next_step = "Other modes are entered in the console."});
  if (mode == "trajectory") {
    draft = trajectory_draft(context.trajectory, caller.user);
  } else if (mode == "draping") {
    draft = draping_draft(context.robot, caller.user);
  } else if (mode == "targeting" || mode == "insertion") {
    const PoseRequest request{.insert = mode == "insertion"};
    draft = co_await pose_draft(context, request, caller.user);
  }
  co_return co_await propose_path(context, caller, std::move(draft));
}

asio::awaitable<Done> move_to_target(const Context& context, const Caller& caller) {
  const PoseRequest request{.insert = true};
  auto draft = co_await pose_draft(context, request, caller.user);
  co_return co_await propose_path(context, caller, std::move(draft));
}

/** Whether nothing is left to home: each axis that the home steps bring to its switch has been there; of a
 * robot without such steps, every axis is homed. */
bool is_homed(const Robot& robot, const ControlView& view) {
  const auto has_been_home = [&](std::uint32_t slot) { return view.snapshot.state.axis[slot].homed != 0; };
  if (robot.home_steps.empty()) {
    return view.attached && std::ranges::all_of(robot.axes, has_been_home, &Axis::slot);
  }
  return view.attached && std::ranges::all_of(robot.home_steps, [&](const HomeStep& step) {
           return std::ranges::all_of(step.home, has_been_home);
         });
}

Problem homed_by_hand(const Robot& robot) {
  return {.status = Status::conflict,
          .code = "NOT_HOMED",
          .detail = "An axis is not homed, and " + robot.title + " has no home steps.",
          .expected = "every axis homed",
          .next_step = "Home each axis by itself in the console."};
}

asio::awaitable<Done> start_up(const Context& context, const Caller& caller) {
  if (is_homed(context.robot, context.view())) {
    co_return well("Every axis is homed.");
  }
  if (const auto kernel = context.need_kernel(); !kernel) {
    co_return fail(kernel.error());
  }
  if (context.robot.home_steps.empty()) {
    co_return fail(homed_by_hand(context.robot));
  }
  auto homing = home_all(context.robot);
  if (!homing) {
    co_return fail(refused(homing.error()));
  }
  Task task{std::move(*homing), caller.user, RobotMode::home, TaskSource::openigtlink};
  const auto made = co_await propose(context, caller, std::move(task));
  co_return made.map(proposed);
}

/** A target that is refused leaves none: the one before would pass for it. */
asio::awaitable<void> leave_no_target(const Context& context, const Caller& caller) {
  json nothing = json::object();
  (void)co_await change_targeting(context, caller, TaskSource::openigtlink, without_target,
                                  std::move(nothing));
}

asio::awaitable<Done> set_target(const Context& context, const Caller& caller, igtl::SetTargetPose command) {
  const auto before = co_await present_targeting(context);
  if (!before) {
    co_return fail(before.error());
  }
  Targeting desired = *before;
  aim_at(desired, command.scanner_from_target);
  const auto alignment = co_await aligned(context, desired);
  const auto miss = alignment ? out_of_reach(context.robot, *alignment) : alignment.error();
  if (miss) {
    co_await leave_no_target(context, caller);
    igtl::Outcome outcome{status_of(*miss)};
    if (miss->code != "NO_REGISTRATION") {
      outcome.status.code = StatusCode::unreachable;
      outcome.status.sub_code = alignment ? missed_target : unreachable_target;
    }
    if (alignment) {
      outcome.reachable = row_major(alignment->reachable);
    }
    co_return outcome;
  }
  igtl::Outcome outcome = well("The target was stored.");
  outcome.target = row_major(alignment->desired);
  outcome.reachable = row_major(alignment->reachable);
  json body{{"entry_point", *desired.entry_point}, {"target_point", *desired.target_point}};
  const auto changed =
      co_await change_targeting(context, caller, TaskSource::openigtlink, with_target, std::move(body));
  co_return changed.map([&outcome](const Targeting&) { return outcome; });
}

/** What comes as float32 has to be nearer to a rotation than what people type. */
const igtl::Matrix* pose_of(const igtl::Command& command) {
  if (const auto* registration = std::get_if<igtl::SetRegistration>(&command)) {
    return &registration->scanner_from_robot;
  }
  const auto* reported = std::get_if<igtl::ReportPose>(&command);
  return reported == nullptr ? nullptr : &reported->scanner_from_probe;
}

Problem no_rigid_motion() {
  return {.status = Status::unprocessable_entity,
          .code = "INVALID",
          .detail = "The matrix is no rigid motion.",
          .expected = "R^T R = 1 within 0.0001, determinant 1",
          .next_step = "Make its rotation orthonormal, and send it again."};
}

/** A STATUS says which kind of refusal a target met. */
asio::awaitable<Done> set_target_pose(const Context& context, const Caller& caller,
                                      igtl::SetTargetPose command) {
  const auto pose = rigid_pose({{"target", command.scanner_from_target}}, "target");
  if (!pose || !igtl::is_rigid(command.scanner_from_target)) {
    co_await leave_no_target(context, caller);
    igtl::Outcome outcome{status_of(pose ? no_rigid_motion() : pose.error())};
    outcome.status.sub_code = invalid_target;
    co_return outcome;
  }
  co_return co_await set_target(context, caller, command);
}

asio::awaitable<Done> disable_all(const Context& context) {
  for (const Axis& axis : context.robot.axes) {
    const auto answer = co_await context.control.ask(ILK_REQUEST_DISABLE, axis.slot);
    if (!answer || !answer->verdict) {
      co_return fail(no_kernel("The kernel did not answer within a second."));
    }
    if (*answer->verdict != ILK_VERDICT_ACCEPTED) {
      co_return fail(refused(verdict_refusal(*answer->verdict, axis.name)));
    }
  }
  co_return well("Every axis is disabled.");
}

asio::awaitable<Done> cut_power(const Context& context, const Caller& caller) {
  if (const Done ended = go_manual(context, caller); !ended) {
    co_return fail(ended.error());
  }
  co_return co_await disable_all(context);
}

asio::awaitable<Done> done_for(const Context& context, const Caller& caller, const igtl::Command& command) {
  if (const auto* rows = std::get_if<igtl::LoadRows>(&command)) {
    co_return co_await load_rows(context, caller, *rows);
  }
  if (const auto* poses = std::get_if<igtl::LoadPoses>(&command)) {
    co_return co_await load_poses(context, caller, *poses);
  }
  if (const auto* mode = std::get_if<igtl::SetMode>(&command)) {
    co_return co_await enter_mode(context, caller, mode->mode);
  }
  if (std::holds_alternative<igtl::StartUp>(command)) {
    co_return co_await start_up(context, caller);
  }
  if (const auto* target = std::get_if<igtl::SetTargetPose>(&command)) {
    co_return co_await set_target_pose(context, caller, *target);
  }
  if (std::holds_alternative<igtl::MoveToTarget>(command)) {
    co_return co_await move_to_target(context, caller);
  }
  if (std::holds_alternative<igtl::RetractProbe>(command)) {
    co_return co_await propose_path(context, caller, retraction_draft(context.robot, caller.user));
  }
  if (std::holds_alternative<igtl::CutPower>(command)) {
    co_return co_await cut_power(context, caller);
  }
  if (const igtl::Matrix* pose = pose_of(command); pose != nullptr && !igtl::is_rigid(*pose)) {
    co_return fail(no_rigid_motion());
  }
  co_return co_await change(context, caller, command);
}

}  // namespace

igtl::Status status_of(const Problem& problem) {
  std::string text = problem.detail;
  text += problem.expected.empty() ? "" : " Expected: " + problem.expected + ".";
  text += problem.next_step.empty() ? "" : " " + problem.next_step;
  return {status_code(problem), 0, problem.code, std::move(text)};
}

asio::awaitable<igtl::Outcome> carry_out(const Context& context, const Caller& caller, std::string device,
                                         igtl::Command command) {
  json detail{{"action", "message"}, {"name", device}, {"client", caller.peer}};
  context.store.note(context.entry(caller, AuditKind::connection, std::move(detail)));
  std::string thrown;
  try {
    const Done done = co_await done_for(context, caller, command);
    co_return done ? *done : igtl::Outcome{status_of(done.error())};
  } catch (const std::exception& exception) {
    thrown = exception.what();
  }
  spdlog::critical("OpenIGTLink message \"{}\" threw: {}", device, thrown);
  co_return igtl::Outcome{status_of(
      {.code = "INTERNAL", .detail = "The app failed to do it.", .next_step = "Report it with the log."})};
}

asio::awaitable<igtl::Outcome> stopped(const Context& context,
                                       asio::awaitable<std::optional<StopAnswer>> answered, bool cuts_power) {
  const std::optional<StopAnswer> answer = co_await std::move(answered);
  if (!answer || answer->verdict != ILK_VERDICT_ACCEPTED) {
    co_return igtl::Outcome{{StatusCode::not_ready, 0, "NO_KERNEL",
                             "STOP was sent, and no kernel has confirmed it. Release the pedal."}};
  }
  if (!cuts_power) {
    co_return well("The kernel has stopped all motion.");
  }
  const Done cut = co_await disable_all(context);
  co_return cut ? *cut : igtl::Outcome{status_of(cut.error())};
}

}  // namespace interlock
