#include "link_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fixtures.hpp"

namespace {

using interlock::host_test::connect_to;
using interlock::host_test::Descriptor;
using interlock::host_test::TemporaryDirectory;
using ::testing::HasSubstr;

bool has_waiting_connection(int listener) {
  pollfd wanted{listener, POLLIN, 0};
  return poll(&wanted, 1, 0) == 1;
}

class LinkSocket : public ::testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::string path_ = directory_.file("link");
  ilk_link_socket_t link_{};
  ilk_error_t error_{};
};

TEST_F(LinkSocket, SecondInstanceIsRefusedByNameAndTheFirstIsNotDisturbed) {
  ASSERT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  ilk_link_socket_t second{};
  EXPECT_EQ(ilk_link_listen(&second, path_.c_str(), &error_), ILK_LISTEN_TAKEN);
  EXPECT_THAT(error_.text, HasSubstr(path_));
  EXPECT_FALSE(has_waiting_connection(link_.descriptor));
  EXPECT_TRUE(connect_to(path_));
  EXPECT_TRUE(has_waiting_connection(link_.descriptor));
  ilk_link_unlisten(&link_);
}

TEST_F(LinkSocket, SecondInstanceIsRefusedWhileTheQueueIsFull) {
  ASSERT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  std::vector<Descriptor> waiting;
  for (int n = 0; n < 8; ++n) {
    waiting.push_back(*connect_to(path_));
  }
  ilk_link_socket_t second{};
  EXPECT_EQ(ilk_link_listen(&second, path_.c_str(), &error_), ILK_LISTEN_TAKEN);
  ilk_link_unlisten(&link_);
}

TEST_F(LinkSocket, StaleSocketIsReplaced) {
  ASSERT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  close(link_.descriptor);
  ASSERT_FALSE(connect_to(path_));
  ASSERT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  EXPECT_TRUE(connect_to(path_));
  ilk_link_unlisten(&link_);
}

TEST_F(LinkSocket, FileThatIsNoSocketIsKept) {
  std::ofstream(path_) << "precious";
  EXPECT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_FAILED);
  EXPECT_THAT(error_.text, HasSubstr("is not a socket"));
  EXPECT_TRUE(std::filesystem::is_regular_file(path_));
}

TEST_F(LinkSocket, IsForTheOwnerAloneAndRemovedAtTheEnd) {
  ASSERT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  struct stat status{};
  ASSERT_EQ(stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  ilk_link_unlisten(&link_);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(LinkSocket, AnothersSocketOfTheSameNameIsNotRemoved) {
  ASSERT_EQ(ilk_link_listen(&link_, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  std::filesystem::rename(path_, directory_.file("moved"));
  ilk_link_socket_t other{};
  ASSERT_EQ(ilk_link_listen(&other, path_.c_str(), &error_), ILK_LISTEN_OK) << error_.text;
  ilk_link_unlisten(&link_);
  EXPECT_TRUE(connect_to(path_));
  ilk_link_unlisten(&other);
}

TEST_F(LinkSocket, UnusablePathsAreNamed) {
  EXPECT_EQ(ilk_link_listen(&link_, directory_.file("no/such/link").c_str(), &error_), ILK_LISTEN_FAILED);
  EXPECT_THAT(error_.text, HasSubstr("create it first"));
  EXPECT_EQ(ilk_link_listen(&link_, std::string(200, 'x').c_str(), &error_), ILK_LISTEN_FAILED);
  EXPECT_THAT(error_.text, HasSubstr("200 characters; expected 1 to 107"));
  EXPECT_EQ(ilk_link_listen(&link_, "", &error_), ILK_LISTEN_FAILED);
}

}  // namespace
