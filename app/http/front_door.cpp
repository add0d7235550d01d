#include "http/front_door.hpp"

#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <sstream>
#include <string_view>

#include "http/same_origin.hpp"
#include "service/status_json.hpp"
#include "system/as_result.hpp"
#include "system/launch.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using std::chrono::steady_clock;

constexpr std::string_view stop_begin = "POST /api/stop";
constexpr std::chrono::milliseconds door_beat{33};
constexpr std::chrono::seconds longest_silence{30};
constexpr std::chrono::seconds stop_timeout{2};
constexpr std::chrono::milliseconds answer_timeout{300};
/** Of this thread, after which it does not know when that came which it finds; and for how long after. */
constexpr std::chrono::milliseconds longest_pause{250};
constexpr std::chrono::milliseconds pause_timeout{100};
/** Of whoever has just come, to begin a request; a crowd of sixty that takes turns delays a STOP by less than
 * 50 ms. */
constexpr std::chrono::milliseconds time_to_begin{5};

std::string name_of(const tcp::socket& socket) {
  beast::error_code error;
  const auto from = socket.remote_endpoint(error);
  return error ? std::string() : (std::ostringstream() << from).str();
}

/** How a request begins that was not read yet; empty when the peer has ended the connection. */
std::string_view peek(tcp::socket& socket, std::array<char, stop_begin.size() + 1>& begin) {
  const ssize_t length = ::recv(socket.native_handle(), begin.data(), begin.size(), MSG_PEEK | MSG_DONTWAIT);
  return {begin.data(), length > 0 ? static_cast<std::size_t>(length) : 0};
}

/** One that comes in pieces that small is answered behind the door. */
bool is_stop(std::string_view begin) {
  return begin.size() > stop_begin.size() && begin.starts_with(stop_begin) &&
         (begin.back() == ' ' || begin.back() == '?');
}

}  // namespace

std::optional<tcp::socket> socket_of(FileDescriptor descriptor, tcp protocol,
                                     const asio::any_io_executor& executor) {
  tcp::socket socket(executor);
  beast::error_code error;
  socket.assign(protocol, descriptor.get(), error);
  if (error) {
    return std::nullopt;
  }
  (void)descriptor.release();
  return socket;
}

FrontDoor::FrontDoor(const asio::any_io_executor& executor, RealtimeChannel& channel, std::size_t capacity,
                     std::function<void(Guest)> let_in, std::function<void(StopMade)> record)
    : executor_(executor),
      channel_(channel),
      capacity_(capacity),
      let_in_(std::move(let_in)),
      record_(std::move(record)),
      acceptor_(executor),
      wake_(executor, ::dup(channel.door_wake.descriptor())) {}

