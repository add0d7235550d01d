#include <algorithm>
#include <string_view>
#include <vector>

#include "http/routes.hpp"
#include "proposals/proposal_json.hpp"
#include "service/drafts.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"
#include "tuning/robot_changes.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** Which of the drafts is meant: a move where nothing is said. */
tl::expected<const DraftKind*, Problem> draft_in(const json& body) {
  std::vector<std::string_view> names;
  for (const DraftKind& each : draft_kinds()) {
    if (!each.name.empty()) {
      names.push_back(each.name);
    }
  }
  Fields fields = Fields::some_of(body);
  const std::string kind = fields.choice("kind", names).value_or("move");
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return &*std::ranges::find(draft_kinds(), kind, &DraftKind::name);
}

}  // namespace

ProposalRoutes::ProposalRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/proposals", viewers, [this](const Call&) -> Answering { co_return list(); });
  router.add(verb::post, "/api/proposals", holder, [this](const Call& call) { return propose(call); });
  router.add(verb::get, "/api/proposals/{id}", viewers,
             [this](const Call& call) -> Answering { co_return show(call); });
  router.add(verb::get, "/api/proposals/{id}/plan", viewers, [this](const Call& call) { return plan(call); });
  router.add(verb::get, "/api/proposals/{id}/robot-file", viewers,
             [this](const Call& call) -> Answering { co_return robot_file(call); });
  router.add(verb::post, "/api/proposals/{id}/approve", holder,
             [this](const Call& call) { return consent(call, "approved", &MotionRegistry::approve); });
  router.add(verb::post, "/api/proposals/{id}/confirm", holder,
             [this](const Call& call) { return consent(call, "confirmed", &MotionRegistry::confirm); });
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
  auto body = parse_body(call.request);
  const auto draft = body.and_then(draft_in);
  if (!draft) {
    co_return fail(draft.error());
  }
  co_return co_await (*draft)->read(context_, std::move(*body), call.caller.user);
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

Answering ProposalRoutes::consent(const Call& call, const char* word, Consent give) const {
  const auto shown = show(call);
  if (!shown) {
    co_return shown;
  }
  const std::uint32_t id = *number_in(call.parameters[0]);
  const std::uint32_t stops = context_.control.stops();
  json asked{{word, id}};
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
  co_return (context_.registry.*give)(id, context_.view(), call.caller.asked)
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

/** What a measured axis asks of the robot's file: schema `RobotFileChange`. */
Reply ProposalRoutes::robot_file(const Call& call) const {
  return show(call).and_then([&](const Success&) -> Reply {
    const Proposal& proposal = *context_.registry.find(*number_in(call.parameters[0]));
    if (!proposal.measured || proposal.state != ProposalState::done) {
      return fail(
          Problem{.status = Status::conflict,
                  .code = "NOT_MEASURED",
                  .detail = "Proposal " + std::to_string(proposal.id) + " has measured nothing whole.",
                  .expected = "a proposal of kind identify that is done",
                  .next_step = "Let it run to its end, or propose it again."});
    }
    const Robot& robot = context_.robot;
    const std::string& axis = proposal.axis;
    const Identified found{*proposal.measured, axis};
    const auto changes = changes_of(robot, *robot.find(axis), found);
    const std::string name = robot.name + ".toml";
    const auto text =
        believable(robot, axis, found).and_then([&] { return changed_file(robot, name, axis, changes); });
    return Success{.body = {{"name", name},
                            {"changes", to_json(changes)},
                            {"text", text ? json(*text) : json()},
                            {"diff", text ? unified_diff(robot.text, *text, name) : ""},
                            {"problem", text ? json() : json(text.error().message())}}};
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
