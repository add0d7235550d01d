#include <SQLiteCpp/SQLiteCpp.h>

#include <boost/asio/use_future.hpp>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using testing::HasSubstr;

/** The store's thread can be kept busy for as long as a test needs it. */
class OverloadTest : public HttpTest {
 protected:
  ~OverloadTest() override { release_store(); }

  void hold_store() {
    held_.emplace();
    auto wait = [until = held_->get_future().share()](Store&) -> Stored<void> {
      until.wait();
      return {};
    };
    waiting_ = asio::co_spawn(network_, executor_.run(std::move(wait)), asio::use_future);
  }

  void release_store() {
    if (held_) {
      held_->set_value();
      held_.reset();
      waiting_.wait();
    }
  }

  std::size_t from_server(std::size_t (Server::*figure)() const) {
    std::size_t found = 0;
    in_network([&] { found = (server_.*figure)(); });
    return found;
  }

  void wait_until_at_work(std::size_t count) {
    while (from_server(&Server::at_work) != count) {
      std::this_thread::yield();
    }
  }

  /** A connection whose request is sent and waits for the store. */
  tcp::socket send_target(int x) {
    Request request{http::verb::put, "/api/targeting/target", 11, json{{"target_point", {x, 0, 0}}}.dump()};
    request.set(http::field::host, host());
    request.set(http::field::cookie, cookie());
    request.prepare_payload();
    tcp::socket socket = connect();
    http::write(socket, request);
    return socket;
  }

  json target() { return json::parse(get("/api/targeting").body)["target_point"]; }

  std::optional<std::promise<void>> held_;
  std::future<tl::expected<void, Problem>> waiting_;
};

TEST_F(OverloadTest, StopAndStatusGetInWhenEveryConnectionWaitsForTheStore) {
  hold_store();
  std::vector<tcp::socket> waiting;
  while (waiting.size() < server_.ceiling()) {
    waiting.push_back(send_target(static_cast<int>(waiting.size())));
  }
  wait_until_at_work(server_.ceiling());
  EXPECT_EQ(post("/api/stop").status, 200u);
  EXPECT_EQ(channel_->stops.load(), 1u);
  EXPECT_EQ(get("/api/status").status, 200u);
  const Answered refused = get("/api/targeting");
  EXPECT_EQ(refused.status, 503u);
  EXPECT_EQ(refused.problem()["code"], "OVERLOADED");
  EXPECT_EQ(refused.headers[http::field::connection], "close");
  release_store();
  for (tcp::socket& each : waiting) {
    EXPECT_EQ(read(each).status, 200u);
  }
}

TEST_F(OverloadTest, NoFloodOpensMoreConnectionsThanTheCeilingAndItsReserve) {
  hold_store();
  std::vector<tcp::socket> flood;
  while (flood.size() < server_.ceiling()) {
    flood.push_back(send_target(1));
  }
  wait_until_at_work(server_.ceiling());
  for (std::size_t i = 0; i < 3 * Server::reserve; ++i) {
    flood.push_back(connect());
  }
  EXPECT_EQ(post("/api/stop").status, 200u);
  EXPECT_LE(from_server(&Server::connections), server_.ceiling() + Server::reserve);
}

/** A descriptor that is closed twice takes somebody else's away, be it the one that accepts. */
TEST_F(OverloadTest, WhoIsTurnedAwayTakesNobodysDescriptorAlong) {
  hold_store();
  std::vector<tcp::socket> flood;
  while (flood.size() < server_.ceiling()) {
    flood.push_back(send_target(1));
  }
  wait_until_at_work(server_.ceiling());
  // What is no request is answered, and what still comes is read for a second: nobody makes room meanwhile.
  for (std::size_t i = 0; i < 10 * Server::reserve; ++i) {
    flood.push_back(connect());
    asio::write(flood.back(), asio::buffer(std::string("?\r\n\r\n")));
    if (i % (5 * Server::reserve) == 0) {
      EXPECT_EQ(post("/api/stop").status, 200u);
    }
  }
  EXPECT_EQ(post("/api/stop").status, 200u);
}

