#include "igtl/igtl_server.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <sstream>

#include "igtl/codec.hpp"
#include "igtl/stop_scout.hpp"
#include "system/launch.hpp"

namespace interlock::igtl {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr auto as_result = asio::as_tuple(asio::use_awaitable);
constexpr std::size_t chunk_bytes = 16u * 1024u;
constexpr std::chrono::milliseconds observer_timeout{3000};
constexpr std::chrono::milliseconds accept_pause{100};

/** Seconds since 1970 and their fraction. */
std::uint64_t timestamp_now() {
  using namespace std::chrono;
  const auto now = system_clock::now().time_since_epoch();
  const auto whole = duration_cast<seconds>(now);
  const auto rest = static_cast<std::uint64_t>(duration_cast<nanoseconds>(now - whole).count());
  return (static_cast<std::uint64_t>(whole.count()) << 32u) | ((rest << 32u) / 1'000'000'000u);
}

void set_tcp(asio::ip::tcp::socket& socket, int option, int value) {
  // What cannot be set leaves the kernel's own timeout, which is longer; the connection works all the same.
  (void)setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof value);
}

std::optional<tcp_info> info_of(const asio::ip::tcp::socket& socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  // Reading an option does not change the socket, but Asio gives the handle of a changeable one only.
  const int handle = const_cast<asio::ip::tcp::socket&>(socket).native_handle();
  const bool is_known = getsockopt(handle, IPPROTO_TCP, TCP_INFO, &info, &size) == 0;
  return is_known ? std::optional(info) : std::nullopt;
}

std::optional<std::chrono::microseconds> round_trip_of(const asio::ip::tcp::socket& socket) {
  const auto info = info_of(socket);
  return info && info->tcpi_rtt != 0 ? std::optional(std::chrono::microseconds(info->tcpi_rtt))
                                     : std::nullopt;
}

}  // namespace

IgtlServer::Session::Session(Tcp::socket connected, PeerId id, Clock::time_point now)
    : socket(std::move(connected)),
      news(socket.get_executor(), Clock::time_point::max()),
      pause(socket.get_executor()),
      last_heard(now),
      regular_since(now),
      window_since(now) {
  error_code unknown;
  peer.id = id;
  peer.address = (std::ostringstream() << socket.remote_endpoint(unknown)).str();
  peer.port = socket.local_endpoint(unknown).port();
  peer.since = std::chrono::system_clock::now();
  socket.set_option(Tcp::no_delay(true), unknown);
  socket.set_option(asio::socket_base::keep_alive(true), unknown);
  set_tcp(socket, TCP_KEEPIDLE, 1);
  set_tcp(socket, TCP_KEEPINTVL, 1);
  set_tcp(socket, TCP_KEEPCNT, 3);
  set_timeout(*this, observer_timeout);
}

void IgtlServer::set_timeout(Session& session, std::chrono::milliseconds timeout) {
  set_tcp(session.socket, TCP_USER_TIMEOUT, static_cast<int>(timeout.count()));
}

tl::expected<void, std::string> IgtlServer::listen(const IgtlServerOptions& options) {
  const auto failed = [&](const std::string& problem, const std::string& next) {
    return tl::unexpected("OpenIGTLink cannot listen on " + options.address + ":" +
                          std::to_string(options.port) + ": " + problem + "; " + next);
  };
  error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) {
    return failed("this is no address", "expected one such as 127.0.0.1");
  }
  allow_.clear();
  for (const std::string& each : options.allow) {
    allow_.push_back(asio::ip::make_address(each, error));
    if (error) {
      return failed("\"" + each + "\" of the list of peers is no address", "expected one such as 10.0.0.7");
    }
  }
  if (!address.is_loopback() && allow_.empty()) {
    return failed("the protocol knows neither passwords nor encryption",
                  "list the addresses that may connect, or use 127.0.0.1");
  }
  controller_silence_ = options.controller_silence;
  const Tcp::endpoint endpoint(address, options.port);
  acceptor_.open(endpoint.protocol(), error);
  if (!error) {
    acceptor_.set_option(Tcp::acceptor::reuse_address(true), error);
  }
  if (!error) {
    acceptor_.bind(endpoint, error);
  }
  if (!error) {
    acceptor_.listen(asio::socket_base::max_listen_connections, error);
  }
  if (error) {
    error_code ignored;
    acceptor_.close(ignored);
    return failed(error.message(), "stop what uses the port, or choose another one");
  }
  port_ = acceptor_.local_endpoint().port();
  return {};
}

