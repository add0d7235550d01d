/**
 * @file
 * The stream's clients: each gets the newest state and every text message.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "http/message.hpp"
#include "http/stream_message.hpp"

namespace interlock::web {

class StreamHub {
 public:
  /** Clients at the same time. */
  static constexpr std::size_t capacity = 32;
  /** Text messages that wait for one client; one more, and the client is dropped. */
  static constexpr std::size_t backlog = 1024;

  /** Accepts the WebSocket and serves it until either side ends it. */
  boost::asio::awaitable<void> serve(boost::beast::tcp_stream stream, Request request);

  /** To every client; a state that was not sent yet is replaced by the newer one. */
  void send_state(const StreamMessage& state);

  /** To every client, in order; a client that cannot keep up is dropped, never a message. */
  void send_text(const nlohmann::json& message);

  [[nodiscard]] bool full() const { return clients_.size() >= capacity; }
  [[nodiscard]] bool empty() const { return clients_.empty(); }

 private:
  using Socket = boost::beast::websocket::stream<boost::beast::tcp_stream>;

  struct Client {
    explicit Client(boost::beast::tcp_stream stream)
        : socket(std::move(stream)),
          news(socket.get_executor(), boost::asio::steady_timer::time_point::max()) {}

    void close();

    Socket socket;
    boost::asio::steady_timer news; /**< cancelled when there is something to send, or to end */
    std::deque<std::shared_ptr<const std::string>> texts;
    std::optional<StreamMessage> state;
    bool open = true;
  };

  static boost::asio::awaitable<void> write(std::shared_ptr<Client> client);

  std::list<std::shared_ptr<Client>> clients_;
};

}  // namespace interlock::web
