#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <set>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using testing::HasSubstr;

class MotionControlTest : public HttpTest {
 protected:
  json control() { return json::parse(get("/api/control").body); }

  json control_seen_by(const std::string& token) {
    return as(token, [this] { return control(); });
  }

  Answered post_as(const std::string& token, const std::string& target, const std::string& body = "") {
    return as(token, [&] { return post(target, body); });
  }

  std::string propose() {
    const Answered made = post("/api/proposals", R"({"slot":3,"target_counts":1000})");
    EXPECT_EQ(made.status, 201u) << made.body;
    return "/api/proposals/" + std::to_string(json::parse(made.body)["id"].get<int>());
  }
};

TEST_F(MotionControlTest, RightsAreCheckedInTheirOrder) {
  show(test::ready_view());
  const std::string body = R"({"slot":99})";
  EXPECT_EQ(post("/api/nothing").status, 404u);
  become_nobody();
  EXPECT_EQ(send({http::verb::delete_, "/api/proposals", 11}).status, 405u);
  EXPECT_EQ(post("/api/proposals", body).problem()["code"], "LOGIN");
  log_in("vic");
  EXPECT_EQ(post("/api/proposals", body).problem()["code"], "ROLE");
  log_in("ada");
  const json problem = post("/api/proposals", body).problem();
  EXPECT_EQ(problem["code"], "CONTROL");
  EXPECT_THAT(problem["detail"].get<std::string>(), HasSubstr("edna"));
  EXPECT_EQ(get("/api/proposals").body, "[]");
}

TEST_F(MotionControlTest, NobodyButAnybodyStops) {
  become_nobody();
  EXPECT_EQ(post("/api/stop").status, 200u);
  EXPECT_EQ(channel_->stops.load(), 1u);
}

TEST_F(MotionControlTest, WhoeverAsksFirstHoldsItAndOthersAreNoted) {
  const std::string ada = token_of("ada");
  const Answered asked = post_as(ada, "/api/control/request");
  EXPECT_EQ(asked.status, 202u);
  const json seen = json::parse(asked.body);
  EXPECT_EQ(seen["holder"]["user"], "edna");
  EXPECT_EQ(seen["mine"], false);
  EXPECT_EQ(seen["requests"][0]["user"], "ada");
  EXPECT_EQ(control()["mine"], true);
  EXPECT_EQ(post("/api/control/request").status, 200u);
  EXPECT_EQ(post_as(ada, "/api/control/request").status, 202u);
  EXPECT_EQ(control()["requests"].size(), 1u);
  EXPECT_EQ(channel_->stops.load(), 0u) << "a request stops nothing";
}

TEST_F(MotionControlTest, AHandOverGoesOnlyToAnAskingSession) {
  const std::string ada = token_of("ada");
  EXPECT_EQ(post("/api/control/hand-over", R"({"session":999})").status, 404u);
  EXPECT_EQ(post("/api/control/hand-over", R"({"session":0})").status, 422u);
  const json asked = json::parse(post_as(ada, "/api/control/request").body);
  const json to{{"session", asked["requests"][0]["session"]}};
  EXPECT_EQ(post_as(ada, "/api/control/hand-over", to.dump()).problem()["code"], "CONTROL");
  EXPECT_EQ(post("/api/control/hand-over", to.dump()).status, 200u);
  EXPECT_EQ(control()["holder"]["user"], "ada");
  EXPECT_TRUE(control()["requests"].empty());
  EXPECT_EQ(post("/api/reset").problem()["code"], "CONTROL");
}

TEST_F(MotionControlTest, OnlyAnAdministratorTakesOver) {
  const std::string other = token_of("edna");
  EXPECT_EQ(post_as(other, "/api/control/take-over").problem()["code"], "ROLE");
  EXPECT_EQ(control()["mine"], true);
  EXPECT_EQ(post_as(token_of("ada"), "/api/control/take-over").status, 200u);
  EXPECT_EQ(control()["holder"]["user"], "ada");
}

TEST_F(MotionControlTest, EachChangeStopsAbortsAndHasANewNumber) {
  show(test::ready_view());
  const std::string ada = token_of("ada");
  std::set<std::uint32_t> numbers{channel_->holder.load()};
  const std::string proposal = propose();
  ASSERT_EQ(post_as(ada, "/api/control/take-over").status, 200u);
  EXPECT_EQ(json::parse(get(proposal).body)["state"], "aborted");
  EXPECT_EQ(channel_->stops.load(), 1u);
  numbers.insert(channel_->holder.load());
  ASSERT_EQ(post_as(ada, "/api/control/release").status, 200u);
  EXPECT_EQ(channel_->holder.load(), 0u);
  EXPECT_EQ(channel_->stops.load(), 2u);
  ASSERT_EQ(post("/api/control/request").status, 200u);
  numbers.insert(channel_->holder.load());
  EXPECT_EQ(numbers.size(), 3u);
  EXPECT_FALSE(numbers.contains(0));
}

TEST_F(MotionControlTest, ReleaseWithdrawsAWishAndElseDoesNothing) {
  const std::string ada = token_of("ada");
  ASSERT_EQ(post_as(ada, "/api/control/release").status, 200u);
  (void)post_as(ada, "/api/control/request");
  ASSERT_EQ(post_as(ada, "/api/control/release").status, 200u);
  EXPECT_TRUE(control()["requests"].empty());
  EXPECT_EQ(control()["mine"], true);
  EXPECT_EQ(channel_->stops.load(), 0u);
}

TEST_F(MotionControlTest, TheFormerPathsAnswerAsThePresentOnes) {
  EXPECT_EQ(get("/api/authority").body, get("/api/control").body);
  EXPECT_EQ(post("/api/authority/release").status, 200u);
  EXPECT_TRUE(control()["holder"].is_null());
}

