#include <nlohmann/json.hpp>

#include "http/message.hpp"
#include "http/routes.hpp"
#include "service/reply.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

Problem no_such_alarm(const std::string& id) {
  return not_found("alarm " + id, "the id of an alarm that GET /api/alarms lists");
}

}  // namespace

AlarmRoutes::AlarmRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/alarms", viewers, [this](const Call&) -> Answering { co_return list(); });
  router.add(verb::post, "/api/alarms/{id}/acknowledge", engineers,
             [this](const Call& call) { return acknowledge(call); });
}

Reply AlarmRoutes::list() const {
  json body = context_.alarms.to_json();
  body["past"] = json::array();
  for (const Alarm& alarm : context_.alarms.past()) {
    body["past"].push_back(to_json(alarm));
  }
  return Success{.body = std::move(body)};
}

Answering AlarmRoutes::acknowledge(const Call& call) const {
  const std::string& text = call.parameters[0];
  const auto id = static_cast<std::uint32_t>(number_in(text).value_or(0));
  const Alarm* const found = context_.alarms.find(id);
  if (found == nullptr) {
    co_return fail(no_such_alarm(text));
  }
  json detail{{"alarm", to_json(*found)}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::acknowledgement, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  context_.alarms.acknowledge(id, {call.caller.user, context_.clock()});
  json message = context_.alarms.to_json();
  message["type"] = "alarms";
  context_.publish(message);
  co_return list();
}

}  // namespace interlock::web
