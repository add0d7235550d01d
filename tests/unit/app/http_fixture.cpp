#include "http_fixture.hpp"

#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <fstream>

#include "store/sessions.hpp"
#include "system/launch.hpp"

namespace interlock::web {

void StoreFixture::add_user(const std::string& name, Role role) {
  const auto added = mine_.transact([&](Transaction& transaction) {
    return Users(transaction).add(name, role, PasswordHash("of no password"), now());
  });
  ASSERT_TRUE(added);
}

std::string StoreFixture::token_of(const std::string& name) {
  const auto opened =
      mine_.transact([&](Transaction& transaction) { return Sessions(transaction).create(name, now()); });
  EXPECT_TRUE(opened);
  return opened ? opened->token : "";
}

void StoreFixture::wait_until_use_is_stored(const std::string& token) {
  for (bool stored = false; !stored;) {
    const auto found = mine_.read([&](Transaction& transaction) -> Stored<std::optional<Session>> {
      return Sessions(transaction).find(token, now());
    });
    ASSERT_TRUE(found && *found);
    stored = (*found)->last_seen == now();
  }
}

std::vector<AuditRecord> StoreFixture::audit() {
  return *mine_.read([](Transaction& transaction) -> Stored<std::vector<AuditRecord>> {
    return Audit(transaction).list(1000);
  });
}

std::vector<json> StoreFixture::audit(const std::string& kind) {
  std::vector<json> details;
  for (const AuditRecord& record : audit()) {
    if (record.kind == kind) {
      details.push_back(json::parse(record.detail));
    }
  }
  return details;
}

const std::filesystem::path& HttpTest::with_first_page(const std::filesystem::path& folder) {
  std::ofstream(folder / "index.html") << "<title>console</title>";
  return folder;
}

HttpTest::HttpTest(const Robot& robot, const ilk_config_t& config) : robot_(robot), config_(config) {
  add_user("ada", Role::admin);
  add_user("edna", Role::engineer);
  add_user("vic", Role::viewer);
  const auto listening = server_.door().listen({"127.0.0.1", 0});
  EXPECT_TRUE(listening);
  launch(network_.get_executor(), api_.listen());
  launch(network_.get_executor(), api_.broadcast());
  launch(network_.get_executor(), api_.sweep_sessions(std::chrono::milliseconds(5)));
  launch(network_.get_executor(), server_.door().accept());
  launch(network_.get_executor(), server_.door().listen_to_control());
  thread_ = std::jthread([this] { network_.run(); });
  log_in("edna");
  EXPECT_EQ(post("/api/control/request").status, 200u);
  EXPECT_EQ(post("/api/cases", R"({"label":"of the test"})").status, 201u);
  // The test is the control thread: it has seen the STOP that a change of control is.
  channel_->stops = 0;
}

HttpTest::~HttpTest() {
  network_.stop();
  thread_.join();
}

tcp::socket HttpTest::connect() {
  tcp::socket socket(client_);
  socket.connect({asio::ip::make_address("127.0.0.1"), server_.port()});
  return socket;
}

Answered HttpTest::read(tcp::socket& socket) {
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(socket, buffer, response);
  return {response.result_int(), response.base(), response.body()};
}

Answered HttpTest::send(Request request) {
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

Answered HttpTest::get(const std::string& target) { return send({http::verb::get, target, 11}); }

Answered HttpTest::post(const std::string& target, const std::string& body) {
  return send({http::verb::post, target, 11, body});
}

Answered HttpTest::put(const std::string& target, const std::string& body) {
  return send({http::verb::put, target, 11, body});
}

Answered HttpTest::post_raw(const std::string& bytes) {
  tcp::socket socket = connect();
  asio::write(socket, asio::buffer(bytes));
  return read(socket);
}

void HttpTest::show(const ControlView& view, std::chrono::milliseconds age) {
  channel_->view.writing() = view;
  channel_->view.writing().received = steady_now() - age;
  channel_->view.publish();
  channel_->network_wake.signal();
}

Command HttpTest::next_command() {
  Command command;
  while (!channel_->commands.pop(command)) {
    std::this_thread::yield();
  }
  return command;
}

void HttpTest::answer(const Notice& notice) {
  if (const auto* stopped = std::get_if<StopAnswer>(&notice)) {
    channel_->stopped.writing() = *stopped;
    channel_->stopped.publish();
    channel_->door_wake.signal();
  }
  ASSERT_TRUE(channel_->notices.push(notice));
  channel_->network_wake.signal();
}

test::StreamClient HttpTest::open_stream() {
  test::StreamClient stream(connect());
  EXPECT_EQ(stream.open(host(), cookie()), 101u);
  return stream;
}

unsigned HttpTest::status_of_one_more_stream() {
  return test::StreamClient(connect()).open(host(), cookie());
}

std::uint32_t HttpTest::accept_next() {
  const auto asked = std::get<KernelCall>(next_command());
  answer(KernelResponse{asked.call_id, ILK_VERDICT_ACCEPTED, 6});
  return asked.kind;
}

}  // namespace interlock::web