bool IgtlServer::is_welcome(const asio::ip::address& address) const {
  return allow_.empty() ? address.is_loopback() : std::ranges::find(allow_, address) != allow_.end();
}

asio::awaitable<void> IgtlServer::accept() {
  for (;;) {
    auto [error, socket] = co_await acceptor_.async_accept(as_result);
    if (error == asio::error::operation_aborted) {
      co_return;
    }
    if (error) {
      spdlog::error("OpenIGTLink cannot accept a connection: {}", error.message());
      asio::steady_timer pause(acceptor_.get_executor(), accept_pause);
      co_await pause.async_wait(as_result);
    } else {
      admit(std::move(socket));
    }
  }
}

void IgtlServer::admit(Tcp::socket socket) {
  error_code gone;
  const auto from = socket.remote_endpoint(gone);
  if (gone) {
    return;
  }
  if (!is_welcome(from.address()) || sessions_.size() >= capacity) {
    spdlog::warn("OpenIGTLink peer {} was turned away: {}", (std::ostringstream() << from).str(),
                 is_welcome(from.address()) ? "too many are connected" : "it is not on the list of peers");
    return;
  }
  launch(acceptor_.get_executor(),
         serve(std::make_shared<Session>(std::move(socket), ++last_id_, read_clock())));
}

asio::awaitable<void> IgtlServer::keep_connected(Tcp::endpoint peer, std::chrono::milliseconds pause) {
  const auto executor = acceptor_.get_executor();
  asio::steady_timer timer(executor);
  for (;;) {
    Tcp::socket socket(executor);
    if (sessions_.size() < capacity) {
      const auto [failed] = co_await socket.async_connect(peer, as_result);
      // Others may have come meanwhile.
      if (!failed && sessions_.size() < capacity) {
        co_await serve(std::make_shared<Session>(std::move(socket), ++last_id_, read_clock()));
      }
    }
    timer.expires_after(pause);
    const auto [ended] = co_await timer.async_wait(as_result);
    if (ended) {
      co_return;
    }
  }
}

asio::awaitable<void> IgtlServer::serve(SessionPointer session) {
  const auto listed = sessions_.insert(sessions_.end(), session);
  spdlog::info("OpenIGTLink connection {} of {}", session->peer.id, session->peer.address);
  on_socket(session->socket.native_handle(), session);
  launch(session->socket.get_executor(), write(session));
  on_open(session->peer.id);
  co_await read(session);
  if (const Header* begun = session->reader.begun()) {
    refuse(*session, *begun, Fault::late);
  }
  close(*session, session->reason);
  sessions_.erase(listed);
  spdlog::info("OpenIGTLink connection {} ended: {}", session->peer.id, session->reason);
  on_close(session->peer, session->reason);
}

asio::awaitable<void> IgtlServer::read(SessionPointer session) {
  std::vector<std::uint8_t> chunk(chunk_bytes);
  while (session->open) {
    const auto [error, count] = co_await session->socket.async_read_some(asio::buffer(chunk), as_result);
    if (error) {
      if (session->open && error != asio::error::eof) {
        session->reason = error.message();
      }
      co_return;
    }
    Bytes input(chunk.data(), count);
    while (session->open && !input.empty()) {
      Arrival arrival = session->reader.take(input);
      if (auto* frame = std::get_if<Frame>(&arrival)) {
        take(*session, std::move(*frame));
      } else if (auto* refused = std::get_if<Refused>(&arrival)) {
        refuse(*session, refused->header, refused->fault);
      } else if (auto* broken = std::get_if<Broken>(&arrival)) {
        refuse(*session, broken->header, broken->fault);
        co_await part(session, std::string(fault_text(broken->fault)));
        co_return;
      }
      const bool completed = !std::holds_alternative<std::monostate>(arrival);
      if (completed) {
        session->message_since.reset();
        co_await slow_down(session, input);
      }
    }
    if (!session->reader.is_within_message()) {
      session->message_since.reset();
    } else if (!session->message_since) {
      session->message_since = read_clock();
    }
  }
}

