/**
 * @file
 * The stream's clients: each gets the newest state and every text message.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "http/message.hpp"
#include "service/reply.hpp"
#include "service/status_json.hpp"
#include "system/utc_time.hpp"

namespace interlock::web {

class Broadcaster {
 public:
  /** Clients at the same time. */
  static constexpr std::size_t capacity = 32;
  /** Of those, clients of one session: a browser's windows. */
  static constexpr std::size_t session_capacity = 8;
  /** Text messages that wait for one client; one more, and the client is dropped. */
  static constexpr std::size_t backlog = 1024;

  /** A client, as others see it. */
  struct Subscriber {
    std::uint32_t id = 0; /**< never given twice */
    Caller caller;
    UtcTime since;
    std::uint16_t port = 0; /**< of this app, that it came to */
  };

  /** Told of each client that has come (true) or gone. */
  std::function<void(const Subscriber&, bool)> on_change = [](const Subscriber&, bool) {};

  /** Told of each client that says `stop`. */
  std::function<void(const Caller&)> on_stop = [](const Caller&) {};

  /** Accepts the WebSocket and serves it until either side ends it. */
  boost::asio::awaitable<void> serve(boost::beast::tcp_stream stream, Request request, Caller caller);

  /** To every client; a state that was not sent yet is replaced by the newer one. */
  void send_state(const StreamMessage& state);

  /** To every client but the one of number `except`, in order; a client that cannot keep up is dropped, never
   * a message. */
  void send_text(const nlohmann::json& message, std::uint32_t except = 0);

  /** As `send_text`, with a message of its own for each client. */
  void send_text(const std::function<nlohmann::json(const Caller&)>& message_for);

  /** Tells the clients of that session that it ended, and closes them with code 4401. */
  void end_session(std::uint32_t session);

  /** Closes one client; false when there is none of that number. */
  bool disconnect(std::uint32_t id);

  /** Oldest first. */
  [[nodiscard]] std::vector<Subscriber> subscribers() const;

  /** Whether there is no room for another client, or for another one of that session. */
  [[nodiscard]] bool full(std::uint32_t session) const;
  [[nodiscard]] bool empty() const { return clients_.empty(); }

 private:
  struct Client; /**< in the source: its WebSocket is a large header that nobody else needs */

  static boost::asio::awaitable<void> write(std::shared_ptr<Client> client);

  std::list<std::shared_ptr<Client>> clients_; /**< oldest first */
  std::uint32_t last_id_ = 0;
};

}  // namespace interlock::web
