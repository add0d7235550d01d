#include "http/server.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "http/same_origin.hpp"
#include "system/as_result.hpp"
#include "system/launch.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;

constexpr std::chrono::seconds request_timeout{30};
constexpr std::chrono::seconds answer_timeout{10};
constexpr std::chrono::seconds drain_timeout{1};
constexpr std::size_t drain_bytes = 4u << 20u;

void log_transaction(const Request& request, const Caller& caller, http::status status) {
  spdlog::debug("{} {} {} {} -> {}", caller.peer, caller.user.empty() ? "nobody" : caller.user,
                std::string(request.method_string()), path_of(request), static_cast<unsigned>(status));
}

/** A request whose body says that it ends something. */
struct EndByBody {
  std::string_view path;
  std::string_view field;
  nlohmann::json value;
};

/** Whether the body asks for the end of what is held, or of a motion. */
bool ends_by_body(std::string_view path, const std::string& body) {
  static const std::array<EndByBody, 4> ends{{{"/api/bench/pedal", "pressed", false},
                                              {"/api/bench/estop", "pulled", true},
                                              {"/api/bench/hand", "newtons", 0},
                                              {"/api/mode", "mode", "manual"}}};
  const auto found = std::ranges::find(ends, path, &EndByBody::path);
  if (found == ends.end()) {
    return false;
  }
  const auto fields = nlohmann::json::parse(body, nullptr, false);
  return fields.is_object() && fields.value(found->field, nlohmann::json()) == found->value;
}

/** Whether that ends something: then it is better late than never. */
bool only_ends(const Request& request) {
  const std::string path = path_of(request);
  const bool removes = request.method() == http::verb::delete_;
  return path.ends_with("/disable") || path.ends_with("/abort") || path.ends_with("/reject") ||
         path == "/api/logout" || path == "/api/control/release" ||
         path == "/api/targeting/registration/expire" || path == "/api/communications/disconnect" ||
         (removes && path.starts_with("/api/sessions/")) ||
         (removes && path.starts_with("/api/communications/")) || ends_by_body(path, request.body());
}

Problem malformed_path() {
  return {.status = Status::bad_request,
          .code = "MALFORMED",
          .detail = "The path is malformed.",
          .expected = "a path, percent-encoded, without encoded slash, backslash or NUL"};
}

Problem all_at_work(std::size_t ceiling) {
  return {.status = Status::service_unavailable,
          .code = "OVERLOADED",
          .detail = "All " + std::to_string(ceiling) + " connections are at work.",
          .next_step = "Try again in a moment; STOP and the status are answered still.",
          .headers = {{"Retry-After", "1"}}};
}

/** So many connections, here and at the door, that the app itself and the reserve have descriptors left. */
std::size_t ceiling_of_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) {
    return Server::capacity;
  }
  constexpr std::size_t kept = Server::own_descriptors + Server::reserve;
  const std::size_t granted = limit.rlim_cur;
  return granted > kept + 3 ? std::min(Server::capacity, (granted - kept) / 3) : 1;
}

}  // namespace

Server::Server(const asio::any_io_executor& door, const asio::any_io_executor& executor, Api& api,
               RealtimeChannel& channel, StaticFiles files)
    : executor_(executor),
      api_(api),
      channel_(channel),
      files_(std::move(files)),
      ceiling_(ceiling_of_process()),
      door_(
          door, channel, ceiling_,
          [this](Guest guest) {
            if (arriving_.load(std::memory_order_relaxed) < ceiling_) {
              arriving_.fetch_add(1, std::memory_order_relaxed);
              asio::post(executor_, [this, guest = std::move(guest)]() mutable {
                arriving_.fetch_sub(1, std::memory_order_relaxed);
                admit(std::move(guest));
              });
            }
          },
          [this](StopMade made) { launch(executor_, record(std::move(made))); }) {}

/** Who stopped the robot is looked up where the sessions are. */
asio::awaitable<void> Server::record(StopMade made) {
  co_await api_.record_stop(std::move(made));
  door_.recorded();
}

void Server::admit(Guest guest) {
  const auto place = place_for_another();
  auto socket = socket_of(std::move(guest.socket), guest.protocol, executor_);
  if (!place || !socket) {
    return;
  }
  auto connection = std::make_shared<Connection>(Connection{beast::tcp_stream(std::move(*socket)),
                                                            guest.protocol, *place, std::move(guest.peer),
                                                            guest.known, guest.came, is_late(guest.came)});
  const auto listed = connections_.insert(connections_.end(), connection);
  asio::co_spawn(executor_, serve(connection), [this, listed](const std::exception_ptr& thrown) {
    connections_.erase(listed);
    if (thrown) {
      std::rethrow_exception(thrown);
    }
  });
}

