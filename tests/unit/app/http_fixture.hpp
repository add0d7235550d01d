/**
 * @file
 * The server on a real socket; the test is its clients, and the control thread at the other end of the
 * mailbox.
 */
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fstream>
#include <future>
#include <memory>
#include <thread>

#include "http/server.hpp"
#include "robot_fixture.hpp"
#include "temporary_folder.hpp"

namespace interlock::web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using nlohmann::json;

struct Answered {
  unsigned status = 0;
  http::fields headers;
  std::string body;

  [[nodiscard]] json problem() const {
    EXPECT_EQ(headers[http::field::content_type], "application/problem+json");
    return json::parse(body);
  }
};

class HttpTest : public testing::Test {
 protected:
  HttpTest() {
    std::ofstream(folder_.path() / "index.html") << "<title>console</title>";
    const auto listening = server_.listen({"127.0.0.1", 0});
    EXPECT_TRUE(listening);
    asio::co_spawn(network_, api_.listen(), asio::detached);
    asio::co_spawn(network_, api_.beat(), asio::detached);
    asio::co_spawn(network_, server_.accept(), asio::detached);
    thread_ = std::jthread([this] { network_.run(); });
  }

  ~HttpTest() override { network_.stop(); }

  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }

  tcp::socket connect() {
    tcp::socket socket(client_);
    socket.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
    return socket;
  }

  Answered read(tcp::socket& socket) {
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(socket, buffer, response);
    return {response.result_int(), response.base(), response.body()};
  }

  Answered send(Request request) {
    if (request[http::field::host].empty()) {
      request.set(http::field::host, host());
    }
    request.prepare_payload();
    tcp::socket socket = connect();
    http::write(socket, request);
    return read(socket);
  }

  Answered get(const std::string& target) { return send({http::verb::get, target, 11}); }

  Answered post(const std::string& target, const std::string& body = "") {
    return send({http::verb::post, target, 11, body});
  }

  Answered put(const std::string& target, const std::string& body) {
    return send({http::verb::put, target, 11, body});
  }

  Answered post_raw(const std::string& bytes) {
    tcp::socket socket = connect();
    asio::write(socket, asio::buffer(bytes));
    return read(socket);
  }

  void show(const ControlView& view) {
    mailbox_->view.writing() = view;
    mailbox_->view.publish();
    mailbox_->network_wake.signal();
  }

  /** The next command that the server sends. */
  Command next_command() {
    Command command;
    while (!mailbox_->commands.pop(command)) {
      std::this_thread::yield();
    }
    return command;
  }

  void answer(const Notice& notice) {
    ASSERT_TRUE(mailbox_->notices.push(notice));
    mailbox_->network_wake.signal();
  }

  websocket::stream<tcp::socket> open_stream() {
    websocket::stream<tcp::socket> stream(connect());
    stream.handshake(host(), "/api/stream");
    return stream;
  }

  /** Runs in the network thread and waits for it. */
  template <typename Work>
  void in_network(Work work) {
    std::promise<void> done;
    asio::post(network_, [&] {
      work();
      done.set_value();
    });
    done.get_future().get();
  }

  test::TemporaryFolder folder_;
  asio::io_context network_{1};
  asio::io_context client_{1};
  std::unique_ptr<Mailbox> mailbox_ = std::make_unique<Mailbox>();
  Api api_{network_.get_executor(), test::neuro(), test::neuro_config(), *mailbox_, ""};
  Server server_{network_.get_executor(), api_, StaticFiles(folder_.path())};
  std::jthread thread_;
};

}  // namespace interlock::web
