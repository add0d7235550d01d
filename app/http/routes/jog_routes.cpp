#include <array>

#include "http/routes.hpp"
#include "motion/setpoint_range.hpp"
#include "proposals/checks.hpp"
#include "proposals/proposal_json.hpp"
#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

struct JogRequest {
  const Axis* axis = nullptr;
  bool increasing = false;
};

tl::expected<JogRequest, Problem> request_in(const json& body, const Robot& robot) {
  constexpr std::array<std::string_view, 2> directions{"increasing", "decreasing"};
  Fields fields(body, {"slot", "direction"});
  const auto slot = fields.integer("slot", 0, ILK_SLOTS - 1);
  const auto direction = fields.choice("direction", directions);
  fields.require({{"slot", "an integer from 0 to 9"}, {"direction", "increasing or decreasing"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  const Axis* axis = robot.at_slot(static_cast<std::uint32_t>(*slot));
  if (axis == nullptr) {
    return fail(not_found("axis in slot " + std::to_string(*slot), "a slot that /api/motors lists"));
  }
  return JogRequest{axis, direction == "increasing"};
}

/** A move as far as range and linkage allow in that direction; RANGE where that would lead the other way. */
tl::expected<Task, Problem> task_of(const JogRequest& request, const Context& context,
                                    const std::string& author) {
  const ilk_state_t& state = context.view().snapshot.state;
  const std::uint32_t slot = request.axis->slot;
  const SetpointRange range = setpoint_range(context.config.axis[slot], state.axis[slot], state.system.mode);
  const std::int32_t here = state.axis[slot].position_counts;
  const std::int32_t end = request.increasing ? range.highest_counts : range.lowest_counts;
  if (request.increasing ? end <= here : end >= here) {
    return fail(refused(verdict_refusal(
        ILK_VERDICT_RANGE, request.axis->name + " stands at its end, " + counts_and_unit(*request.axis, here),
        "the other direction")));
  }
  const std::int32_t allowed = linked_end(context.robot, states_of(context.view()), {slot, end});
  return Task{MoveTask{slot, allowed, std::nullopt, true}, author};
}

Problem jog_lapsed() {
  return {.status = Status::conflict,
          .code = "JOG_LAPSED",
          .detail =
              "That jog has ended, or was not renewed within " + std::to_string(jog_timeout.count()) + " ms.",
          .next_step = "Jog again."};
}

}  // namespace

JogRoutes::JogRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::post, "/api/jog", holder, [this](const Call& call) { return begin(call); });
  router.add(verb::put, "/api/jog/{id}", holder,
             [this](const Call& call) -> Answering { co_return renew(call); });
}

Answering JogRoutes::begin(const Call& call) const {
  const auto request =
      parse_body(call.request).and_then([&](const json& body) { return request_in(body, context_.robot); });
  if (!request) {
    co_return fail(request.error());
  }
  if (const auto kernel = context_.need_kernel(); !kernel) {
    co_return fail(kernel.error());
  }
  auto task = task_of(*request, context_, call.caller.user);
  if (!task) {
    co_return fail(task.error());
  }
  const auto made = co_await propose(context_, call.caller, std::move(*task));
  if (!made) {
    co_return fail(made.error());
  }
  co_return Success{Status::created, to_json(*made)};
}

Reply JogRoutes::renew(const Call& call) const {
  const auto id = number_in(call.parameters[0]);
  (void)context_.view();
  if (!id || !context_.registry.renew(*id)) {
    return fail(jog_lapsed());
  }
  return Success{Status::ok, to_json(*context_.registry.find(*id))};
}

}  // namespace interlock::web