tl::expected<void, std::string> FrontDoor::listen(const Listen& where) {
  if (const auto problem = problem_of(where.proxy)) {
    return tl::make_unexpected(*problem);
  }
  proxy_ = where.proxy;
  beast::error_code error;
  const auto address = asio::ip::make_address(where.address, error);
  if (error) {
    return tl::make_unexpected("--listen " + where.address + " is no address; expected 127.0.0.1 or ::1");
  }
  if (!address.is_loopback()) {
    return tl::make_unexpected(
        "--listen " + where.address +
        " would let other machines in, and there is no encryption; expected "
        "127.0.0.1 or ::1. Use an SSH tunnel or a proxy with TLS to reach it from elsewhere");
  }
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

asio::awaitable<void> FrontDoor::accept() {
  for (;;) {
    auto [error, socket] = co_await acceptor_.async_accept(as_result);
    if (error == asio::error::operation_aborted) {
      co_return;
    }
    if (error) {
      co_await survive(error);
    } else {
      std::string peer = name_of(socket);
      wait_for_request({std::move(socket), acceptor_.local_endpoint().protocol(), std::move(peer), false,
                        steady_clock::now()});
    }
  }
}

/** Out of descriptors, most likely: whoever waits for nothing gives one back, be it for a STOP. Without such
 * a one, trying again at once would only burn the processor. */
asio::awaitable<void> FrontDoor::survive(const beast::error_code& error) {
  spdlog::error("cannot accept a connection: {}", error.message());
  const bool are_young = !waiting_.empty();
  if (!make_room(time_to_begin)) {
    asio::steady_timer pause(executor_, are_young ? time_to_begin : std::chrono::milliseconds(100));
    co_await pause.async_wait(as_result);
  }
}

/** Closes the connection that has waited longest, of strangers first, and none on which a request has begun.
 */
bool FrontDoor::make_room(std::chrono::milliseconds waited) {
  const auto latest = steady_clock::now() - waited;
  const auto is_idle = [&](auto& each) {
    std::array<char, stop_begin.size() + 1> bytes{};
    return each.second.since <= latest && peek(each.second.socket, bytes).empty();
  };
  auto found =
      std::ranges::find_if(waiting_, [&](auto& each) { return !each.second.known && is_idle(each); });
  if (found == waiting_.end()) {
    found = std::ranges::find_if(waiting_, is_idle);
  }
  if (found == waiting_.end()) {
    return false;
  }
  waiting_.erase(found);
  return true;
}

void FrontDoor::wait_for_request(Waiting waiting) {
  if (waiting_.size() == capacity_ && !make_room(std::chrono::milliseconds(0))) {
    waiting_.erase(waiting_.begin());
  }
  const std::uint64_t number = ++last_waiting_;
  Waiting& placed = waiting_.emplace(number, std::move(waiting)).first->second;
  placed.socket.async_wait(tcp::socket::wait_read, [this, number](const beast::error_code&) {
    // One that was closed to make room for another is not found any more.
    const auto found = waiting_.find(number);
    if (found != waiting_.end()) {
      look_at(std::move(waiting_.extract(found).mapped()));
    }
  });
}

void FrontDoor::look_at(Waiting waiting) {
  std::array<char, stop_begin.size() + 1> bytes{};
  const std::string_view begin = peek(waiting.socket, bytes);
  if (begin.empty()) {
    return;
  }
  if (is_stop(begin)) {
    launch(executor_, serve_stop(std::move(waiting)));
    return;
  }
  beast::error_code error;
  const int socket = waiting.socket.release(error);
  if (!error) {
    let_in_({FileDescriptor(socket), waiting.protocol, std::move(waiting.peer), waiting.known, came()});
  }
}

/** When that came which is seen now. A thread that stood still cannot tell, so it takes the earliest time. */
steady_clock::time_point FrontDoor::came() const {
  const auto now = steady_clock::now();
  if (now - beat_at_ > longest_pause) {
    return beat_at_;
  }
  return now < pause_felt_until_ ? pause_from_ : now;
}

void FrontDoor::come_back(Guest guest) {
  asio::post(executor_, [this, guest = std::move(guest)]() mutable {
    auto socket = socket_of(std::move(guest.socket), guest.protocol, executor_);
    if (socket) {
      wait_for_request(
          {std::move(*socket), guest.protocol, std::move(guest.peer), guest.known, steady_clock::now()});
    }
  });
}

asio::awaitable<void> FrontDoor::serve_stop(Waiting waiting) {
  beast::tcp_stream stream(std::move(waiting.socket));
  stream.expires_after(stop_timeout);
  beast::flat_buffer buffer;
  http::request_parser<http::string_body> parser;
  parser.header_limit(longest_header);
  parser.body_limit(longest_body);
  auto [error, header_bytes] = co_await http::async_read_header(stream, buffer, parser, as_result);
  const std::optional<Problem> problem = unreadable(error);
  if (error && !problem) {
    co_return;
  }
  // No co_await within ?:, which GCC 12 compiles wrongly.
  Response response;
  if (problem) {
    response = problem_response(*problem);
  } else {
    response = co_await stop(parser.get(), waiting.peer);
  }
  // A body that is not there yet is not waited for: the answer is out before.
  const bool whole =
      !problem && !check_framing(parser.get()) &&
      (parser.is_done() || parser.content_length_remaining().value_or(SIZE_MAX) <= buffer.size());
  if (whole && !parser.is_done()) {
    std::tie(error, std::ignore) = co_await http::async_read(stream, buffer, parser, as_result);
  }
  const bool stays = whole && !error && parser.get().keep_alive() && buffer.size() == 0;
  prepare(response, stays);
  stream.expires_after(stop_timeout);
  std::tie(error, std::ignore) = co_await http::async_write(stream, response, as_result);
  if (!error && stays) {
    waiting.socket = stream.release_socket();
    waiting.since = steady_clock::now();
    wait_for_request(std::move(waiting));
    co_return;
  }
  stream.socket().shutdown(tcp::socket::shutdown_send, error);
  // What still comes is read and dropped, else the peer may lose the answer.
  std::array<char, 4096> dropped{};
  for (std::size_t left = longest_body; left > dropped.size() && !error; left -= dropped.size()) {
    std::tie(error, std::ignore) = co_await stream.async_read_some(asio::buffer(dropped), as_result);
  }
}

/** On its way to the kernel before anything is written or read, be it the rest of the request. */
asio::awaitable<Response> FrontDoor::stop(Request header, std::string peer) {
  std::optional<Problem> problem = check_host(header, proxy_);
  problem = problem ? problem : check_origin(header, proxy_);
  if (problem) {
    co_return problem_response(*problem);
  }
  peer = client_of(header, peer, proxy_);
  const std::uint32_t number = channel_.stop();
  if (unrecorded_.load(std::memory_order_relaxed) < most_unrecorded) {
    unrecorded_.fetch_add(1, std::memory_order_relaxed);
    record_({std::move(header), std::move(peer), std::exchange(passed_over_, 0)});
  } else {
    ++passed_over_;
  }
  Waiter waiter{std::nullopt, asio::steady_timer(executor_, answer_timeout)};
  const auto place = waiters_.emplace(number, &waiter);
  co_await waiter.timer.async_wait(as_result);
  waiters_.erase(place);
  co_return success_response({Status::ok, stop_json(waiter.answer)});
}

asio::awaitable<void> FrontDoor::listen_to_control() {
  for (;;) {
    const auto [error] = co_await wake_.async_wait(asio::posix::stream_descriptor::wait_read, as_result);
    if (error) {
      co_return;
    }
    channel_.door_wake.clear();
    const StopAnswer& answer = channel_.stopped.newest();
    for (auto each = waiters_.begin(); each != waiters_.end() && each->first <= answer.stops; ++each) {
      each->second->answer = answer;
      each->second->timer.cancel();
    }
  }
}

asio::awaitable<void> FrontDoor::heartbeat() {
  asio::steady_timer timer(executor_);
  for (;;) {
    channel_.door_kept.fetch_add(1, std::memory_order_relaxed);
    const auto now = steady_clock::now();
    if (now - beat_at_ > longest_pause) {
      pause_from_ = beat_at_;
      pause_felt_until_ = now + pause_timeout;
    }
    beat_at_ = now;
    const auto oldest = now - longest_silence;
    while (!waiting_.empty() && waiting_.begin()->second.since < oldest) {
      waiting_.erase(waiting_.begin());
    }
    timer.expires_after(door_beat);
    const auto [error] = co_await timer.async_wait(as_result);
    if (error) {
      co_return;
    }
  }
}

}  // namespace interlock::web
