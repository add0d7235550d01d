#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** Whether a command is more than a question, or than the renewal of a pedal's hold five times a second. */
bool changes_something(const std::string& command, const json& fields) {
  const bool question = command == "status" || command == "record" || command == "record_event";
  return !question && !(command == "pedal" && fields.value("renew", json()) == json(true));
}

}  // namespace

BenchRoutes::BenchRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/bench", viewers, [this](const Call& call) { return status(call); });
  router.add(verb::post, "/api/bench/{command}", engineers,
             [this](const Call& call) { return command(call); });
}

Answering BenchRoutes::status(const Call& call) const {
  return context_.bench.command("status", json::object(), context_.view(), call.caller.session);
}

Answering BenchRoutes::command(const Call& call) const {
  if (const auto simulated = context_.bench.need_simulated(); !simulated) {
    co_return fail(simulated.error());
  }
  auto body = parse_body(call.request);
  if (!body) {
    co_return fail(body.error());
  }
  if (!body->is_object() || body->contains("command") || body->contains("id")) {
    const std::string field = body->is_object() ? "command" : "";
    co_return fail(invalid(field, "The body must be an object without command and id.",
                           "the fields of models/plant/README.md"));
  }
  if (changes_something(call.parameters[0], *body)) {
    json detail{{"command", call.parameters[0]}, {"fields", *body}};
    context_.store.note(context_.entry(call.caller, AuditKind::bench, std::move(detail)));
  }
  co_return co_await context_.bench.command(call.parameters[0], std::move(*body), context_.view(),
                                            call.caller.session);
}

}  // namespace interlock::web
