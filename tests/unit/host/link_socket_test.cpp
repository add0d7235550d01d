#include "link_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

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
  TemporaryDirectory directory;
  std::string path = directory.file("link");
  ilk_link_socket_t link{};
  ilk_error_t error{};
};

TEST_F(LinkSocket, SecondInstanceIsRefusedByNameAndTheFirstIsNotDisturbed) {
  ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  ilk_link_socket_t second{};
  EXPECT_EQ(ilk_link_listen(&second, path.c_str(), &error), ILK_LISTEN_TAKEN);
  EXPECT_THAT(error.text, HasSubstr(path));
  EXPECT_FALSE(has_waiting_connection(link.descriptor));
  EXPECT_TRUE(connect_to(path));
  EXPECT_TRUE(has_waiting_connection(link.descriptor));
  ilk_link_unlisten(&link);
}

TEST_F(LinkSocket, SecondInstanceIsRefusedWhileTheQueueIsFull) {
  ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  std::array<std::optional<Descriptor>, 8> waiting;
  for (auto& connection : waiting) {
    connection = connect_to(path);
  }
  ilk_link_socket_t second{};
  EXPECT_EQ(ilk_link_listen(&second, path.c_str(), &error), ILK_LISTEN_TAKEN);
  ilk_link_unlisten(&link);
}

TEST_F(LinkSocket, StaleSocketIsReplaced) {
  ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  close(link.descriptor);
  ASSERT_FALSE(connect_to(path));
  ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  EXPECT_TRUE(connect_to(path));
  ilk_link_unlisten(&link);
}

TEST_F(LinkSocket, FileThatIsNoSocketIsKept) {
  std::ofstream(path) << "precious";
  EXPECT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_FAILED);
  EXPECT_THAT(error.text, HasSubstr("is not a socket"));
  EXPECT_TRUE(std::filesystem::is_regular_file(path));
}

TEST_F(LinkSocket, IsForTheOwnerAloneAndRemovedAtTheEnd) {
  ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  struct stat status{};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  ilk_link_unlisten(&link);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(LinkSocket, AnothersSocketOfTheSameNameIsNotRemoved) {
  ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  std::filesystem::rename(path, directory.file("moved"));
  ilk_link_socket_t other{};
  ASSERT_EQ(ilk_link_listen(&other, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
  ilk_link_unlisten(&link);
  EXPECT_TRUE(connect_to(path));
  ilk_link_unlisten(&other);
}

TEST_F(LinkSocket, UnusablePathsAreNamed) {
  EXPECT_EQ(ilk_link_listen(&link, directory.file("no/such/link").c_str(), &error), ILK_LISTEN_FAILED);
  EXPECT_THAT(error.text, HasSubstr("create it first"));
  EXPECT_EQ(ilk_link_listen(&link, std::string(200, 'x').c_str(), &error), ILK_LISTEN_FAILED);
  EXPECT_THAT(error.text, HasSubstr("200 characters; expected 1 to 107"));
  EXPECT_EQ(ilk_link_listen(&link, "", &error), ILK_LISTEN_FAILED);
}

}  // namespace