TEST_F(MotionControlTest, LogoutReleasesIt) {
  show(test::ready_view());
  const std::string proposal = propose();
  ASSERT_EQ(post("/api/logout").status, 200u);
  log_in("vic");
  EXPECT_TRUE(control()["holder"].is_null());
  EXPECT_EQ(json::parse(get(proposal).body)["state"], "aborted");
}

TEST_F(MotionControlTest, AMinuteWithoutARequestReleasesIt) {
  const std::string vic = token_of("vic");
  pass(std::chrono::seconds(59));
  EXPECT_EQ(control()["mine"], true);
  pass(std::chrono::seconds(60));
  while (!control_seen_by(vic)["holder"].is_null()) {
    std::this_thread::yield();
  }
  EXPECT_EQ(channel_->holder.load(), 0u);
}

TEST_F(MotionControlTest, AnOpenStreamKeepsIt) {
  auto stream = open_stream();
  const std::string vic = token_of("vic");
  for (int i = 0; i < 4; ++i) {
    pass(std::chrono::seconds(40));
    // A state that was made after this moment: the app has looked after its sessions since.
    for (int states = 0; states < 3; ++states) {
      ASSERT_TRUE(stream.next());
    }
    EXPECT_EQ(control_seen_by(vic)["holder"]["user"], "edna") << i;
  }
}

TEST_F(MotionControlTest, TheStreamTellsEachClientWhetherItIsTheirs) {
  auto mine = open_stream();
  const std::string vic = token_of("vic");
  auto others = as(vic, [this] { return open_stream(); });
  (void)post_as(token_of("ada"), "/api/control/request");
  EXPECT_EQ(mine.next_text("control")["mine"], true);
  const json seen = others.next_text("control");
  EXPECT_EQ(seen["mine"], false);
  EXPECT_EQ(seen["requests"][0]["user"], "ada");
}

TEST_F(MotionControlTest, TheStreamNeedsASession) {
  become_nobody();
  EXPECT_EQ(test::StreamClient(connect()).open(host(), ""), 401u);
}

TEST_F(MotionControlTest, TheStreamOfASessionThatEndsIsClosedAndSaysWhy) {
  const std::string vic = token_of("vic");
  auto stream = as(vic, [this] { return open_stream(); });
  auto staying = open_stream();
  ASSERT_EQ(post_as(vic, "/api/logout").status, 200u);
  EXPECT_EQ(stream.next_text("session")["ended"], true);
  EXPECT_EQ(stream.close_code(), 4401u);
  EXPECT_TRUE(staying.next());
}

TEST_F(MotionControlTest, WhatAUserAsksOfTheKernelIsRecordedBeforeItIsSent) {
  show(test::ready_view());
  auto asking = std::async(std::launch::async, [this] { return post("/api/motors/3/enable"); });
  const auto asked = std::get<KernelCall>(next_command());
  ASSERT_EQ(audit("request").size(), 1u);
  EXPECT_EQ(audit("request")[0]["request"], "ENABLE");
  answer(KernelResponse{asked.call_id, ILK_VERDICT_ACCEPTED, 6});
  EXPECT_EQ(asking.get().status, 200u);
}

TEST_F(MotionControlTest, TheAuditHasWhoWhatAndWhen) {
  show(test::ready_view());
  ASSERT_EQ(post_as(token_of("ada"), "/api/control/take-over").status, 200u);
  while (audit("control").size() < 4) {
    std::this_thread::yield();
  }
  const auto records = audit();
  const auto taken = std::ranges::find_if(
      records, [](const AuditRecord& each) { return each.detail.find("take over") != std::string::npos; });
  ASSERT_NE(taken, records.end());
  EXPECT_EQ(taken->actor, "ada");
  EXPECT_EQ(taken->tick, 1000);
  EXPECT_EQ(taken->time, iso_8601(now()));
  EXPECT_EQ(audit("control").back()["holder"], "ada");
}

constexpr int timeout_ms = 5000;

/** A store whose records cannot be appended to, as if the disk were full. */
class BrokenStoreTest : public MotionControlTest {
 protected:
  BrokenStoreTest() {
    SQLite::Database database((folder_.path() / "state" / "interlock.db").string(), SQLite::OPEN_READWRITE,
                              timeout_ms);
    database.exec("CREATE TRIGGER broken BEFORE INSERT ON audit BEGIN SELECT RAISE(ABORT, 'disk full'); END");
  }
};

TEST_F(BrokenStoreTest, ChangesAreRefusedAndNothingIsChanged) {
  show(test::ready_view());
  for (const char* const target : {"/api/reset", "/api/motors/3/enable"}) {
    EXPECT_EQ(post(target).problem()["code"], "STORE") << target;
  }
  EXPECT_EQ(channel_->commands.read_available(), 0u);
  EXPECT_EQ(post_as(token_of("ada"), "/api/control/take-over").problem()["code"], "STORE");
  EXPECT_EQ(control()["mine"], true);
}

TEST_F(BrokenStoreTest, StopObservationAndReleaseGoOn) {
  EXPECT_EQ(post("/api/stop").status, 200u);
  EXPECT_EQ(channel_->stops.load(), 1u);
  EXPECT_EQ(get("/api/status").status, 200u);
  EXPECT_EQ(post("/api/control/release").status, 200u);
  EXPECT_TRUE(control()["holder"].is_null());
  EXPECT_EQ(post("/api/logout").problem()["code"], "STORE")
      << "the session ends, and the store does not know it";
  EXPECT_EQ(get("/api/motors").status, 401u);
}

}  // namespace
}  // namespace interlock::web