/** Lets the last answer out. What still comes is read and dropped: TCP would else take the answer back. */
asio::awaitable<void> IgtlServer::part(SessionPointer session, std::string reason) {
  session->reason = std::move(reason);
  session->message_since.reset();
  session->parting_since = read_clock();
  session->news.cancel();
  std::vector<std::uint8_t> dropped(chunk_bytes);
  while (session->open) {
    const auto [error, count] = co_await session->socket.async_read_some(asio::buffer(dropped), as_result);
    if (error) {
      co_return;
    }
  }
}

/** Who sends too much is read later; TCP tells it. A STOP in `unread` does not wait for that. */
asio::awaitable<void> IgtlServer::slow_down(SessionPointer session, Bytes unread) {
  const auto time = read_clock();
  if (time - session->window_since >= rate_window) {
    session->window_since = time;
    session->in_window = 0;
  }
  if (++session->in_window > most_messages) {
    if (stops_in(unread) != 0) {
      on_stop_ahead();
    }
    session->pause.expires_after(session->window_since + rate_window - time);
    co_await session->pause.async_wait(as_result);
  }
}

void IgtlServer::take(Session& session, Frame frame) {
  const Header header = frame.header;
  session.peer.version = std::max(session.peer.version, header.version);
  note_sign_of_life(session);
  const auto message = decode(std::move(frame));
  if (!message) {
    refuse(session, header, message.error());
    return;
  }
  ++session.peer.received;
  if (session.peer.heard.size() < most_names || session.peer.heard.contains(message->device)) {
    Heard& heard = session.peer.heard[message->device];
    heard.type = header.type;
    if (heard.count != 0) {
      heard.interval = session.last_heard - heard.last;
    }
    heard.last = session.last_heard;
    ++heard.count;
  }
  on_message(session.peer.id, *message);
}

void IgtlServer::note_sign_of_life(Session& session) {
  const auto time = read_clock();
  if (time - session.last_heard > heartbeat_gap) {
    session.regular_since = time;
  }
  session.last_heard = time;
}

void IgtlServer::refuse(Session& session, const Header& header, const FaultAt& fault) {
  ++session.peer.refused;
  session.peer.version = std::max(session.peer.version, header.version);
  note_sign_of_life(session);
  on_refused(session.peer.id, header, fault);
}

asio::awaitable<void> IgtlServer::write(SessionPointer session) {
  while (session->open) {
    ByteVector bytes;
    if (!session->replies.empty()) {
      bytes = std::move(session->replies.front());
      session->replies.pop_front();
    } else if (session->parting_since) {
      error_code gone;
      session->socket.shutdown(Tcp::socket::shutdown_send, gone);
      co_return;
    } else if (!session->newest.empty()) {
      auto next = session->newest.upper_bound(session->shown_last);
      next = next == session->newest.end() ? session->newest.begin() : next;
      session->shown_last = next->first;
      bytes = std::move(next->second);
      session->newest.erase(next);
    } else {
      co_await session->news.async_wait(as_result);
      continue;
    }
    session->write_since = read_clock();
    const auto [error, count] = co_await asio::async_write(session->socket, asio::buffer(bytes), as_result);
    session->write_since.reset();
    if (error) {
      close(*session, error.message());
    } else {
      ++session->peer.sent;
    }
  }
}

asio::awaitable<void> IgtlServer::heartbeat() {
  asio::steady_timer timer(acceptor_.get_executor());
  for (;;) {
    timer.expires_after(beat_period);
    const auto [error] = co_await timer.async_wait(as_result);
    if (error) {
      co_return;
    }
    for (const SessionPointer& session : sessions_) {
      check_timeouts(*session, read_clock());
    }
  }
}

void IgtlServer::check_timeouts(Session& session, Clock::time_point now) const {
  const bool controls = session.peer.role == Role::controller;
  const auto taking = controls ? controller_timeout : write_timeout;
  if (session.parting_since && now - *session.parting_since > parting_timeout) {
    close(session, session.reason);
  } else if (session.message_since && now - *session.message_since > message_timeout) {
    close(session, std::string(fault_text(Fault::late)));
  } else if (session.write_since && now - *session.write_since > taking) {
    close(session, "the peer does not take what is sent to it");
  } else if (controls) {
    check_controller(session, now);
  }
}

