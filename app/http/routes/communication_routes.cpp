#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "http/routes.hpp"
#include "service/fields.hpp"
#include "service/reply.hpp"

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

json console_connection(const Broadcaster::Subscriber& subscriber) {
  return {{"id", subscriber.id},
          {"type", "console"},
          {"name", "Console"},
          {"connected", true},
          {"client", subscriber.caller.peer},
          {"user", subscriber.caller.user},
          {"port", subscriber.port},
          {"since", iso_8601(subscriber.since)}};
}

/** Schema `NavigationConnection`. */
json navigation_json(const igtl::Peer& peer, const std::string& dialect) {
  using Seconds = std::chrono::duration<double>;
  json messages = json::array();
  for (const auto& [name, heard] : peer.heard) {
    const Seconds age = std::chrono::steady_clock::now() - heard.last;
    messages.push_back({{"name", name},
                        {"type", heard.type},
                        {"count", heard.count},
                        {"age_s", age.count()},
                        {"rate_hz", heard.interval && heard.interval->count() > 0
                                        ? json(1.0 / Seconds(*heard.interval).count())
                                        : json()}});
  }
  return {{"id", peer.id},
          {"client", peer.address},
          {"port", peer.port},
          {"dialect", dialect},
          {"role", igtl::role_word(peer.role)},
          {"header_version", peer.version},
          {"since", iso_8601(peer.since)},
          {"received", peer.received},
          {"sent", peer.sent},
          {"refused", peer.refused},
          {"replaced", peer.replaced},
          {"round_trip_ms", peer.round_trip ? json(Seconds(*peer.round_trip).count() * 1000.0) : json()},
          {"messages", std::move(messages)}};
}

tl::expected<igtl::Role, Problem> role_in(const Request& request) {
  return parse_body(request).and_then([](const json& body) -> tl::expected<igtl::Role, Problem> {
    constexpr std::array<std::string_view, 2> roles{"observer", "controller"};
    Fields fields(body, {"role"});
    const auto role = fields.choice("role", roles);
    fields.require({{"role", "observer or controller"}});
    if (fields.problem()) {
      return fail(*fields.problem());
    }
    return role == "controller" ? igtl::Role::controller : igtl::Role::observer;
  });
}

Problem no_navigation(std::string_view id) {
  return not_found("OpenIGTLink connection " + std::string(id),
                   "an id that /api/communications/connections lists");
}

json openigtlink_connection(const igtl::Peer& peer) {
  return {{"id", nullptr},     {"type", "openigtlink"},        {"name", "OpenIGTLink"},
          {"connected", true}, {"client", peer.address},       {"user", nullptr},
          {"port", peer.port}, {"since", iso_8601(peer.since)}};
}

}  // namespace

CommunicationRoutes::CommunicationRoutes(const Context& context, Navigation& navigation, Broadcaster& stream,
                                         Router& router)
    : context_(context), navigation_(navigation), stream_(stream) {
  router.add(verb::get, "/api/communications/connections", viewers,
             [this](const Call&) -> Answering { co_return list_navigation(); });
  router.add(verb::delete_, "/api/communications/connections/{id}", engineers,
             [this](const Call& call) { return end_navigation(call); });
  router.add(verb::put, "/api/communications/connections/{id}/role", holder,
             [this](const Call& call) { return set_role(call); });
  router.add(verb::get, "/api/communications/imager", viewers, [this](const Call&) -> Answering {
    co_return Success{.body = navigation_.imager().to_json(context_.steady_clock())};
  });
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
  for (const Broadcaster::Subscriber& subscriber : stream_.subscribers()) {
    connections.push_back(console_connection(subscriber));
  }
  for (const igtl::Peer& peer : navigation_.server().peers()) {
    connections.push_back(openigtlink_connection(peer));
  }
  co_return Success{.body = std::move(connections)};
}

Reply CommunicationRoutes::list_navigation() const {
  json connections = json::array();
  for (const igtl::Peer& peer : navigation_.server().peers()) {
    connections.push_back(navigation_json(peer, navigation_.dialect()));
  }
  return Success{.body = std::move(connections)};
}

Answering CommunicationRoutes::end_navigation(const Call& call) const {
  const std::uint32_t id = number_in(call.parameters[0]).value_or(0);
  const auto peer = navigation_.server().find(id);
  if (!peer) {
    co_return fail(no_navigation(call.parameters[0]));
  }
  json detail{{"action", "disconnect"}, {"id", id}, {"client", peer->address}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::connection, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (!navigation_.server().disconnect(id, "disconnected by " + call.caller.user)) {
    co_return fail(no_navigation(call.parameters[0]));
  }
  co_return list_navigation();
}

Answering CommunicationRoutes::set_role(const Call& call) const {
  const std::uint32_t id = number_in(call.parameters[0]).value_or(0);
  const auto role = role_in(call.request);
  if (!role) {
    co_return fail(role.error());
  }
  const auto peer = navigation_.server().find(id);
  if (!peer) {
    co_return fail(no_navigation(call.parameters[0]));
  }
  json detail{{"action", "role"}, {"id", id}, {"client", peer->address}, {"role", igtl::role_word(*role)}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::connection, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (!navigation_.set_role(id, *role, call.caller)) {
    co_return fail(no_navigation(call.parameters[0]));
  }
  co_return list_navigation();
}

Answering CommunicationRoutes::disconnect(const Call& call) const {
  const auto id = connection_of(call.request);
  if (!id) {
    co_return fail(id.error());
  }
  const auto subscribers = stream_.subscribers();
  const auto subscriber = std::ranges::find(subscribers, *id, &Broadcaster::Subscriber::id);
  if (subscriber == subscribers.end()) {
    co_return fail(no_connection(*id));
  }
  json detail{{"action", "disconnect"},
              {"id", *id},
              {"client", subscriber->caller.peer},
              {"user", subscriber->caller.user}};
  const auto announced =
      co_await context_.record_then_recheck(call.caller, AuditKind::connection, std::move(detail));
  if (!announced) {
    co_return fail(announced.error());
  }
  if (!stream_.disconnect(*id)) {
    co_return fail(no_connection(*id));
  }
  spdlog::info("{} disconnected connection {}", call.caller.user, *id);
  co_return co_await list();
}

}  // namespace interlock::web
