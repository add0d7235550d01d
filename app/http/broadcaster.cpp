#include "http/broadcaster.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <optional>

#include "system/as_result.hpp"
#include "system/launch.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

constexpr std::size_t longest_client_message = 1024;
constexpr std::chrono::seconds closing_timeout{2};
constexpr auto session_ended_code = static_cast<websocket::close_code>(4401);

websocket::stream_base::timeout timeouts() {
  return {.handshake_timeout = std::chrono::seconds(5),
          .idle_timeout = std::chrono::seconds(10),
          .keep_alive_pings = true};
}

}  // namespace

struct Broadcaster::Client {
  Client(beast::tcp_stream stream, Subscriber watching)
      : socket(std::move(stream)),
        subscriber(std::move(watching)),
        news(socket.get_executor(), asio::steady_timer::time_point::max()),
        timeout(socket.get_executor()) {}

  void send(std::shared_ptr<const std::string> text);
  void close();
  static void close_after_texts(const std::shared_ptr<Client>& client, websocket::close_reason reason);

  websocket::stream<beast::tcp_stream, false> socket; /**< without compression: no browser is far away */
  Subscriber subscriber;
  asio::steady_timer news;    /**< cancelled when there is something to send, or to end */
  asio::steady_timer timeout; /**< with a client that is to end */
  std::deque<std::shared_ptr<const std::string>> texts;
  std::optional<StreamMessage> state;
  std::optional<websocket::close_reason> closing;
  bool open = true;
};

void Broadcaster::Client::close() {
  open = false;
  news.cancel();
  timeout.cancel();
  beast::get_lowest_layer(socket).close();
}

/** Closes it once it has got what waits for it, or soon in any case: a client that takes nothing must not
 * outlive its session. */
void Broadcaster::Client::close_after_texts(const std::shared_ptr<Client>& client,
                                            websocket::close_reason reason) {
  client->closing = std::move(reason);
  client->news.cancel();
  client->timeout.expires_after(closing_timeout);
  client->timeout.async_wait([client](const beast::error_code& cancelled) {
    if (!cancelled && client->open) {
      spdlog::warn("a stream client did not take its end and was dropped");
      client->close();
    }
  });
}

void Broadcaster::Client::send(std::shared_ptr<const std::string> text) {
  if (texts.size() == backlog) {
    spdlog::warn("a stream client is {} messages behind and was dropped", backlog);
    close();
    return;
  }
  texts.push_back(std::move(text));
  news.cancel();
}

asio::awaitable<void> Broadcaster::serve(beast::tcp_stream stream, Request request, Caller caller) {
  beast::error_code unknown;
  const std::uint16_t port = stream.socket().local_endpoint(unknown).port();
  auto client = std::make_shared<Client>(
      std::move(stream), Subscriber{++last_id_, std::move(caller), std::chrono::system_clock::now(), port});
  beast::get_lowest_layer(client->socket).expires_never();
  client->socket.set_option(timeouts());
  client->socket.read_message_max(longest_client_message);
  // Known before it is accepted: a session that ends meanwhile takes it along.
  const auto place = clients_.insert(clients_.end(), client);
  const auto [accept_error] = co_await client->socket.async_accept(request, as_result);
  if (accept_error) {
    clients_.erase(place);
    client->close();
    co_return;
  }
  on_change(client->subscriber, true);
  launch(client->socket.get_executor(), write(client));
  while (client->open) {
    beast::flat_buffer buffer;
    const auto [read_error, bytes] = co_await client->socket.async_read(buffer, as_result);
    if (read_error || !client->open) {
      break;
    }
    if (beast::buffers_to_string(buffer.data()) != "stop") {
      // Who misunderstands the interface is told so instead of being ignored.
      co_await client->socket.async_close(
          {websocket::close_code::policy_error, "this stream takes no message but stop"}, as_result);
      break;
    }
    on_stop(client->subscriber.caller);
  }
  clients_.erase(place);
  client->close();
  on_change(client->subscriber, false);
}

asio::awaitable<void> Broadcaster::write(std::shared_ptr<Client> client) {
  while (client->open) {
    beast::error_code error;
    if (!client->texts.empty()) {
      const auto text = client->texts.front();
      client->texts.pop_front();
      client->socket.text(true);
      error = std::get<0>(co_await client->socket.async_write(asio::buffer(*text), as_result));
    } else if (client->closing) {
      co_await client->socket.async_close(*client->closing, as_result);
      client->close();
    } else if (client->state) {
      const StreamMessage state = *std::exchange(client->state, std::nullopt);
      client->socket.binary(true);
      error = std::get<0>(co_await client->socket.async_write(asio::buffer(state), as_result));
    } else {
      co_await client->news.async_wait(as_result);
    }
    if (error) {
      client->close();
    }
  }
}

void Broadcaster::send_state(const StreamMessage& state) {
  for (const auto& client : clients_) {
    client->state = state;
    client->news.cancel();
  }
}

void Broadcaster::send_text(const nlohmann::json& message, std::uint32_t except) {
  const auto text = std::make_shared<const std::string>(
      message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  for (const auto& client : clients_) {
    if (client->subscriber.id != except) {
      client->send(text);
    }
  }
}

void Broadcaster::send_text(const std::function<nlohmann::json(const Caller&)>& message_for) {
  for (const auto& client : clients_) {
    client->send(std::make_shared<const std::string>(message_for(client->subscriber.caller).dump()));
  }
}

void Broadcaster::end_session(std::uint32_t session) {
  const nlohmann::json message{{"type", "session"}, {"ended", true}};
  for (const auto& client : clients_) {
    if (client->subscriber.caller.session == session) {
      client->send(std::make_shared<const std::string>(message.dump()));
      Client::close_after_texts(client, {session_ended_code, "the session ended"});
    }
  }
}

bool Broadcaster::disconnect(std::uint32_t id) {
  const auto found =
      std::ranges::find(clients_, id, [](const auto& client) { return client->subscriber.id; });
  if (found == clients_.end()) {
    return false;
  }
  Client::close_after_texts(*found, {websocket::close_code::going_away, "disconnected by a user"});
  return true;
}

std::vector<Broadcaster::Subscriber> Broadcaster::subscribers() const {
  std::vector<Subscriber> subscribers;
  for (const auto& client : clients_) {
    subscribers.push_back(client->subscriber);
  }
  return subscribers;
}

bool Broadcaster::full(std::uint32_t session) const {
  const auto of_session = std::ranges::count_if(
      clients_, [&](const auto& client) { return client->subscriber.caller.session == session; });
  return clients_.size() >= capacity || static_cast<std::size_t>(of_session) >= session_capacity;
}

}  // namespace interlock::web
