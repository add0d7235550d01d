#include "http/server.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <exception>
#include <optional>
#include <sstream>

#include "http/same_origin.hpp"
#include "network/as_result.hpp"

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

constexpr const char* content_security_policy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; img-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

void add_security_headers(Response& response) {
  response.set("Content-Security-Policy", content_security_policy);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
}

Problem unreadable_request(const beast::error_code& error) {
  if (error == http::error::body_limit) {
    return {.status = Status::payload_too_large,
            .code = "TOO_LARGE",
            .detail = "The body is too large.",
            .expected = "at most " + std::to_string(Server::longest_body) +
                        " bytes; a trajectory of the holder of " + "motion authority at most " +
                        std::to_string(Server::longest_trajectory)};
  }
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return {.status = Status::request_header_fields_too_large,
            .code = "TOO_LARGE",
            .detail = "The header is too large.",
            .expected = "at most " + std::to_string(Server::longest_header) + " bytes"};
  }
  return {.status = Status::bad_request,
          .code = "MALFORMED",
          .detail = "This is no HTTP request: " + error.message() + ".",
          .expected = "HTTP/1.1"};
}

void log_transaction(const Request& request, const Caller& caller, Status status) {
  spdlog::debug("{} {} {} {} -> {}", caller.peer, caller.user.empty() ? "nobody" : caller.user,
                std::string(request.method_string()), path_of(request), static_cast<unsigned>(status));
}

Problem all_at_work(std::size_t ceiling) {
  return {.status = Status::service_unavailable,
          .code = "OVERLOADED",
          .detail = "All " + std::to_string(ceiling) + " connections are at work.",
          .next_step = "Try again in a moment; STOP and the status are answered still.",
          .headers = {{"Retry-After", "1"}}};
}

/** So many connections that the app itself and the reserve have descriptors left. */
std::size_t ceiling_of_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) {
    return Server::capacity;
  }
  constexpr std::size_t kept = Server::own_descriptors + Server::reserve;
  const std::size_t granted = limit.rlim_cur;
  return granted > kept ? std::min(Server::capacity, granted - kept) : 1;
}

bool is_protocol_error(const beast::error_code& error) {
  static const beast::error_code of_the_protocol = http::error::bad_method;
  return error.category() == of_the_protocol.category() && error != http::error::end_of_stream &&
         error != http::error::partial_message;
}

}  // namespace

Server::Connection::Connection(beast::tcp_stream connected, Place granted)
    : stream(std::move(connected)), place(granted) {
  beast::error_code error;
  const auto from = stream.socket().remote_endpoint(error);
  if (!error) {
    peer = (std::ostringstream() << from).str();
  }
}

tl::expected<void, std::string> Server::listen(const Listen& where) {
  beast::error_code error;
  const auto address = asio::ip::make_address(where.address, error);
  if (error) {
    return tl::make_unexpected("--listen " + where.address + " is no address; expected 127.0.0.1 or ::1");
  }
  if (!address.is_loopback()) {
    return tl::make_unexpected("--listen " + where.address +
                               " would let other machines in, and there is no encryption; expected "
                               "127.0.0.1 or ::1. Use an SSH tunnel to reach it from elsewhere");
  }
  ceiling_ = ceiling_of_process();
  acceptor_.open(address.is_v6() ? tcp::v6() : tcp::v4(), error);
  if (!error) {
    acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  }
  if (!error) {
    acceptor_.bind(tcp::endpoint(address, where.port), error);
  }
  if (!error) {
    acceptor_.listen(asio::socket_base::max_listen_connections, error);
  }
  if (error) {
    return tl::make_unexpected("cannot listen on " + where.address + ":" + std::to_string(where.port) + ": " +
                               error.message() +
                               "; stop what uses the port, or choose another one with --port");
  }
  return {};
}

asio::awaitable<void> Server::accept() {
  for (;;) {
    auto [error, socket] = co_await acceptor_.async_accept(as_result);
    if (error == asio::error::operation_aborted) {
      co_return;
    }
    if (error) {
      co_await survive(error);
    } else if (const auto place = place_for_another()) {
      admit(std::move(socket), *place);
    }
  }
}

/** Out of descriptors, most likely: whoever waits for nothing gives one back, be it for a STOP. Without such
 * a one, trying again at once would only burn the processor. */
asio::awaitable<void> Server::survive(const beast::error_code& error) {
  spdlog::error("cannot accept a connection: {}", error.message());
  if (close_oldest_idle(Place::common) || close_oldest_idle(Place::reserve)) {
    co_return;
  }
  asio::steady_timer pause(acceptor_.get_executor(), std::chrono::milliseconds(100));
  co_await pause.async_wait(as_result);
}

