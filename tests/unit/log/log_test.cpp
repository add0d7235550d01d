#include "log/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "../app/temporary_folder.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

TEST(Log, WritesItsFileInUtcAndKeepsTheLine) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log" / "app.log";
  const auto log = Log::start(file, LogLevel::info);
  ASSERT_TRUE(log);
  spdlog::info("hello {}", 3);
  std::ostringstream written;
  written << std::ifstream(file).rdbuf();
  EXPECT_THAT(written.str(), MatchesRegex("....-..-..T..:..:..\\....Z info hello 3\n"));
  ASSERT_EQ((*log)->ring().after(0).size(), 1u);
  EXPECT_EQ((*log)->ring().after(0)[0].text, "hello 3");
}

TEST(Log, ItsLevelChangesAtRunTime) {
  const auto log = Log::start({}, LogLevel::warning);
  ASSERT_TRUE(log);
  spdlog::info("unseen");
  EXPECT_EQ((*log)->ring().last(), 0u);
  for (const LogLevel level :
       {LogLevel::debug, LogLevel::info, LogLevel::warning, LogLevel::error, LogLevel::critical}) {
    (*log)->set_level(level);
    EXPECT_EQ((*log)->level(), level);
  }
  (*log)->set_level(LogLevel::debug);
  spdlog::debug("seen");
  EXPECT_EQ((*log)->ring().last(), 1u);
}

TEST(Log, AFileThatCannotBeWrittenIsNamed) {
  const auto log = Log::start("/proc/nowhere/app.log", LogLevel::info);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error(), HasSubstr("/proc/nowhere/app.log"));
}

TEST(Log, TheDefaultLoggerWorksOnWithoutIt) {
  {
    const auto log = Log::start({}, LogLevel::info);
  }
  spdlog::info("still written to standard error");
}

}  // namespace
}  // namespace interlock
