#include "link_server.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include <memory>
#include <string>

#include "fixtures.hpp"
#include "link_socket.h"

namespace {

using interlock::host_test::App;
using interlock::host_test::eventually;
using interlock::host_test::TemporaryDirectory;

bool is_closed(const App& app) {
  pollfd wanted{app.socket.get(), POLLIN, 0};
  return poll(&wanted, 1, 10'000) == 1;
}

/// The server thread, with this test in the loop's place.
class LinkServer : public ::testing::Test {
 protected:
  void SetUp() override {
    ilk_error_t error{};
    ASSERT_EQ(ilk_link_listen(&link, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
    ASSERT_TRUE(ilk_link_server_start(&server, link.descriptor, &error)) << error.text;
  }
  void TearDown() override {
    ilk_link_server_stop(&server, current);
    ilk_link_unlisten(&link);
  }

  void tick() { current = ilk_mailbox_exchange(&server.mailbox, current); }
  bool serves(uint32_t generation) {
    tick();
    return current != nullptr && current->generation == generation;
  }
  bool serves_nobody() {
    tick();
    return current == nullptr;
  }

  TemporaryDirectory directory;
  std::string path = directory.file("link");
  ilk_link_socket_t link{};
  ilk_link_server_t server{};
  ilk_attachment_t* current = nullptr;
};

TEST_F(LinkServer, AppGetsHelloAndBothRegions) {
  const auto app = App::attach(path);
  ASSERT_TRUE(app);
  EXPECT_EQ(app->hello.magic, ILK_LINK_MAGIC);
  EXPECT_EQ(app->hello.version, ILK_LINK_VERSION);
  EXPECT_EQ(app->hello.layout_hash, ilk_link_layout_hash());
  EXPECT_EQ(app->hello.kernel_region_bytes, sizeof(ilk_link_kernel_region_t));
  EXPECT_EQ(app->hello.app_region_bytes, sizeof(ilk_link_app_region_t));
  ASSERT_NE(app->kernel, nullptr);
  ASSERT_NE(app->app, nullptr);
  EXPECT_EQ(app->kernel->generation, app->hello.generation);
  ASSERT_TRUE(eventually([&] { return serves(1); }));
  current->regions.kernel->request_tail = 99;
  EXPECT_EQ(app->kernel->request_tail, 99u);
  app->app->request_head = 5;
  EXPECT_EQ(current->regions.app->request_head, 5u);
}

TEST_F(LinkServer, AppCannotMapTheKernelsRegionWritable) {
  const auto app = App::attach(path);
  ASSERT_TRUE(app);
  EXPECT_EQ(mmap(nullptr, sizeof *app->kernel, PROT_READ | PROT_WRITE, MAP_SHARED,
                 app->kernel_region_descriptor.get(), 0),
            MAP_FAILED);
}

TEST_F(LinkServer, EachAttachmentIsAFreshGeneration) {
  for (uint32_t generation = 1; generation <= 20; ++generation) {
    std::unique_ptr<App> app;
    ASSERT_TRUE(eventually([&] { return (app = App::attach(path)) != nullptr; }));
    EXPECT_EQ(app->hello.generation, generation);
    EXPECT_EQ(app->app->request_head, 0u);
    EXPECT_EQ(app->kernel->request_tail, 0u);
    EXPECT_EQ(app->kernel->snapshot_lock, 0u);
    ASSERT_TRUE(eventually([&] { return serves(generation); }));
    app->app->request_head = 3;
    current->regions.kernel->request_tail = 2;
  }
  EXPECT_TRUE(eventually([&] { return serves_nobody(); }));
}

TEST_F(LinkServer, AttachmentsThatTheLoopNeverTookDoNotPileUp) {
  for (uint32_t generation = 1; generation <= 50; ++generation) {
    std::unique_ptr<App> app;
    ASSERT_TRUE(eventually([&] { return (app = App::attach(path)) != nullptr; }));
    EXPECT_EQ(app->hello.generation, generation);
  }
  EXPECT_TRUE(eventually([&] { return serves(50) || serves_nobody(); }));
}

TEST_F(LinkServer, SecondAppIsTurnedAwayAndTheFirstKeepsItsLink) {
  const auto first = App::attach(path);
  ASSERT_TRUE(first);
  EXPECT_FALSE(App::attach(path));
  ASSERT_TRUE(eventually([&] { return serves(1); }));
  EXPECT_TRUE(ilk_attachment_is_open(current));
}

TEST_F(LinkServer, AppThatSendsOnTheSocketIsDetached) {
  const auto app = App::attach(path);
  ASSERT_TRUE(app);
  ASSERT_EQ(send(app->socket.get(), "x", 1, MSG_NOSIGNAL), 1);
  EXPECT_TRUE(is_closed(*app));
  EXPECT_TRUE(eventually([&] { return serves_nobody(); }));
}

TEST_F(LinkServer, AppThatSaysAnythingElseThanThatItMappedIsNotServed) {
  const auto app = App::attach(path, 0);
  ASSERT_TRUE(app);
  EXPECT_TRUE(is_closed(*app));
  EXPECT_TRUE(serves_nobody());
}

TEST_F(LinkServer, ClosedAttachmentIsNotServedEvenBeforeItIsCollected) {
  std::unique_ptr<App> app = App::attach(path);
  ASSERT_TRUE(app);
  ASSERT_TRUE(eventually([&] { return serves(1); }));
  app.reset();
  EXPECT_TRUE(eventually([&] { return !ilk_attachment_is_open(current); }));
}

TEST(LinkMailbox, ChangeWaitsWhileTheLastOneIsUncollected) {
  ilk_attachment_t old{};
  ilk_attachment_t fresh{};
  ilk_attachment_t uncollected{};
  fresh.open = 1;
  ilk_link_mailbox_t mailbox{&fresh, &uncollected};
  EXPECT_EQ(ilk_mailbox_exchange(&mailbox, &old), &old);
  EXPECT_FALSE(ilk_attachment_is_open(&old));
  mailbox.retired = nullptr;
  EXPECT_EQ(ilk_mailbox_exchange(&mailbox, &old), &fresh);
  EXPECT_EQ(mailbox.retired, &old);
}

}  // namespace
