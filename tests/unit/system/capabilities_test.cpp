#include "system/capabilities.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <string>

namespace interlock {
namespace {

std::map<std::string, std::string> status_of_this_process() {
  std::ifstream lines("/proc/self/status");
  std::map<std::string, std::string> status;
  std::string key;
  std::string value;
  while (std::getline(lines, key, ':') && std::getline(lines >> std::ws, value)) {
    status[key] = value;
  }
  return status;
}

/** In a child, since it cannot be taken back: 0 when nothing is left. */
int what_is_left() {
  if (!give_up_capabilities()) {
    return 1;
  }
  const auto status = status_of_this_process();
  const std::string nothing(16, '0');
  for (const char* const held : {"CapInh", "CapPrm", "CapEff", "CapAmb"}) {
    if (status.at(held) != nothing) {
      return 2;
    }
  }
  if (status.at("NoNewPrivs") != "1") {
    return 3;
  }
  // Again, with nothing to give up: a user who is not root starts like that.
  return give_up_capabilities() ? 0 : 4;
}

TEST(Capabilities, AreGivenUpForGoodWhoeverStartsTheApp) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    _exit(what_is_left());
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace interlock