/** Whether its machine is there, and whether the program on it goes on. */
void IgtlServer::check_controller(Session& session, Clock::time_point now) const {
  const bool moves = is_in_motion();
  const bool is_configured = controller_silence_.count() != 0;
  const auto limit = is_configured ? controller_silence_ : heartbeat_silence;
  error_code ignored;
  // What has come and was not read yet is no silence.
  const bool is_silent = now - session.last_heard > limit && session.socket.available(ignored) == 0;
  const bool is_regular = session.last_heard - session.regular_since >= heartbeat_proof;
  if (is_silent && (is_configured || (moves && is_regular))) {
    close(session, "the controller was silent for " + std::to_string(limit.count()) + " ms");
  } else if (moves && unacknowledged(session, now) > acknowledgement_timeout) {
    close(session, "the controller's machine acknowledges nothing");
  } else if (is_silent) {
    session.regular_since = now;
  }
}

/** How long nothing was acknowledged of what was sent. */
IgtlServer::Clock::duration IgtlServer::unacknowledged(Session& session, Clock::time_point now) {
  const auto info = info_of(session.socket);
  if (!info || info->tcpi_unacked == 0) {
    session.unacknowledged_since.reset();
    return {};
  }
  session.unacknowledged_since = session.unacknowledged_since.value_or(now);
  return std::min<Clock::duration>(now - *session.unacknowledged_since,
                                   std::chrono::milliseconds(info->tcpi_last_ack_recv));
}

void IgtlServer::close(Session& session, const std::string& reason) {
  if (!session.open) {
    return;
  }
  session.open = false;
  session.reason = reason;
  error_code ignored;
  session.socket.shutdown(Tcp::socket::shutdown_both, ignored);  // whoever else holds the socket
  session.socket.close(ignored);
  session.news.cancel();
  session.pause.cancel();
}

IgtlServer::SessionPointer IgtlServer::session_of(PeerId id) const {
  const auto found =
      std::ranges::find(sessions_, id, [](const SessionPointer& each) { return each->peer.id; });
  return found == sessions_.end() || !(*found)->open ? nullptr : *found;
}

void IgtlServer::reply(PeerId to, const std::string& device, const Body& body) {
  const SessionPointer session = session_of(to);
  if (session == nullptr) {
    return;
  }
  if (session->replies.size() == backlog) {
    close(*session, "the peer is " + std::to_string(backlog) + " replies behind");
    return;
  }
  session->replies.push_back(
      write_frame(session->peer.version, type_of(body), device, timestamp_now(), encode(body)));
  session->news.cancel();
}

void IgtlServer::show(PeerId to, const std::string& device, const Body& body) {
  const SessionPointer session = session_of(to);
  if (session == nullptr) {
    return;
  }
  const std::string type = type_of(body);
  const auto [place, is_new] = session->newest.insert_or_assign(
      {type, device}, write_frame(session->peer.version, type, device, timestamp_now(), encode(body)));
  session->peer.replaced += is_new ? 0u : 1u;
  session->news.cancel();
}

void IgtlServer::count_refusal(PeerId id) {
  if (const SessionPointer session = session_of(id)) {
    ++session->peer.refused;
  }
}

bool IgtlServer::set_role(PeerId id, Role role) {
  const SessionPointer session = session_of(id);
  if (session == nullptr) {
    return false;
  }
  session->peer.role = role;
  session->last_heard = read_clock();
  session->regular_since = session->last_heard;
  set_timeout(*session, role == Role::controller ? controller_timeout : observer_timeout);
  return true;
}

bool IgtlServer::disconnect(PeerId id, const std::string& reason) {
  const SessionPointer session = session_of(id);
  if (session == nullptr) {
    return false;
  }
  close(*session, reason);
  return true;
}

Peer IgtlServer::seen(const Session& session) {
  Peer peer = session.peer;
  peer.round_trip = round_trip_of(session.socket);
  return peer;
}

std::optional<Peer> IgtlServer::find(PeerId id) const {
  const SessionPointer session = session_of(id);
  return session == nullptr ? std::nullopt : std::optional(seen(*session));
}

std::vector<Peer> IgtlServer::peers() const {
  std::vector<Peer> peers;
  for (const SessionPointer& session : sessions_) {
    if (session->open) {
      peers.push_back(seen(*session));
    }
  }
  return peers;
}

}  // namespace interlock::igtl
