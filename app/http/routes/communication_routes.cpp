#include "http/routes/communication_routes.hpp"

#include <spdlog/spdlog.h>

#include <limits>

#include "http/fields.hpp"
#include "http/problems.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** A connection that the app itself makes and keeps. */
json own_connection(const char* type, const char* name, bool connected) {
  return {{"id", nullptr},     {"type", type},    {"name", name},    {"connected", connected},
          {"client", nullptr}, {"user", nullptr}, {"port", nullptr}, {"since", nullptr}};
}

json console_connection(const StreamHub::Watcher& watcher) {
  return {{"id", watcher.id},
          {"type", "console"},
          {"name", "Console"},
          {"connected", true},
          {"client", watcher.caller.peer},
          {"user", watcher.caller.user},
          {"port", watcher.port},
          {"since", iso_8601(watcher.since)}};
}

}  // namespace

CommunicationRoutes::CommunicationRoutes(const Context& context, Router& router) : context_(context) {
  router.add(verb::get, "/api/communications", viewers,
             [this](const Call&) -> Answering { co_return list(); });
  router.add(verb::put, "/api/communications/disconnect", engineers,
             [this](const Call& call) -> Answering { co_return disconnect(call); });
}

Reply CommunicationRoutes::list() const {
  json connections = json::array({own_connection("kernel", "interlock-kernel", context_.view().attached)});
  if (context_.bench.need_simulated()) {
    connections.push_back(own_connection("bench", "Simulated hardware", true));
  }
  for (const StreamHub::Watcher& watcher : context_.stream.watchers()) {
    connections.push_back(console_connection(watcher));
  }
  return Success{.body = std::move(connections)};
}

Reply CommunicationRoutes::disconnect(const Call& call) const {
  return parse_body(call.request).and_then([&](const json& body) -> Reply {
    Fields fields(body, {"id"});
    const auto id = fields.integer("id", 1, std::numeric_limits<std::uint32_t>::max());
    fields.require({{"id", "number of a connection that /api/communications lists"}});
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    if (!context_.stream.disconnect(static_cast<std::uint32_t>(*id))) {
      return fail(not_found("connection " + std::to_string(*id), "an id that /api/communications lists"));
    }
    spdlog::info("{} disconnected connection {}", call.caller.user, *id);
    return list();
  });
}

}  // namespace interlock::web
