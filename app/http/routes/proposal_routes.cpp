#include <array>
#include <limits>

#include "http/routes.hpp"
#include "proposals/proposal_json.hpp"
#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

constexpr std::int64_t lowest_counts = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest_counts = std::numeric_limits<std::int32_t>::max();
constexpr double longest_move_s = 3600.0;

tl::expected<const Axis*, Problem> axis_in(const Robot& robot, std::int64_t slot) {
  const Axis* axis = robot.at_slot(static_cast<std::uint32_t>(slot));
  if (axis == nullptr) {
    return fail(not_found("axis in slot " + std::to_string(slot), "a slot that /api/motors lists"));
  }
  return axis;
}

tl::expected<Task, Problem> move_of(const json& body, const Robot& robot, const std::string& author) {
  Fields fields(body, {"kind", "slot", "target", "target_counts", "drive"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto target = fields.number("target");
  auto target_counts = fields.integer("target_counts", lowest_counts, highest_counts);
  const auto drive = fields.integer("drive", 1, highest_counts);
  fields.require({{"slot", "an integer from 0 to 9"}});
  if (fields.has("target") == fields.has("target_counts")) {
    fields.reject("target", "and target_counts: one is needed, not both",
                  "target in the axis' unit, or target_counts");
  }
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  const auto axis = axis_in(robot, *slot);
  if (!axis) {
    return fail(axis.error());
  }
  if (target) {
    const auto counts = (*axis)->to_counts(*target);
    if (!counts) {
      fields.reject("target", "is beyond every encoder",
                    "a position within the range that /api/motors shows");
      return fail(*fields.problem());
    }
    target_counts = *counts;
  }
  MoveTask move{(*axis)->slot, static_cast<std::int32_t>(*target_counts)};
  if (drive) {
    move.drive = static_cast<std::uint32_t>(*drive);
  }
  return Task{move, author};
}

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
  Fields fields(body, {"kind", "pose", "insert"});
  const auto pose = fields.choice("pose", poses);
  const bool insert = fields.boolean("insert").value_or(false);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return PoseRequest{pose == "reachable", insert};
}

/** In the guide frame; nothing: the target of the targeting. */
tl::expected<std::optional<std::array<double, 3>>, Problem> biopsy_target_of(const json& body) {
  Fields fields(body, {"kind", "target_mm"});
  const auto target_mm = fields.numbers("target_mm", 3);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return target_mm ? std::optional(std::array{(*target_mm)[0], (*target_mm)[1], (*target_mm)[2]})
                   : std::nullopt;
}

tl::expected<std::string, Problem> kind_in(const json& body) {
  constexpr std::array<std::string_view, 9> kinds{"biopsy",     "move",    "home",     "coordinated", "pose",
                                                  "trajectory", "draping", "ablation", "sweep"};
  Fields fields(body,
                {"kind", "slot", "step", "target", "target_counts", "drive", "targets", "duration_s", "pose",
                 "insert", "steps", "axis", "from_hz", "to_hz", "step_hz", "dwell_s", "target_mm"});
  const auto kind = fields.choice("kind", kinds);
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return kind.value_or("move");
}

/** Nothing but the kind. */
tl::expected<void, Problem> alone(const json& body) {
  const Fields fields(body, {"kind"});
  return fields.problem() ? tl::expected<void, Problem>(fail(*fields.problem()))
                          : tl::expected<void, Problem>();
}

}  // namespace

ProposalRoutes::ProposalRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/proposals", viewers, [this](const Call&) -> Answering { co_return list(); });
  router.add(verb::post, "/api/proposals", holder, [this](const Call& call) { return propose(call); });
  router.add(verb::get, "/api/proposals/{id}", viewers,
             [this](const Call& call) -> Answering { co_return show(call); });
  router.add(verb::get, "/api/proposals/{id}/plan", viewers, [this](const Call& call) { return plan(call); });
  router.add(verb::post, "/api/proposals/{id}/approve", holder,
             [this](const Call& call) { return approve(call); });
  router.add(verb::post, "/api/proposals/{id}/reject", holder,
             [this](const Call& call) { return reject(call); });
  router.add(verb::post, "/api/proposals/{id}/abort", holder,
             [this](const Call& call) -> Answering { co_return abort(call); });
}

Reply ProposalRoutes::list() const {
  (void)context_.view();
  json list = json::array();
  for (const Proposal& each : context_.registry.newest_first()) {
    list.push_back(to_json(each));
  }
  return Success{Status::ok, std::move(list)};
}

