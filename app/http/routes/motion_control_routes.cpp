#include <limits>

#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

Problem asks_not(std::int64_t session) {
  return not_found("request of session " + std::to_string(session), "one that /api/control lists");
}

tl::expected<std::uint32_t, Problem> session_of(const Request& request) {
  return parse_body(request).and_then([](const json& body) -> tl::expected<std::uint32_t, Problem> {
    Fields fields(body, {"session"});
    fields.require({{"session", "a session's number"}});
    const auto session = fields.integer("session", 1, std::numeric_limits<std::uint32_t>::max());
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return static_cast<std::uint32_t>(*session);
  });
}

}  // namespace

MotionControlRoutes::MotionControlRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/control", viewers,
             [this](const Call& call) -> Answering { co_return shown(call); });
  router.add(verb::post, "/api/control/request", engineers,
             [this](const Call& call) { return request(call); });
  router.add(verb::post, "/api/control/release", engineers,
             [this](const Call& call) -> Answering { co_return release(call); });
  router.add(verb::post, "/api/control/hand-over", holder,
             [this](const Call& call) { return hand_over(call); });
  router.add(verb::post, "/api/control/take-over", admins,
             [this](const Call& call) { return take_over(call); });
}

Success MotionControlRoutes::shown(const Call& call, Status status) const {
  return {status, context_.motion_control.shown_to(call.caller.session)};
}

tl::expected<void, Problem> MotionControlRoutes::need_robot() const {
  if (context_.view().replay) {
    return fail({.status = Status::conflict,
                 .code = "REPLAY",
                 .detail = "A recording plays: there is no robot to move.",
                 .next_step = "Start the robot with `interlock run` to move it."});
  }
  return {};
}

boost::asio::awaitable<tl::expected<void, Problem>> MotionControlRoutes::record_then_recheck(
    const Call& call, const char* action) const {
  json detail{{"action", action}};
  return context_.record_then_recheck(call.caller, AuditKind::control, std::move(detail));
}

Answering MotionControlRoutes::request(const Call& call) const {
  MotionControl& control = context_.motion_control;
  if (const auto robot = need_robot(); !robot) {
    co_return fail(robot.error());
  }
  if (control.held_by(call.caller.session)) {
    co_return shown(call);
  }
  if (const auto announced = co_await record_then_recheck(call, "request"); !announced) {
    co_return fail(announced.error());
  }
  Claim claim{call.caller.session, call.caller.user, context_.clock()};
  if (!control.holder()) {
    control.give(std::move(claim));
  } else {
    control.request(std::move(claim));
  }
  co_return shown(call, control.held_by(call.caller.session) ? Status::ok : Status::accepted);
}

/** Waits for no store: a release of control ends motion. */
Reply MotionControlRoutes::release(const Call& call) const {
  json detail{{"action", "release"}};
  context_.store.note(context_.entry(call.caller, AuditKind::control, std::move(detail)));
  context_.motion_control.release(call.caller.session);
  return shown(call);
}

Answering MotionControlRoutes::hand_over(const Call& call) const {
  MotionControl& control = context_.motion_control;
  const auto session = session_of(call.request);
  if (!session) {
    co_return fail(session.error());
  }
  if (control.request_of(*session) == nullptr) {
    co_return fail(asks_not(*session));
  }
  if (const auto announced = co_await record_then_recheck(call, "hand over"); !announced) {
    co_return fail(announced.error());
  }
  const Claim* const claim = control.request_of(*session);
  if (claim == nullptr) {
    co_return fail(asks_not(*session));
  }
  control.give({claim->session, claim->user, context_.clock()});
  co_return shown(call);
}

Answering MotionControlRoutes::take_over(const Call& call) const {
  if (const auto robot = need_robot(); !robot) {
    co_return fail(robot.error());
  }
  if (const auto announced = co_await record_then_recheck(call, "take over"); !announced) {
    co_return fail(announced.error());
  }
  context_.motion_control.give({call.caller.session, call.caller.user, context_.clock()});
  co_return shown(call);
}

}  // namespace interlock::web
