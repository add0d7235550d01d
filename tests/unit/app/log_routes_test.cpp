#include <spdlog/spdlog.h>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

using LogRoutesTest = HttpTest;

std::vector<std::string> texts(const json& log) {
  std::vector<std::string> found;
  for (const json& line : log["lines"]) {
    found.push_back(line["text"]);
  }
  return found;
}

TEST_F(LogRoutesTest, TheNewestLinesComeOldestFirst) {
  for (int i = 0; i < 30; ++i) {
    spdlog::info("line {}", i);
  }
  const json log = json::parse(get("/api/logs").body);
  EXPECT_EQ(log["level"], "info");
  ASSERT_EQ(log["lines"].size(), 20u);
  EXPECT_EQ(log["lines"][19]["text"], "line 29");
  EXPECT_EQ(log["lines"][0]["text"], "line 10");
  EXPECT_EQ(texts(json::parse(get("/api/logs?lines=2").body)),
            (std::vector<std::string>{"line 28", "line 29"}));
}

TEST_F(LogRoutesTest, OnlyLinesOfThatLevelAreShown) {
  spdlog::info("news");
  spdlog::error("failure");
  spdlog::info("more news");
  const json log = json::parse(get("/api/logs?level=error&colour=red").body);
  EXPECT_EQ(texts(log), std::vector<std::string>{"failure"});
  EXPECT_EQ(log["lines"][0]["level"], "error");
  EXPECT_EQ(log["lines"][0]["repeated"], 0);
}

TEST_F(LogRoutesTest, AWrongParameterIsNamed) {
  const std::pair<std::string, std::string> cases[] = {{"lines=0", "lines"},   {"lines=1001", "lines"},
                                                       {"lines=x", "lines"},   {"lines=", "lines"},
                                                       {"lines=1.5", "lines"}, {"level=loud", "level"}};
  for (const auto& [query, field] : cases) {
    const Answered answered = get("/api/logs?" + query);
    EXPECT_EQ(answered.status, 422u) << query;
    EXPECT_EQ(answered.problem()["field"], field) << query;
  }
}

TEST_F(LogRoutesTest, AnAdministratorChangesTheLevel) {
  const std::string admin = token_of("ada");
  const Answered changed = as(admin, [this] { return put("/api/logs", R"({"level":"debug"})"); });
  ASSERT_EQ(changed.status, 200u) << changed.body;
  EXPECT_EQ(json::parse(changed.body), json({{"level", "debug"}, {"lines", json::array()}}));
  EXPECT_EQ(log_->level(), LogLevel::debug);
  EXPECT_EQ(audit("setting"),
            std::vector<json>({{{"setting", "log_level"}, {"old", "info"}, {"new", "debug"}}}));
}

TEST_F(LogRoutesTest, ARefusedLevelChangesNothing) {
  EXPECT_EQ(put("/api/logs", R"({"level":"debug"})").problem()["code"], "ROLE");
  const std::string admin = token_of("ada");
  for (const std::string body :
       {R"({"level":"loud"})", R"({"level":1})", "{}", R"({"level":"debug","file":"x"})"}) {
    const Answered answered = as(admin, [&] { return put("/api/logs", body); });
    EXPECT_EQ(answered.status, 422u) << body;
    EXPECT_EQ(answered.problem()["code"], "INVALID") << body;
  }
  EXPECT_EQ(as(admin, [this] { return put("/api/logs", "{"); }).status, 400u);
  EXPECT_EQ(log_->level(), LogLevel::info);
  EXPECT_TRUE(audit("setting").empty());
}

TEST_F(LogRoutesTest, TheStreamTellsEachLine) {
  auto stream = open_stream();
  ASSERT_TRUE(stream.next());
  spdlog::warn("\xff odd");
  spdlog::info("last");
  std::vector<std::string> told;
  while (told.empty() || told.back() != "last") {
    told.push_back(stream.next_text("log")["text"]);
  }
  EXPECT_THAT(told, testing::IsSupersetOf({R"(\xff odd)", "last"}));
}

}  // namespace
}  // namespace interlock::web
