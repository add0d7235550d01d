#include "http/routes/communication_routes.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>

#include "http/fields.hpp"
#include "http/problems.hpp"

namespace interlock::web {
namespace {

using Answering = boost::asio::awaitable<Reply>;
using boost::beast::http::verb;
using nlohmann::json;

/** A connection that the app itself makes and keeps. */
json own_connection(const char* type, const char* name, const std::optional<UtcTime>& since) {
  return {{"id", nullptr},     {"type", type},
          {"name", name},      {"connected", since.has_value()},
          {"client", nullptr}, {"user", nullptr},
          {"port", nullptr},   {"since", since ? json(iso_8601(*since)) : json()}};
}

tl::expected<std::uint32_t, Problem> connection_of(const Request& request) {
  return parse_body(request).and_then([](const json& body) -> tl::expected<std::uint32_t, Problem> {
    Fields fields(body, {"id"});
    const auto id = fields.integer("id", 1, std::numeric_limits<std::uint32_t>::max());
    fields.require({{"id", "number of a connection that /api/communications lists"}});
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return static_cast<std::uint32_t>(*id);
  });
}

Problem no_connection(std::uint32_t id) {
  return not_found("connection " + std::to_string(id), "an id that /api/communications lists");
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
  router.add(verb::get, "/api/communications", viewers, [this](const Call&) { return list(); });
  router.add(verb::put, "/api/communications/disconnect", engineers,
             [this](const Call& call) { return disconnect(call); });
}

Answering CommunicationRoutes::list() const {
  (void)context_.view();
  json connections = json::array({own_connection("kernel", "interlock-kernel", context_.control.since())});
  if (context_.bench.need_simulated()) {
    const auto since = co_await context_.bench.connected_since();
    connections.push_back(own_connection("bench", "Simulated hardware", since));
  }
  for (const StreamHub::Watcher& watcher : context_.stream.watchers()) {
    connections.push_back(console_connection(watcher));
  }
  co_return Success{.body = std::move(connections)};
}

Answering CommunicationRoutes::disconnect(const Call& call) const {
  const auto id = connection_of(call.request);
  if (!id) {
    co_return fail(id.error());
  }
  const auto watchers = context_.stream.watchers();
  const auto watcher = std::ranges::find(watchers, *id, &StreamHub::Watcher::id);
  if (watcher == watchers.end()) {
    co_return fail(no_connection(*id));
  }
  json detail{{"action", "disconnect"},
              {"id", *id},
              {"client", watcher->caller.peer},
              {"user", watcher->caller.user}};
  const auto announced = co_await context_.announce(call.caller, AuditKind::connection, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (!context_.stream.disconnect(*id)) {
    co_return fail(no_connection(*id));
  }
  spdlog::info("{} disconnected connection {}", call.caller.user, *id);
  co_return co_await list();
}

}  // namespace interlock::web