void Server::admit(tcp::socket socket, Place place) {
  auto connection = std::make_shared<Connection>(beast::tcp_stream(std::move(socket)), place);
  const auto listed = connections_.insert(connections_.end(), connection);
  asio::co_spawn(acceptor_.get_executor(), serve(connection),
                 [this, listed](const std::exception_ptr& thrown) {
                   connections_.erase(listed);
                   if (thrown) {
                     try {
                       std::rethrow_exception(thrown);
                     } catch (const std::exception& exception) {
                       spdlog::critical("a connection ended by an exception: {}", exception.what());
                     }
                   }
                 });
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
  for (bool keep_alive = true; keep_alive;) {
    http::request_parser<http::string_body> parser;
    parser.body_limit(longest_trajectory);
    parser.header_limit(longest_header);
    connection->stream.expires_after(request_timeout);
    connection->waiting = true;
    auto [error, header_bytes] =
        co_await http::async_read_header(connection->stream, connection->buffer, parser, as_result);
    if (!error) {
      const std::uint64_t limit = co_await body_limit_of(parser.get(), connection->peer);
      parser.body_limit(limit);
      if (parser.content_length().value_or(0) > limit) {
        error = http::error::body_limit;
      } else {
        std::tie(error, std::ignore) =
            co_await http::async_read(connection->stream, connection->buffer, parser, as_result);
      }
    }
    connection->waiting = false;
    if (error) {
      co_await refuse(*connection, error);
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
  const auto caller = co_await api_.caller_of(header, peer);
  co_return caller && !api_.router().check(holder, *caller) ? longest_trajectory : longest_body;
}

asio::awaitable<void> Server::serve_stream(Connection& connection, Request request) {
  Caller caller;
  std::optional<Problem> problem = check_host(request);
  problem = problem ? problem : check_origin(request);
  if (!problem) {
    auto known = co_await api_.caller_of(request, connection.peer);
    if (known) {
      caller = std::move(*known);
    }
    problem = known ? api_.router().check(viewers, caller) : std::optional(known.error());
  }
  if (!problem && api_.stream().full(caller.session)) {
    problem = Problem{.status = Status::service_unavailable,
                      .code = "OVERLOADED",
                      .detail = "Too many clients watch the stream.",
                      .expected = "at most " + std::to_string(StreamHub::capacity) + ", of one session " +
                                  std::to_string(StreamHub::session_capacity),
                      .next_step = "Close another console."};
  }
  log_transaction(request, caller, problem ? problem->status : Status::switching_protocols);
  if (problem) {
    co_await answer(connection, problem_response(*problem), false, false);
    co_return;
  }
  co_await api_.stream().serve(std::move(connection.stream), std::move(request), std::move(caller));
}

asio::awaitable<AnyResponse> Server::respond(const Request& request, const Connection& connection) {
  std::optional<Problem> problem = check_host(request);
  if (!problem && !is_safe(request.method())) {
    problem = check_origin(request);
  }
  if (problem) {
    co_return problem_response(*problem);
  }
  const std::string path = path_of(request);
  if (connection.place == Place::reserve && !is_always_answered(path)) {
    co_return problem_response(all_at_work(ceiling_));
  }
  if (path == "/api" || path.starts_with("/api/")) {
    co_return co_await respond_api(request, connection.peer);
  }
  co_return co_await files_.serve(request);
}

asio::awaitable<Response> Server::respond_api(const Request& request, const std::string& peer) {
  std::string thrown;
  try {
    const auto caller = co_await api_.caller_of(request, peer);
    if (!caller) {
      co_return problem_response(caller.error());
    }
    const Reply reply = co_await api_.router().route(request, *caller);
    log_transaction(request, *caller, reply ? reply->status : reply.error().status);
    co_return reply ? success_response(*reply) : problem_response(reply.error());
  } catch (const std::exception& exception) {
    thrown = exception.what();
  }
  spdlog::critical("{} {} threw: {}", std::string(request.method_string()), path_of(request), thrown);
  co_return problem_response({.status = Status::internal_server_error,
                              .code = "INTERNAL",
                              .detail = "The app failed to answer.",
                              .next_step = "Report it with the log."});
}

asio::awaitable<bool> Server::answer(Connection& connection, Response response, bool head_only,
                                     bool keep_alive) {
  add_security_headers(response);
  response.version(11);
  response.keep_alive(keep_alive);
  response.prepare_payload();
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
  add_security_headers(response.head);
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

/** Answers what could not be read. What is still on its way is read and dropped, else the peer may lose the
 * answer. */
asio::awaitable<void> Server::refuse(Connection& connection, const beast::error_code& error) {
  if (!is_protocol_error(error)) {
    co_return;
  }
  co_await answer(connection, problem_response(unreadable_request(error)), false, false);
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
