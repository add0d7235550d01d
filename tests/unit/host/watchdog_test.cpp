#include "watchdog.h"

#include <gmock/gmock.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "fixtures.hpp"

namespace {

using interlock::host_test::Descriptor;
using interlock::host_test::TemporaryDirectory;
using ::testing::HasSubstr;

/// The socket of a service manager, named in the environment for as long as it lives.
class Manager {
 public:
  explicit Manager(const std::string& address) : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, address.data(), address.size());
    if (address.front() == '@') {
      name.sun_path[0] = '\0';
    }
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address.size());
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<const sockaddr*>(&name), length), 0);
    setenv("NOTIFY_SOCKET", address.c_str(), 1);
  }
  ~Manager() {
    for (const char* const name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) {
      unsetenv(name);
    }
  }

  /// What comes within that time, or nothing.
  std::string hear(int within_ms) {
    pollfd wanted{socket_.get(), POLLIN, 0};
    if (poll(&wanted, 1, within_ms) != 1) {
      return "";
    }
    std::array<char, 100> text{};
    const ssize_t length = recv(socket_.get(), text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(length)};
  }

 private:
  Descriptor socket_;
};

constexpr int patience_ms = 300'000;
constexpr int watchdog_ms = 80;

class Watchdog : public ::testing::Test {
 protected:
  bool start() { return ilk_watchdog_start(&watchdog, &beats, &error); }

  TemporaryDirectory folder;
  ilk_watchdog_t watchdog{};
  std::uint32_t beats = 0;
  ilk_error_t error{};
};

TEST_F(Watchdog, WithoutAServiceManagerNothingIsWatchedOrSent) {
  ASSERT_TRUE(start()) << error.text;
  EXPECT_FALSE(watchdog.watched);
  ilk_watchdog_ready(&watchdog);
  ilk_watchdog_stop(&watchdog);
}

TEST_F(Watchdog, SaysReadyAndStopping) {
  for (const std::string& address : {folder.file("notify"), "@interlock-test-" + std::to_string(getpid())}) {
    Manager manager(address);
    ASSERT_TRUE(start()) << error.text;
    EXPECT_FALSE(watchdog.watched) << "nobody asked for it";
    ilk_watchdog_ready(&watchdog);
    EXPECT_EQ(manager.hear(patience_ms), "READY=1");
    ilk_watchdog_stop(&watchdog);
    EXPECT_EQ(manager.hear(patience_ms), "STOPPING=1");
  }
}

TEST_F(Watchdog, TellsOnlyWhileTheLoopGoesOn) {
  Manager manager(folder.file("notify"));
  setenv("WATCHDOG_USEC", std::to_string(watchdog_ms * 1000).c_str(), 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  ASSERT_TRUE(start()) << error.text;
  ASSERT_TRUE(watchdog.watched);
  EXPECT_EQ(manager.hear(2 * watchdog_ms), "") << "the loop has not begun";
  for (int tick = 0; tick < 3; ++tick) {
    std::atomic_ref(beats).fetch_add(1);
    EXPECT_EQ(manager.hear(patience_ms), "WATCHDOG=1");
  }
  EXPECT_EQ(manager.hear(2 * watchdog_ms), "") << "the loop stands still";
  ilk_watchdog_stop(&watchdog);
  EXPECT_EQ(manager.hear(patience_ms), "STOPPING=1");
}

TEST_F(Watchdog, DoesNotAnswerForAnotherProcess) {
  Manager manager(folder.file("notify"));
  setenv("WATCHDOG_USEC", "80000", 1);
  setenv("WATCHDOG_PID", std::to_string(getppid()).c_str(), 1);
  ASSERT_TRUE(start()) << error.text;
  EXPECT_FALSE(watchdog.watched);
  ilk_watchdog_stop(&watchdog);
}

TEST_F(Watchdog, AManagerThatCannotBeReachedIsNamed) {
  for (const char* const address : {"nowhere", "/nowhere/notify", "@"}) {
    setenv("NOTIFY_SOCKET", address, 1);
    EXPECT_FALSE(start()) << address;
    EXPECT_THAT(error.text, HasSubstr("the service manager at $NOTIFY_SOCKET cannot be reached")) << address;
  }
  unsetenv("NOTIFY_SOCKET");
}

}  // namespace
