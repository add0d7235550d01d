#include "http/stream_hub.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

constexpr std::size_t longest_client_message = 1024;
constexpr auto as_result = asio::as_tuple(asio::use_awaitable);

websocket::stream_base::timeout timeouts() {
  return {.handshake_timeout = std::chrono::seconds(5),
          .idle_timeout = std::chrono::seconds(10),
          .keep_alive_pings = true};
}

}  // namespace

void StreamHub::Client::close() {
  open = false;
  news.cancel();
  beast::get_lowest_layer(socket).close();
}

asio::awaitable<void> StreamHub::serve(beast::tcp_stream stream, Request request) {
  auto client = std::make_shared<Client>(std::move(stream));
  beast::get_lowest_layer(client->socket).expires_never();
  client->socket.set_option(timeouts());
  client->socket.read_message_max(longest_client_message);
  const auto [accept_error] = co_await client->socket.async_accept(request, as_result);
  if (accept_error) {
    co_return;
  }
  const auto place = clients_.insert(clients_.end(), client);
  asio::co_spawn(client->socket.get_executor(), write(client), asio::detached);
  beast::flat_buffer buffer;
  const auto [read_error, bytes] = co_await client->socket.async_read(buffer, as_result);
  if (!read_error && client->open) {
    // Only a client that misunderstands the interface sends anything; it is told so instead of being ignored.
    co_await client->socket.async_close(
        {websocket::close_code::policy_error, "this stream takes no messages"}, as_result);
  }
  clients_.erase(place);
  client->close();
}

asio::awaitable<void> StreamHub::write(std::shared_ptr<Client> client) {
  while (client->open) {
    beast::error_code error;
    if (!client->texts.empty()) {
      const auto text = client->texts.front();
      client->texts.pop_front();
      client->socket.text(true);
      error = std::get<0>(co_await client->socket.async_write(asio::buffer(*text), as_result));
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

void StreamHub::send_state(const StreamMessage& state) {
  for (const auto& client : clients_) {
    client->state = state;
    client->news.cancel();
  }
}

void StreamHub::send_text(const nlohmann::json& message) {
  const auto text = std::make_shared<const std::string>(message.dump());
  for (const auto& client : clients_) {
    if (client->texts.size() == backlog) {
      spdlog::warn("a stream client is {} messages behind and was dropped", backlog);
      client->close();
      continue;
    }
    client->texts.push_back(text);
    client->news.cancel();
  }
}

}  // namespace interlock::web
