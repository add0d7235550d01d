#include "recorder/audit_heads.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

namespace interlock::recorder {
namespace {

namespace fs = std::filesystem;

class AuditHeadsTest : public testing::Test {
 protected:
  AuditHeadsTest() {
    std::string pattern = fs::temp_directory_path() / "interlock-heads-XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~AuditHeadsTest() override { fs::remove_all(folder_); }

  AuditHeads open() const {
    auto opened = AuditHeads::open(folder_ / "heads.sock", folder_ / "audit-heads");
    EXPECT_TRUE(opened) << opened.error();
    return std::move(*opened);
  }

  void send(const std::string& message) const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::ranges::copy((folder_ / "heads.sock").native(), std::begin(address.sun_path));
    const FileDescriptor sender(::socket(AF_UNIX, SOCK_DGRAM, 0));
    EXPECT_EQ(::sendto(sender.get(), message.data(), message.size(), 0,
                       reinterpret_cast<const sockaddr*>(&address), sizeof address),
              static_cast<ssize_t>(message.size()));
  }

  /** The lines of the file, without their times. */
  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    std::ifstream file(folder_ / "audit-heads");
    for (std::string line; std::getline(file, line);) {
      lines.push_back(line.substr(std::min(line.find(' ') + 1, line.size())));
    }
    return lines;
  }

  static std::string head(int number) { return std::to_string(number) + ' ' + std::string(64, 'a'); }

  fs::path folder_;
};

TEST_F(AuditHeadsTest, TheFirstIsKeptAtOnceAndOfThoseInAPauseTheNewest) {
  AuditHeads heads = open();
  send(head(1));
  heads.step();
  EXPECT_EQ(lines(), std::vector{head(1)});
  for (int number = 2; number < 9; ++number) {
    send(head(number));
    heads.step();
  }
  EXPECT_EQ(lines(), std::vector{head(1)});
  heads.finish();
  heads.finish();
  EXPECT_EQ(lines(), (std::vector{head(1), head(8)}));
}

TEST_F(AuditHeadsTest, NothingButAHeadGetsIntoTheFile) {
  AuditHeads heads = open();
  for (const std::string& other :
       {std::string(), std::string("7"), head(7) + "a", head(7).substr(1), "7\n" + std::string(64, 'a'),
        "7 " + std::string(64, 'A'), std::string(20, '9') + head(7), "-" + head(7), std::string(2000, 'a')}) {
    send(other);
    heads.finish();
  }
  EXPECT_TRUE(lines().empty());
}

TEST_F(AuditHeadsTest, AnotherRecorderGoesOnBehindALineThatWasCutOff) {
  {
    AuditHeads heads = open();
    send(head(1));
    heads.finish();
  }
  std::ofstream(folder_ / "audit-heads", std::ios::app) << "2024 2 aaa";
  AuditHeads heads = open();
  send(head(3));
  heads.finish();
  EXPECT_EQ(lines(), (std::vector<std::string>{head(1), "2 aaa", head(3)}));
}

TEST_F(AuditHeadsTest, TheGroupMayReportAndReadButNotWrite) {
  const mode_t mask = ::umask(0027);
  const AuditHeads heads = open();
  ::umask(mask);
  EXPECT_EQ(fs::status(folder_ / "heads.sock").permissions(), fs::perms(0660));
  EXPECT_EQ(fs::status(folder_ / "audit-heads").permissions(), fs::perms(0640));
}

}  // namespace
}  // namespace interlock::recorder
