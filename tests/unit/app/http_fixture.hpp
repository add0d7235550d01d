/**
 * @file
 * The server on a real socket; the test is its clients, and the control thread at the other end of the
 * channel.
 */
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/http/fields.hpp>
#include <future>
#include <memory>
#include <thread>

#include "http/server.hpp"
#include "robot_fixture.hpp"
#include "service/store_executor.hpp"
#include "store/audit.hpp"
#include "stream_client.hpp"
#include "temporary_folder.hpp"

namespace interlock::web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
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
  void add_user(const std::string& name, Role role);

  /** A new session of that user, opened past the server; the token. */
  std::string token_of(const std::string& name);

  /** Waits until the store knows that the session was used just now. */
  void wait_until_use_is_stored(const std::string& token);

  /** The audit's records, oldest first. */
  std::vector<AuditRecord> audit();

  /** The details of the records of that kind, oldest first. */
  std::vector<json> audit(const std::string& kind);

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

/** `edna`, an engineer, is logged in and is in control, with case 1 open, unless a test says otherwise. */
class HttpTest : public StoreFixture {
 protected:
  HttpTest() : HttpTest(test::neuro(), test::neuro_config()) {}

  /** Of another robot than the NeuroRobot. Both must outlive the test. */
  HttpTest(const Robot& robot, const ilk_config_t& config);

  ~HttpTest() override;

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

  tcp::socket connect();

  Answered read(tcp::socket& socket);

  Answered send(Request request);

  Answered get(const std::string& target);

  Answered post(const std::string& target, const std::string& body = "");

  Answered put(const std::string& target, const std::string& body);
  /** The robot's frame is the scanner's, wherever that is: there is no scanner here. */
  void register_robot(const json& pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                      bool ignores_rotation = false) {
    const json body{{"registration", pose},
                    {"ignore_registration_rotation", ignores_rotation},
                    {"override_reason", "There is no scanner."}};
    ASSERT_EQ(put("/api/targeting/registration", body.dump()).status, 200u);
  }

  /** Proposes, and approves what waits for that. */
  Answered propose(const json& body) {
    Answered made = post("/api/proposals", body.dump());
    if (made.status == 201u && json::parse(made.body)["state"] == "checked") {
      const std::string id = json::parse(made.body)["id"].dump();
      EXPECT_EQ(post("/api/proposals/" + id + "/approve").status, 200u);
    }
    return made;
  }

  Answered post_raw(const std::string& bytes);

  /** @param age of the kernel's state in it */
  void show(const ControlView& view, std::chrono::milliseconds age = {});

  /** The next command that the server sends. */
  Command next_command();
  /** The task that it approves next. */
  Task next_task() { return *std::get<Approval>(next_command()).task; }

  void answer(const Notice& notice);

  /** The stream of the session in use. */
  test::StreamClient open_stream();

  /** The status with which the server answers a further stream of the session in use; 101 when it opens it.
   */
  unsigned status_of_one_more_stream();

  /** The kernel accepts the next request. */
  std::uint32_t accept_next();

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

  /** The folder, with an index.html in it. */
  static const std::filesystem::path& with_first_page(const std::filesystem::path& folder);

  const Robot& robot_;
  const ilk_config_t& config_;
  test::TemporaryFolder web_;
  std::string token_;
  asio::io_context network_{1};
  asio::io_context client_{1};
  std::unique_ptr<Log> log_ = Log::start({}, LogLevel::info).value();
  std::unique_ptr<RealtimeChannel> channel_ = std::make_unique<RealtimeChannel>();
  StoreExecutor executor_{network_.get_executor(), store_, std::chrono::minutes(10)};
  Api api_{network_.get_executor(),
           robot_,
           config_,
           *channel_,
           "",
           executor_,
           *log_,
           Clocks{[this] { return now(); }, [this] { return steady_now(); }}};
  Server server_{network_.get_executor(), network_.get_executor(), api_, *channel_,
                 StaticFiles(with_first_page(web_.path()))};
  std::jthread thread_;
};

}  // namespace interlock::web