/** Whoever sent it has given up since, or somebody has stopped the robot. */
bool Server::is_late(std::chrono::steady_clock::time_point came) const {
  return has_waited_too_long(came) ||
         came.time_since_epoch() <= channel_.last_stop.load(std::memory_order_relaxed);
}

void Server::give_back(Connection& connection) {
  beast::error_code error;
  const int socket = connection.stream.release_socket().release(error);
  if (!error) {
    door_.come_back(
        {FileDescriptor(socket), connection.protocol, std::move(connection.peer), connection.known, {}});
  }
}

std::size_t Server::connections() const { return open_in(Place::common) + open_in(Place::reserve); }

std::size_t Server::at_work() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(connections_, [](const auto& each) { return !each->closed && !each->waiting; }));
}

std::size_t Server::open_in(Place place) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      connections_, [&](const auto& each) { return !each->closed && each->place == place; }));
}

std::optional<Server::Place> Server::place_for_another() {
  if (open_in(Place::common) < ceiling_ || close_oldest_idle(Place::common)) {
    return Place::common;
  }
  if (open_in(Place::reserve) < reserve || close_oldest_idle(Place::reserve)) {
    return Place::reserve;
  }
  return std::nullopt;
}

bool Server::close_oldest_idle(Place place) {
  const auto idle = std::ranges::find_if(
      connections_, [&](const auto& each) { return !each->closed && each->waiting && each->place == place; });
  if (idle == connections_.end()) {
    return false;
  }
  (*idle)->closed = true;
  (*idle)->stream.close();
  return true;
}