/** Reads a `ProposalDraft`. */
boost::asio::awaitable<tl::expected<Task, Problem>> ProposalRoutes::task_of(const Call& call) const {
  const auto body = parse_body(call.request);
  const auto kind = body.and_then(kind_in);
  if (!kind) {
    co_return fail(kind.error());
  }
  const std::string& author = call.caller.user;
  if (*kind == "pose") {
    const auto request = pose_of(*body);
    if (!request) {
      co_return fail(request.error());
    }
    co_return co_await pose_draft(context_, *request, author);
  }
  if (*kind == "trajectory") {
    co_return alone(*body).and_then([&] { return trajectory_draft(context_.trajectory, author); });
  }
  if (*kind == "draping") {
    co_return alone(*body).and_then([&] { return draping_draft(context_.robot, author); });
  }
  if (*kind == "ablation") {
    co_return ablation_of(*body, context_.robot, author);
  }
  if (*kind == "biopsy") {
    const auto target_mm = biopsy_target_of(*body);
    if (!target_mm) {
      co_return fail(target_mm.error());
    }
    co_return co_await biopsy_draft(context_, *target_mm, author);
  }
  if (*kind == "sweep") {
    co_return sweep_draft(context_.robot, *body, author);
  }
  if (*kind == "coordinated") {
    co_return coordinated_of(*body, context_.robot, author);
  }
  co_return *kind == "home" ? home_of(*body, context_.robot, author) : move_of(*body, context_.robot, author);
}

Answering ProposalRoutes::propose(const Call& call) const {
  auto task = co_await task_of(call);
  if (!task) {
    co_return fail(task.error());
  }
  if (const auto kernel = context_.need_kernel(); !kernel) {
    co_return fail(kernel.error());
  }
  auto made = co_await interlock::propose(context_, call.caller, std::move(*task));
  co_return std::move(made).map(
      [](const Proposal& proposal) { return Success{Status::created, to_json(proposal)}; });
}

Answering ProposalRoutes::approve(const Call& call) const {
  const auto shown = show(call);
  if (!shown) {
    co_return shown;
  }
  const std::uint32_t id = *number_in(call.parameters[0]);
  const std::uint32_t stops = context_.control.stops();
  json asked{{"approved", id}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::proposal, std::move(asked));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (context_.control.stops() != stops) {
    co_return fail(stopped_meanwhile("the approval"));
  }
  if (const auto kernel = context_.need_present_state(); !kernel) {
    co_return fail(kernel.error());
  }
  co_return context_.registry.approve(id, context_.view(), call.caller.asked)
      .map([](const Proposal& approved) { return Success{Status::ok, to_json(approved)}; })
      .map_error(refused);
}

Answering ProposalRoutes::reject(const Call& call) const {
  const auto shown = show(call);
  if (!shown) {
    co_return shown;
  }
  const std::uint32_t id = *number_in(call.parameters[0]);
  // Better late than never: it waits for no store.
  context_.store.note(context_.entry(call.caller, AuditKind::proposal, {{"rejected", id}}));
  co_return context_.registry.reject(id, call.caller.user)
      .map([](const Proposal& rejected) { return Success{Status::ok, to_json(rejected)}; })
      .map_error(refused);
}

Answering ProposalRoutes::plan(const Call& call) const {
  const auto shown = show(call);
  if (!shown) {
    co_return shown;
  }
  const Proposal proposal = *context_.registry.find(*number_in(call.parameters[0]));
  const auto targeting = co_await present_targeting(context_);
  if (!targeting) {
    co_return fail(targeting.error());
  }
  auto work = [proposal, targeting = *targeting, robot = &context_.robot, config = &context_.config] {
    return proposal_plan(*robot, *config, targeting, proposal);
  };
  co_return (co_await context_.work.run(std::move(work))).map([](json body) {
    return Success{.body = std::move(body)};
  });
}

Reply ProposalRoutes::show(const Call& call) const {
  (void)context_.view();
  const auto id = number_in(call.parameters[0]);
  const Proposal* found = id ? context_.registry.find(*id) : nullptr;
  if (found == nullptr) {
    return fail(not_found("proposal " + call.parameters[0], "an id that /api/proposals lists"));
  }
  return Success{Status::ok, to_json(*found)};
}

Reply ProposalRoutes::abort(const Call& call) const {
  return show(call).and_then([&](const Success&) -> Reply {
    return context_.registry.abort(*number_in(call.parameters[0]), call.caller.user)
        .map([](const Proposal& ended) { return Success{Status::ok, to_json(ended)}; })
        .map_error(refused);
  });
}

}  // namespace interlock::web
