#include <algorithm>

#include "http/routes.hpp"
#include "robot/compile.hpp"
#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

const char* kind_of(const HomeStep& step) {
  if (!step.home.empty()) {
    return "home";
  }
  return step.nudge.empty() ? "move" : "nudge";
}

json axes_of(const HomeStep& step, const Robot& robot) {
  json names = json::array();
  for (const std::uint32_t slot : step.home) {
    names.push_back(robot.at_slot(slot)->name);
  }
  for (const auto* travels : {&step.nudge, &step.move}) {
    for (const AxisCounts& travel : *travels) {
      names.push_back(robot.at_slot(travel.slot)->name);
    }
  }
  return names;
}

json robot_json(const Robot& robot, const ilk_config_t& config) {
  json steps = json::array();
  for (const HomeStep& step : robot.home_steps) {
    steps.push_back({{"name", step.name},
                     {"title", step.title},
                     {"kind", kind_of(step)},
                     {"axes", axes_of(step, robot)}});
  }
  json axes = json::array();
  for (const Axis& axis : robot.axes) {
    axes.push_back(axis.name);
  }
  return {{"name", robot.name},
          {"title", robot.title},
          {"config_crc", config_hash(config)},
          {"kinematics", robot.family},
          {"modes", robot.modes},
          {"auto_approve", robot.auto_approve},
          {"home_steps", std::move(steps)},
          {"axes", std::move(axes)}};
}

Problem needs_targets() {
  return {.status = Status::conflict,
          .code = "NO_TARGETS",
          .detail = "Such motion needs targets, which a mode does not name.",
          .expected = "a proposal of kind coordinated, pose, ablation or biopsy",
          .next_step = "Propose it on the page Proposals, or by POST /api/proposals."};
}

}  // namespace

json mode_json(const Robot& robot, std::string_view mode) { return {{"mode", mode}, {"modes", robot.modes}}; }

ModeRoutes::ModeRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/robots", viewers, [this](const Call&) -> Answering { co_return robots(); });
  router.add(verb::get, "/api/mode", viewers, [this](const Call&) -> Answering { co_return mode(); });
  router.add(verb::put, "/api/mode", holder, [this](const Call& call) { return set_mode(call); });
}

Reply ModeRoutes::robots() const {
  return Success{.body = json::array({robot_json(context_.robot, context_.config)})};
}

Reply ModeRoutes::mode() const {
  (void)context_.view();
  return Success{.body = mode_json(context_.robot, context_.registry.app_mode())};
}

tl::expected<std::string, Problem> ModeRoutes::desired_mode(const Call& call) const {
  return parse_body(call.request).and_then([&](const json& body) -> tl::expected<std::string, Problem> {
    const std::vector<std::string_view> modes(context_.robot.modes.begin(), context_.robot.modes.end());
    Fields fields(body, {"mode"});
    const auto desired = fields.choice("mode", modes);
    fields.require({{"mode", "a mode of the robot"}});
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return std::string(*desired);
  });
}

/** What the mode names without a target. */
boost::asio::awaitable<tl::expected<Task, Problem>> ModeRoutes::task_for(std::string mode,
                                                                         std::string author) const {
  const auto drafts = draft_kinds();
  const auto draft = std::ranges::find(drafts, mode, &DraftKind::mode);
  if (draft == drafts.end()) {
    co_return fail(needs_targets());
  }
  json body = json::object();
  body["kind"] = draft->name;
  co_return co_await draft->read(context_, std::move(body), std::move(author));
}

Answering ModeRoutes::set_mode(const Call& call) const {
  const auto desired = desired_mode(call);
  if (!desired) {
    co_return fail(desired.error());
  }
  if (*desired == RobotMode::manual.name) {
    co_return go_manual(call.caller.user);
  }
  (void)context_.view();
  if (context_.registry.app_mode() == *desired) {
    co_return mode();
  }
  if (const auto kernel = context_.need_kernel(); !kernel) {
    co_return fail(kernel.error());
  }
  auto task = co_await task_for(*desired, call.caller.user);
  if (!task) {
    co_return fail(task.error());
  }
  auto made = co_await propose(context_, call.caller, std::move(*task));
  co_return std::move(made).and_then([this](const Proposal&) { return mode(); });
}

Reply ModeRoutes::go_manual(const std::string& by) const {
  (void)context_.view();
  const Proposal* home = context_.registry.open_home();
  const Proposal* open = home == nullptr ? context_.registry.open_mode() : home;
  if (open != nullptr) {
    const auto aborted = context_.registry.abort(open->id, by);
    if (!aborted) {
      return fail(refused(aborted.error()));
    }
  }
  return mode();
}

}  // namespace interlock::web
