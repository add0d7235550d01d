#include "log/log.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../app/temporary_folder.hpp"

namespace interlock {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Log, KeepsTheLineAtOnceAndHasItInItsFileInUtcAtTheEnd) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log" / "app.log";
  {
    const auto log = Log::start(file, LogLevel::info);
    ASSERT_TRUE(log);
    spdlog::info("hello {}", 3);
    ASSERT_EQ((*log)->ring().after(0).size(), 1u);
    EXPECT_EQ((*log)->ring().after(0)[0].text, "hello 3");
    EXPECT_EQ((*log)->lines_lost(), 0u);
  }
  EXPECT_THAT(text_of(file), MatchesRegex("....-..-..T..:..:..\\....Z info hello 3\n"));
}

TEST(Log, AFlushBringsTheLineOfADyingProcessIntoTheFile) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "app.log";
  EXPECT_EXIT(
      {
        const auto log = Log::start(file, LogLevel::info);
        spdlog::critical("last words");
        spdlog::default_logger()->flush();
        std::abort();
      },
      testing::KilledBySignal(SIGABRT), "");
  EXPECT_THAT(text_of(file), HasSubstr("critical last words"));
}

/** A pipe in the place of the file, which nobody reads: as a disk that hangs. */
TEST(Log, TheProcessEndsWithItsOwnExitCodeWhileTheDiskHangs) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "app.log";
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  const int reader = open(file.c_str(), O_RDONLY | O_NONBLOCK);
  EXPECT_EXIT(
      {
        {
          const auto log = Log::start(file, LogLevel::info);
          for (int line = 0; line < 1000; ++line) {
            spdlog::info("{}{}", line, std::string(1000, 'x'));
          }
        }
        std::exit(7);
      },
      testing::ExitedWithCode(7), "");
  close(reader);
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
