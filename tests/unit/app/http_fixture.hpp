/**
 * @file
 * The server on a real socket; the test is its clients, and the control thread at the other end of the
 * mailbox.
 */
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
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
#include "http/store_gateway.hpp"
#include "robot_fixture.hpp"
#include "store/audit.hpp"
#include "store/sessions.hpp"
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

/** A store in a file of its own, and a second connection to it for the test. */
class StoreFixture : public testing::Test {
 protected:
  /** Adds a user who cannot log in with a password but has sessions. The first one is an administrator. */
  void add_user(const std::string& name, Role role) {
    const auto added = mine_.transact([&](Transaction& transaction) {
      return Users(transaction).add(name, role, PasswordHash("of no password"), now());
    });
    ASSERT_TRUE(added);
  }

  /** A new session of that user, opened past the server; the token. */
  std::string token_of(const std::string& name) {
    const auto opened =
        mine_.transact([&](Transaction& transaction) { return Sessions(transaction).create(name, now()); });
    EXPECT_TRUE(opened);
    return opened ? opened->token : "";
  }

  /** Waits until the store knows that the session was used just now. */
  void wait_until_use_is_stored(const std::string& token) {
    for (bool stored = false; !stored;) {
      const auto found = mine_.read([&](Transaction& transaction) -> Stored<std::optional<Session>> {
        return Sessions(transaction).find(token, now());
      });
      ASSERT_TRUE(found && *found);
      stored = (*found)->last_seen == now();
    }
  }

  /** The audit's records, oldest first. */
  std::vector<AuditRecord> audit() {
    return *mine_.read([](Transaction& transaction) -> Stored<std::vector<AuditRecord>> {
      return Audit(transaction).list(1000);
    });
  }

  /** The details of the records of that kind, oldest first. */
  std::vector<json> audit(const std::string& kind) {
    std::vector<json> details;
    for (const AuditRecord& record : audit()) {
      if (record.kind == kind) {
        details.push_back(json::parse(record.detail));
      }
    }
    return details;
  }

  [[nodiscard]] UtcTime now() const { return UtcTime(std::chrono::seconds(seconds_.load())); }
  [[nodiscard]] SteadyTime steady_now() const { return SteadyTime(std::chrono::seconds(passed_.load())); }

  /** Time passes. */
  void pass(std::chrono::seconds time) {
    passed_ += time.count();
    seconds_ += time.count();
  }

  /** Somebody sets the clock by as much. */
  void set_clock(std::chrono::seconds change) { seconds_ += change.count(); }

  test::TemporaryFolder folder_;
  std::atomic<std::int64_t> seconds_{1'700'000'000}; /**< the app's clock */
  std::atomic<std::int64_t> passed_{1'000'000};      /**< time that passes whatever the clock says */
  Store store_ = *Store::open(folder_.path() / "state" / "interlock.db");
  Store mine_ = *Store::open(folder_.path() / "state" / "interlock.db");
};

/** `edna`, an engineer, is logged in and holds the authority, unless a test says otherwise. */
class HttpTest : public StoreFixture {
 protected:
  explicit HttpTest(std::chrono::milliseconds patience_with_store = StoreGateway::usual_patience)
      : patience_with_store_(patience_with_store) {
    std::ofstream(web_.path() / "index.html") << "<title>console</title>";
    add_user("ada", Role::admin);
    add_user("edna", Role::engineer);
    add_user("vic", Role::viewer);
    const auto listening = server_.listen({"127.0.0.1", 0});
    EXPECT_TRUE(listening);
    asio::co_spawn(network_, api_.listen(), asio::detached);
    asio::co_spawn(network_, api_.beat(), asio::detached);
    asio::co_spawn(network_, api_.sweep_sessions(std::chrono::milliseconds(5)), asio::detached);
    asio::co_spawn(network_, server_.accept(), asio::detached);
    thread_ = std::jthread([this] { network_.run(); });
    log_in("edna");
    EXPECT_EQ(post("/api/authority/request").status, 200u);
    // The test is the control thread: it has seen the STOP that a change of the authority is.
    mailbox_->stops = 0;
  }

  ~HttpTest() override {
    network_.stop();
    thread_.join();
  }

  /** From now on requests come from a new session of that user. */
  void log_in(const std::string& name) { token_ = token_of(name); }

  /** From now on requests come from nobody. */
  void become_nobody() { token_.clear(); }

  /** What `work` gives when its requests come from the session of that token. */
  template <typename Work>
  auto as(const std::string& token, Work work) {
    const std::string former = std::exchange(token_, token);
    auto result = work();
    token_ = former;
    return result;
  }

  [[nodiscard]] std::string cookie() const {
    return "interlock_session_" + std::to_string(server_.port()) + "=" + token_;
  }

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
    if (request[http::field::cookie].empty() && !token_.empty()) {
      request.set(http::field::cookie, cookie());
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
    show_cookie(stream);
    stream.handshake(host(), "/api/stream");
    return stream;
  }

  void show_cookie(websocket::stream<tcp::socket>& stream) {
    stream.set_option(websocket::stream_base::decorator(
        [sent = cookie()](websocket::request_type& request) { request.set(http::field::cookie, sent); }));
  }

  /** The next text message of that type. */
  json next_text(websocket::stream<tcp::socket>& stream, const std::string& type) {
    for (;;) {
      beast::flat_buffer buffer;
      stream.read(buffer);
      json message =
          stream.got_text() ? json::parse(beast::buffers_to_string(buffer.data())) : json::object();
      if (message.value("type", "") == type) {
        return message;
      }
    }
  }

  /** The code with which the server closes the stream. */
  unsigned close_code(websocket::stream<tcp::socket>& stream) {
    beast::error_code error;
    while (!error) {
      beast::flat_buffer buffer;
      stream.read(buffer, error);
    }
    EXPECT_EQ(error, websocket::error::closed);
    return stream.reason().code;
  }

  /** The kernel accepts the next request. */
  std::uint32_t accept_next() {
    const auto asked = std::get<Ask>(next_command());
    answer(Answer{asked.ticket, ILK_VERDICT_ACCEPTED, 6});
    return asked.kind;
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

  std::chrono::milliseconds patience_with_store_;
  test::TemporaryFolder web_;
  std::string token_;
  asio::io_context network_{1};
  asio::io_context client_{1};
  std::unique_ptr<Log> log_ = Log::start({}, LogLevel::info).value();
  std::unique_ptr<Mailbox> mailbox_ = std::make_unique<Mailbox>();
  StoreGateway gateway_{network_.get_executor(), store_, patience_with_store_};
  Api api_{network_.get_executor(),
           test::neuro(),
           test::neuro_config(),
           *mailbox_,
           "",
           gateway_,
           *log_,
           Clocks{[this] { return now(); }, [this] { return steady_now(); }}};
  Server server_{network_.get_executor(), api_, StaticFiles(web_.path())};
  std::jthread thread_;
};

}  // namespace interlock::web