asio::awaitable<void> Server::serve(std::shared_ptr<Connection> connection) {
  bool answered = false;
  for (bool keep_alive = true; keep_alive;) {
    if (connection->buffer.size() == 0 && std::exchange(answered, true)) {
      give_back(*connection);
      co_return;
    }
    http::request_parser<http::string_body> parser;
    parser.body_limit(longest_trajectory);
    parser.header_limit(longest_header);
    connection->stream.expires_after(request_timeout);
    connection->waiting = true;
    auto [error, header_bytes] =
        co_await http::async_read_header(connection->stream, connection->buffer, parser, as_result);
    std::optional<Problem> problem;
    if (error) {
      problem = unreadable(error);
    } else {
      problem = check_framing(parser.get());
    }
    if (!error && !problem) {
      const std::uint64_t limit = co_await body_limit_of(parser.get(), connection->peer);
      parser.body_limit(limit);
      if (parser.content_length().value_or(0) > limit) {
        error = http::error::body_limit;
      } else {
        std::tie(error, std::ignore) =
            co_await http::async_read(connection->stream, connection->buffer, parser, as_result);
      }
      problem = unreadable(error);
    }
    connection->waiting = false;
    if (problem) {
      co_await refuse(*connection, *problem);
    }
    if (error || problem) {
      co_return;
    }
    Request request = parser.release();
    if (connection->place == Place::common && beast::websocket::is_upgrade(request) &&
        path_of(request) == "/api/stream") {
      co_await serve_stream(*connection, std::move(request));
      co_return;
    }
    connection->stream.expires_never();
    AnyResponse response = co_await respond(request, *connection);
    keep_alive = co_await answer(*connection, std::move(response), request.method() == http::verb::head,
                                 request.keep_alive() && connection->place == Place::common);
  }
  beast::error_code ignored;
  connection->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

/** Only who may load a trajectory may send much. */
asio::awaitable<std::uint64_t> Server::body_limit_of(const Request& header, const std::string& peer) {
  if (header.method() != http::verb::put || path_of(header) != TrajectoryRoutes::path) {
    co_return longest_body;
  }
  const auto caller = co_await api_.caller_of(header, client_of(header, peer, door_.proxy()));
  co_return caller && !api_.router().check(holder, *caller) ? longest_trajectory : longest_body;
}

asio::awaitable<void> Server::serve_stream(Connection& connection, Request request) {
  Caller caller;
  std::optional<Problem> problem = check_host(request, door_.proxy());
  problem = problem ? problem : check_origin(request, door_.proxy());
  if (!problem) {
    auto known = co_await api_.caller_of(request, client_of(request, connection.peer, door_.proxy()));
    if (known) {
      caller = std::move(*known);
    }
    problem = known ? api_.router().check(viewers, caller) : std::optional(known.error());
  }
  if (!problem && request["Sec-WebSocket-Version"] != "13") {
    problem = Problem{.status = Status::upgrade_required,
                      .code = "UPGRADE_REQUIRED",
                      .detail = "The stream speaks another version of WebSocket.",
                      .expected = "Sec-WebSocket-Version: 13",
                      .next_step = "Open it with a client of RFC 6455.",
                      .headers = {{"Sec-WebSocket-Version", "13"}}};
  }
  if (!problem && api_.stream().full(caller.session)) {
    problem = Problem{.status = Status::service_unavailable,
                      .code = "OVERLOADED",
                      .detail = "Too many clients watch the stream.",
                      .expected = "at most " + std::to_string(Broadcaster::capacity) + ", of one session " +
                                  std::to_string(Broadcaster::session_capacity),
                      .next_step = "Close another console."};
  }
  log_transaction(request, caller,
                  problem ? http_status(problem->status) : http::status::switching_protocols);
  if (problem) {
    co_await answer(connection, problem_response(*problem), false, false);
    co_return;
  }
  co_await api_.stream().serve(std::move(connection.stream), std::move(request), std::move(caller));
}

asio::awaitable<AnyResponse> Server::respond(const Request& request, Connection& connection) {
  std::optional<Problem> problem = check_host(request, door_.proxy());
  if (!problem && !is_safe(request.method())) {
    problem = check_origin(request, door_.proxy());
    if (!problem && connection.late && !only_ends(request)) {
      problem = too_late();
    }
  }
  if (problem) {
    co_return problem_response(*problem);
  }
  const std::string path = path_of(request);
  if (path.empty()) {
    co_return problem_response(malformed_path());
  }
  if (connection.place == Place::reserve && !is_always_answered(path)) {
    co_return problem_response(all_at_work(ceiling_));
  }
  if (path == "/api" || path.starts_with("/api/")) {
    co_return co_await respond_api(request, connection);
  }
  co_return co_await files_.serve(request);
}

asio::awaitable<Response> Server::respond_api(const Request& request, Connection& connection) {
  auto caller = co_await api_.caller_of(request, client_of(request, connection.peer, door_.proxy()));
  if (!caller) {
    co_return problem_response(caller.error());
  }
  caller->asked = connection.came;
  connection.known = connection.known || caller->session != 0;
  const Reply reply = co_await api_.route(request, *caller);
  log_transaction(request, *caller, http_status(reply ? reply->status : reply.error().status));
  co_return reply ? success_response(*reply) : problem_response(reply.error());
}

asio::awaitable<bool> Server::answer(Connection& connection, Response response, bool head_only,
                                     bool keep_alive) {
  prepare(response, keep_alive);
  connection.stream.expires_after(answer_timeout);
  beast::error_code error;
  if (head_only) {
    http::response<http::empty_body> head{std::move(response.base())};
    http::response_serializer<http::empty_body> serializer(head);
    error = std::get<0>(co_await http::async_write_header(connection.stream, serializer, as_result));
  } else {
    error = std::get<0>(co_await http::async_write(connection.stream, response, as_result));
  }
  co_return !error && keep_alive;
}

/** Ends with a client that does not take a piece within `answer_timeout`. */
asio::awaitable<bool> Server::answer(Connection& connection, FileResponse response, bool head_only,
                                     bool keep_alive) {
  secure(response.head);
  response.head.keep_alive(keep_alive);
  if (response.body) {
    response.head.content_length(response.body->size());
  }
  http::response<http::empty_body> head{std::move(response.head.base())};
  http::response_serializer<http::empty_body> serializer(head);
  beast::error_code error;
  // Else the kernel would keep each piece until the client has confirmed the one before.
  connection.stream.socket().set_option(tcp::no_delay(true), error);
  const std::uint64_t size = response.body && !head_only ? response.body->size() : 0;
  connection.stream.expires_after(answer_timeout);
  std::tie(error, std::ignore) = co_await http::async_write_header(connection.stream, serializer, as_result);
  for (std::uint64_t sent = 0; !error && sent < size;) {
    const std::optional<std::string_view> piece = co_await response.body->piece(sent);
    if (!piece) {
      co_return false;
    }
    connection.stream.expires_after(answer_timeout);
    std::tie(error, std::ignore) =
        co_await asio::async_write(connection.stream, asio::buffer(*piece), as_result);
    sent += piece->size();
  }
  co_return !error && keep_alive;
}

asio::awaitable<bool> Server::answer(Connection& connection, AnyResponse response, bool head_only,
                                     bool keep_alive) {
  return std::visit([&](auto& one) { return answer(connection, std::move(one), head_only, keep_alive); },
                    response);
}

/** Answers what could not be read, and ends the connection. What is still on its way is read and dropped,
 * else the peer may lose the answer. */
asio::awaitable<void> Server::refuse(Connection& connection, Problem problem) {
  co_await answer(connection, problem_response(problem), false, false);
  beast::error_code ended;
  connection.stream.socket().shutdown(tcp::socket::shutdown_send, ended);
  connection.stream.expires_after(drain_timeout);
  std::array<char, 16384> dropped{};
  for (std::size_t left = drain_bytes; left > dropped.size() && !ended;) {
    const auto [read_error, bytes] =
        co_await connection.stream.async_read_some(asio::buffer(dropped), as_result);
    ended = read_error;
    left -= bytes;
  }
}

}  // namespace interlock::web
