#include "http/routes.hpp"
#include "service/declared_positions.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/set_home.hpp"
#include "service/status_json.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

std::optional<std::uint32_t> request_of_action(const std::string& action) {
  constexpr std::pair<const char*, std::uint32_t> actions[] = {{"enable", ILK_REQUEST_ENABLE},
                                                               {"disable", ILK_REQUEST_DISABLE},
                                                               {"clear-fault", ILK_REQUEST_CLEAR_FAULT},
                                                               {"set-home", ILK_REQUEST_SET_HOME}};
  for (const auto& [name, request] : actions) {
    if (action == name) {
      return request;
    }
  }
  return std::nullopt;
}

/** Whether the caller says that an axis stands at home whatever its switch would tell. */
tl::expected<bool, Problem> overrides_switch(const Call& call) {
  if (call.request.body().empty()) {
    return false;
  }
  return parse_body(call.request).and_then([](const json& body) -> tl::expected<bool, Problem> {
    Fields fields(body, {"override_switch"});
    const bool overrides = fields.boolean("override_switch").value_or(false);
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return overrides;
  });
}

/** What is asked of the axis, as the audit is to name it; 409 HAS_SWITCH where its switch is to be asked. */
tl::expected<std::string, Problem> set_home_of(const Axis& axis, bool overrides) {
  const std::string what = axis.name + " set-home";
  if (!has_switch(axis)) {
    return what;
  }
  if (!overrides) {
    return fail(refused(switch_knows_home(axis)));
  }
  return what + ", its switch overridden";
}

}  // namespace

MotorRoutes::MotorRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/motors", viewers, [this](const Call&) -> Answering { co_return motors(); });
  router.add(verb::get, "/api/motors/{axis}", viewers,
             [this](const Call& call) -> Answering { co_return motor(call); });
  router.add(verb::post, "/api/motors/{axis}/{action}", holder,
             [this](const Call& call) { return act(call); });
}

tl::expected<const Axis*, Problem> MotorRoutes::axis_of(const std::string& slot_or_name) const {
  const auto slot = number_in(slot_or_name);
  const Axis* axis = slot ? context_.robot.at_slot(*slot) : context_.robot.find(slot_or_name);
  if (axis == nullptr) {
    return fail(not_found("axis " + slot_or_name, "slot or name of an axis that /api/motors lists"));
  }
  return axis;
}

Reply MotorRoutes::motors() const {
  return context_.need_kernel().map([this] {
    const ControlView& now = context_.view();
    json motors = json::array();
    for (const Axis& axis : context_.robot.axes) {
      motors.push_back(motor_json(axis, context_.config, now, context_.registry));
    }
    return Success{Status::ok, std::move(motors)};
  });
}

Reply MotorRoutes::motor(const Call& call) const {
  return axis_of(call.parameters[0]).and_then([this](const Axis* axis) -> Reply {
    return context_.need_kernel().map([&] {
      const ControlView& now = context_.view();
      return Success{Status::ok, motor_json(*axis, context_.config, now, context_.registry)};
    });
  });
}

Answering MotorRoutes::act(const Call& call) const {
  const auto axis = axis_of(call.parameters[0]);
  if (!axis) {
    co_return fail(axis.error());
  }
  const std::string& action = call.parameters[1];
  const auto request = request_of_action(action);
  if (!request) {
    co_return fail(not_found("action " + action, "enable, disable, clear-fault or set-home"));
  }
  const auto overrides = overrides_switch(call);
  if (!overrides) {
    co_return fail(overrides.error());
  }
  std::string what = (*axis)->name + " " + action;
  if (*request == ILK_REQUEST_SET_HOME) {
    auto declared = set_home_of(**axis, *overrides);
    if (!declared) {
      co_return fail(declared.error());
    }
    what = std::move(*declared);
  }
  const ilk_axis_t before = context_.view().snapshot.state.axis[(*axis)->slot];
  Reply reply = co_await context_.ask_kernel(call.caller, *request, (*axis)->slot, std::move(what));
  if (*request == ILK_REQUEST_SET_HOME && reply) {
    context_.declared_positions.begin(call.caller.user, context_.clock(), context_.steady_clock());
    context_.declared_positions.add({.axis = *axis, .kind = *request}, before);
  }
  co_return reply;
}

}  // namespace interlock::web
