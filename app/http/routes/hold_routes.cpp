#include <array>

#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/hold_service.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

HoldSource source_of(const Caller& caller) {
  return {.session = caller.session, .name = caller.user + ", session " + std::to_string(caller.session)};
}

tl::expected<bool, Problem> switch_in(const Request& request, const char* field) {
  return parse_body(request).and_then([&](const json& body) -> tl::expected<bool, Problem> {
    Fields fields(body, {field});
    const auto on = fields.boolean(field);
    fields.require({{field, "true or false"}});
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return *on;
  });
}

tl::expected<igtl::GateSignal, Problem> signal_in(const json& body) {
  constexpr std::array<std::string_view, 2> states{"open", "hold"};
  Fields fields(body, {"state", "valid_ms"});
  const auto state = fields.choice("state", states);
  const auto valid_ms = fields.integer("valid_ms", shortest_gate_signal.count(), longest_gate_signal.count());
  fields.require({{"state", "open or hold"}});
  if (fields.problem()) {
    return fail(*fields.problem());
  }
  return igtl::GateSignal{*state == "open",
                          std::chrono::milliseconds(valid_ms.value_or(usual_gate_signal.count()))};
}

}  // namespace

HoldRoutes::HoldRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/holds", viewers, [this](const Call&) -> Answering { co_return show(); });
  router.add(verb::put, "/api/holds/gate", holder, [this](const Call& call) { return use_gate(call); });
  router.add(verb::post, "/api/holds/gate/signal", engineers,
             [this](const Call& call) -> Answering { co_return signal(call); });
  router.add(verb::put, "/api/holds/scan", engineers, [this](const Call& call) { return set_scan(call); });
}

Reply HoldRoutes::show() const {
  (void)context_.view();
  return Success{.body = context_.holds.to_json(context_.steady_clock())};
}

/** What holds motion back comes first and is recorded then; what lets it go waits for its record. */
Answering HoldRoutes::use_gate(const Call& call) const {
  const auto in_use = switch_in(call.request, "in_use");
  if (!in_use) {
    co_return fail(in_use.error());
  }
  if (context_.robot.with_role("insertion") == nullptr) {
    co_return fail(not_found("axis that inserts", "a robot with an axis of the role insertion"));
  }
  json detail{{"breathing_gate", *in_use ? "in use" : "off"}};
  if (*in_use) {
    context_.holds.use_gate(true);
    context_.store.note(context_.entry(call.caller, AuditKind::setting, std::move(detail)));
    co_return show();
  }
  const auto recorded =
      co_await context_.record_then_recheck(call.caller, AuditKind::setting, std::move(detail));
  co_return recorded.and_then([&] {
    context_.holds.use_gate(false);
    return show();
  });
}

Reply HoldRoutes::signal(const Call& call) const {
  return parse_body(call.request)
      .and_then(signal_in)
      .and_then([&](const igtl::GateSignal& signal) {
        return context_.holds.signal(source_of(call.caller), signal, call.caller.asked);
      })
      .and_then([&] { return show(); });
}

Answering HoldRoutes::set_scan(const Call& call) const {
  const auto active = switch_in(call.request, "active");
  if (!active) {
    co_return fail(active.error());
  }
  const HoldSource source = source_of(call.caller);
  json detail{{"scan", *active ? "begun" : "ended"}};
  if (*active == context_.holds.scanning()) {
    co_return show();
  }
  if (*active) {
    context_.begin_scan(source);
    context_.store.note(context_.entry(call.caller, AuditKind::setting, std::move(detail)));
    co_return show();
  }
  const auto may_end = [&] {
    return context_.holds.may_end_scan(source, context_.motion_control.held_by(call.caller.session));
  };
  if (const auto may = may_end(); !may) {
    co_return fail(may.error());
  }
  const auto recorded =
      co_await context_.record_then_recheck(call.caller, AuditKind::setting, std::move(detail));
  co_return recorded.and_then(may_end).and_then([&] {
    context_.end_scan();
    return show();
  });
}

}  // namespace interlock::web