TEST_F(OverloadTest, WhoLosesControlWhileTheStoreIsBusyChangesNothing) {
  const json before = target();
  hold_store();
  tcp::socket waiting = send_target(42);
  wait_until_at_work(1);
  EXPECT_EQ(post("/api/control/release").status, 200u);
  release_store();
  const Answered answered = read(waiting);
  EXPECT_EQ(answered.status, 409u);
  EXPECT_EQ(answered.problem()["code"], "CONTROL");
  EXPECT_EQ(target(), before);
  EXPECT_TRUE(audit("setting").empty());
}

TEST_F(OverloadTest, WhoseSessionEndsWhileTheStoreIsBusyChangesNothing) {
  const json before = target();
  hold_store();
  tcp::socket waiting = send_target(42);
  wait_until_at_work(1);
  EXPECT_TRUE(mine_.transact([](Transaction& transaction) -> Stored<void> {
    Sessions(transaction).end_all_of_user("edna");
    return {};
  }));
  release_store();
  EXPECT_EQ(read(waiting).problem()["code"], "LOGIN");
  log_in("edna");
  EXPECT_EQ(target(), before);
}

TEST_F(OverloadTest, AnAdministratorWhoseSessionEndsWhileTheStoreIsBusyChangesNoUser) {
  log_in("ada");
  ASSERT_EQ(get("/api/users").status, 200u);
  const json request{{"name", "eve"}, {"role", "admin"}, {"password", "correct horse battery"}};
  hold_store();
  auto adding = std::async(std::launch::async, [&] { return post("/api/users", request.dump()); });
  wait_until_at_work(1);
  EXPECT_TRUE(mine_.transact([](Transaction& transaction) -> Stored<void> {
    Sessions(transaction).end_all_of_user("ada");
    return {};
  }));
  release_store();
  EXPECT_EQ(adding.get().problem()["code"], "LOGIN");
  log_in("ada");
  EXPECT_THAT(get("/api/users").body, testing::Not(HasSubstr("eve")));
}

TEST_F(OverloadTest, StopAndStatusDoNotWaitForTheStoreToKnowTheCaller) {
  log_in("vic");
  hold_store();
  EXPECT_EQ(get("/api/status").status, 200u);
  EXPECT_EQ(post("/api/stop").status, 200u);
}

TEST_F(OverloadTest, ALogoutThatTheStoreDoesNotTakeSaysSoAndIsRecordedLater) {
  const auto execute = [this](const char* sql) {
    ASSERT_TRUE(mine_.transact([&](Transaction& transaction) -> Stored<void> {
      transaction.database().exec(sql);
      return {};
    }));
  };
  execute("CREATE TRIGGER no_records BEFORE INSERT ON audit BEGIN SELECT RAISE(ABORT, 'refused'); END");
  const Answered answered = post("/api/logout");
  EXPECT_EQ(answered.status, 503u);
  EXPECT_EQ(answered.problem()["code"], "STORE");
  EXPECT_THAT(std::string(answered.headers[http::field::set_cookie]), HasSubstr("Max-Age=0"));
  EXPECT_EQ(get("/api/motors").status, 401u) << "the session has ended all the same";
  execute("DROP TRIGGER no_records");
  while (audit("logout").empty()) {
    std::this_thread::yield();
  }
  const std::string token = std::exchange(token_, "");
  const auto found = mine_.read([&](Transaction& transaction) -> Stored<std::optional<Session>> {
    return Sessions(transaction).find(token, now());
  });
  EXPECT_FALSE(found->has_value());
  EXPECT_EQ(audit("logout").size(), 1u);
}

TEST(WorkPool, WithoutMemoryForAPieceOfWorkIsOverloadedAndGoesOn) {
  asio::io_context network;
  WorkPool pool;
  auto too_much = []() -> int { throw std::bad_alloc(); };
  auto failed = asio::co_spawn(network, pool.run(std::move(too_much)), asio::use_future);
  auto little = [] { return 5; };
  auto done = asio::co_spawn(network, pool.run(std::move(little)), asio::use_future);
  network.run();
  const auto refused = failed.get();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, Status::service_unavailable);
  EXPECT_EQ(refused.error().code, "OVERLOADED");
  EXPECT_EQ(done.get(), 5);
}

}  // namespace
}  // namespace interlock::web
