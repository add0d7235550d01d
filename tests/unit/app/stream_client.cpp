#include "stream_client.hpp"

#include <gtest/gtest.h>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <stdexcept>
#include <utility>

namespace interlock::test {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::asio::ip::tcp;
using nlohmann::json;

struct StreamClient::Stream {
  websocket::stream<tcp::socket> socket;
};

StreamClient::StreamClient(tcp::socket connected)
    : stream_(std::make_unique<Stream>(Stream{websocket::stream<tcp::socket>(std::move(connected))})) {}

StreamClient::StreamClient(StreamClient&&) noexcept = default;
StreamClient& StreamClient::operator=(StreamClient&&) noexcept = default;
StreamClient::~StreamClient() = default;

unsigned StreamClient::open(const std::string& host, const std::string& cookie, const std::string& origin) {
  stream_->socket.set_option(websocket::stream_base::decorator([=](websocket::request_type& request) {
    if (!cookie.empty()) {
      request.set(http::field::cookie, cookie);
    }
    if (!origin.empty()) {
      request.set(http::field::origin, origin);
    }
  }));
  websocket::response_type response;
  beast::error_code error;
  stream_->socket.handshake(response, host, "/api/stream", error);
  EXPECT_EQ(error, response.result() == http::status::switching_protocols
                       ? beast::error_code{}
                       : beast::error_code{websocket::error::upgrade_declined});
  return response.result_int();
}

std::optional<StreamMessage> StreamClient::next() {
  beast::flat_buffer buffer;
  beast::error_code error;
  stream_->socket.read(buffer, error);
  if (error) {
    return std::nullopt;
  }
  return StreamMessage{stream_->socket.got_text(), beast::buffers_to_string(buffer.data())};
}

json StreamClient::next_text() {
  while (const std::optional<StreamMessage> message = next()) {
    if (message->text) {
      return json::parse(message->data);
    }
  }
  throw std::runtime_error("the stream was closed before the message that the test waits for");
}

json StreamClient::next_text(const std::string& type) {
  json message = next_text();
  while (message.value("type", "") != type) {
    message = next_text();
  }
  return message;
}

unsigned StreamClient::close_code() {
  beast::error_code error;
  while (!error) {
    beast::flat_buffer buffer;
    stream_->socket.read(buffer, error);
  }
  EXPECT_EQ(error, websocket::error::closed);
  return stream_->socket.reason().code;
}

void StreamClient::send(const std::string& text) { stream_->socket.write(boost::asio::buffer(text)); }

void StreamClient::close() { stream_->socket.close(websocket::close_code::normal); }

std::uint16_t StreamClient::local_port() const {
  return stream_->socket.next_layer().local_endpoint().port();
}

}  // namespace interlock::test
