#include "link/link_client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include "interlock/kernel.h"
#include "kernel_side.hpp"

namespace interlock {
namespace {

using std::chrono::milliseconds;
using test::KernelSide;
using testing::HasSubstr;

constexpr milliseconds timeout{300'000};
constexpr milliseconds at_once{0};

class LinkClientTest : public testing::Test {
 protected:
  tl::expected<void, LinkError> attach() {
    std::future<void> accepted = std::async(std::launch::async, [this] { kernel_.accept(); });
    auto attached = client_.attach(timeout);
    accepted.get();
    return attached;
  }

  static ilk_snapshot_t snapshot(std::uint32_t tick) {
    ilk_snapshot_t snapshot{};
    snapshot.state.system.tick = tick;
    snapshot.timing.max_ns[ILK_PHASE_COUNT - 1] = tick;
    return snapshot;
  }

  void expect_refused(LinkError::Kind kind, const std::string& text) {
    const auto attached = attach();
    ASSERT_FALSE(attached);
    EXPECT_EQ(attached.error().kind, kind);
    EXPECT_THAT(attached.error().message(), HasSubstr(text));
    EXPECT_FALSE(client_.attached());
  }

  KernelSide kernel_;
  LinkClient client_{kernel_.socket()};
};

TEST_F(LinkClientTest, AttachesToAKernelOfTheSameBuild) {
  ASSERT_TRUE(attach());
  EXPECT_TRUE(client_.attached());
  EXPECT_EQ(client_.generation(), 1u);
  EXPECT_EQ(kernel_.app().magic, ILK_LINK_MAGIC);
}

TEST_F(LinkClientTest, SaysWhereNobodyListens) {
  LinkClient nowhere("/nonexistent/link");
  const auto attached = nowhere.attach(at_once);
  ASSERT_FALSE(attached);
  EXPECT_EQ(attached.error().kind, LinkError::Kind::unreachable);
  EXPECT_THAT(attached.error().message(), HasSubstr("/nonexistent/link"));
}

TEST_F(LinkClientTest, RefusesAPathThatNoSocketCanHave) {
  EXPECT_EQ(LinkClient("").attach(at_once).error().kind, LinkError::Kind::broken);
  EXPECT_EQ(LinkClient(std::string(200, 'x')).attach(at_once).error().kind, LinkError::Kind::broken);
}

TEST_F(LinkClientTest, DoesNotWaitForeverForAHello) {
  const auto attached = client_.attach(milliseconds(1));
  ASSERT_FALSE(attached);
  EXPECT_EQ(attached.error().kind, LinkError::Kind::silent);
}

TEST_F(LinkClientTest, RefusesAnotherMagic) {
  kernel_.hello.magic ^= 1u;
  expect_refused(LinkError::Kind::broken, "0x4c4b4c49");
}

TEST_F(LinkClientTest, RefusesAnotherVersion) {
  kernel_.hello.version += 1;
  expect_refused(LinkError::Kind::incompatible, "version 2");
}

TEST_F(LinkClientTest, RefusesAnotherLayout) {
  kernel_.hello.layout_hash ^= 1u;
  expect_refused(LinkError::Kind::incompatible, "same build");
}

TEST_F(LinkClientTest, RefusesARegionThatIsTooSmall) {
  kernel_.hello.kernel_region_bytes -= 4;
  expect_refused(LinkError::Kind::broken, "expected at least");
}

TEST_F(LinkClientTest, RefusesARegionSmallerThanItsHelloSays) {
  kernel_.hello.app_region_bytes += 4;
  expect_refused(LinkError::Kind::broken, "the app's region has");
}

TEST_F(LinkClientTest, RefusesMemoryThatCouldShrinkUnderIt) {
  kernel_.seal = false;
  expect_refused(LinkError::Kind::broken, "shrinking");
}

TEST_F(LinkClientTest, RefusesAHelloWithoutBothDescriptors) {
  kernel_.descriptors = 1;
  expect_refused(LinkError::Kind::broken, "1 descriptors");
}

TEST_F(LinkClientTest, RefusesAHelloOfTheWrongLength) {
  kernel_.hello_bytes -= 4;
  expect_refused(LinkError::Kind::broken, "bytes");
}

TEST_F(LinkClientTest, HasNoSnapshotBeforeTheFirst) {
  ASSERT_TRUE(attach());
  ilk_snapshot_t seen{};
  EXPECT_FALSE(client_.read_snapshot(seen));
  EXPECT_EQ(client_.wait(at_once), LinkWait::timeout);
}

TEST_F(LinkClientTest, ReadsEachSnapshotOnce) {
  ASSERT_TRUE(attach());
  kernel_.publish(snapshot(7));
  EXPECT_EQ(client_.wait(timeout), LinkWait::snapshot);
  ilk_snapshot_t seen{};
  ASSERT_TRUE(client_.read_snapshot(seen));
  EXPECT_EQ(seen.state.system.tick, 7u);
  EXPECT_EQ(client_.wait(at_once), LinkWait::timeout);
}

TEST_F(LinkClientTest, WakesWhenASnapshotComes) {
  ASSERT_TRUE(attach());
  auto waiting = std::async(std::launch::async, [&] { return client_.wait(timeout); });
  kernel_.publish(snapshot(1));
  EXPECT_EQ(waiting.get(), LinkWait::snapshot);
}

TEST_F(LinkClientTest, NeverReadsASnapshotThatIsBeingWritten) {
  ASSERT_TRUE(attach());
  kernel_.publish(snapshot(1));
  kernel_.begin_write();
  ilk_snapshot_t seen{};
  EXPECT_FALSE(client_.read_snapshot(seen));
  kernel_.end_write();
  EXPECT_TRUE(client_.read_snapshot(seen));
}

TEST_F(LinkClientTest, NeverReadsHalfASnapshot) {
  constexpr std::uint32_t last = 20000;
  ASSERT_TRUE(attach());
  auto writing = std::async(std::launch::async, [&] {
    for (std::uint32_t tick = 1; tick <= last; ++tick) {
      kernel_.publish(snapshot(tick));
    }
  });
  ilk_snapshot_t seen{};
  while (seen.state.system.tick != last) {
    if (client_.read_snapshot(seen)) {
      ASSERT_EQ(seen.timing.max_ns[ILK_PHASE_COUNT - 1], seen.state.system.tick);
    }
  }
  writing.get();
}

TEST_F(LinkClientTest, NoticesThatTheKernelClosed) {
  ASSERT_TRUE(attach());
  kernel_.close();
  EXPECT_EQ(client_.wait(at_once), LinkWait::closed);
}

TEST_F(LinkClientTest, NoticesThatItsGenerationIsOver) {
  ASSERT_TRUE(attach());
  __atomic_store_n(&kernel_.kernel().generation, 2, __ATOMIC_RELAXED);
  EXPECT_EQ(client_.wait(at_once), LinkWait::closed);
}

TEST_F(LinkClientTest, AttachesAgainWithFreshNumbers) {
  ASSERT_TRUE(attach());
  EXPECT_EQ(client_.send({}), 1u);
  kernel_.push_event({0, ILK_EVENT_MODE, 1, {}});
  kernel_.close();
  ASSERT_TRUE(attach());
  EXPECT_EQ(client_.generation(), 2u);
  EXPECT_EQ(client_.send({}), 1u);
  ilk_event_t event{};
  EXPECT_FALSE(client_.read_event(event));
}

TEST_F(LinkClientTest, NumbersAndSealsRequests) {
  ASSERT_TRUE(attach());
  ilk_request_t move{};
  move.kind = ILK_REQUEST_MOVE;
  move.axis = 3;
  move.target_counts = -5;
  EXPECT_EQ(client_.send(move), 1u);
  EXPECT_EQ(client_.send(move), 2u);
  for (std::uint32_t sequence = 1; sequence <= 2; ++sequence) {
    const auto request = kernel_.take_request();
    ASSERT_TRUE(request);
    EXPECT_EQ(request->sequence, sequence);
    EXPECT_EQ(request->target_counts, -5);
    EXPECT_EQ(request->crc, ilk_request_crc(&*request));
  }
}

TEST_F(LinkClientTest, NeverOverwritesWhatTheKernelHasNotRead) {
  ASSERT_TRUE(attach());
  for (std::uint32_t i = 1; i <= ILK_LINK_REQUESTS; ++i) {
    EXPECT_EQ(client_.send({}), i);
  }
  EXPECT_EQ(client_.send({}), 0u);
  EXPECT_EQ(kernel_.take_request()->sequence, 1u);
  EXPECT_EQ(client_.send({}), ILK_LINK_REQUESTS + 1);
  EXPECT_EQ(client_.send({}), 0u);
}

TEST_F(LinkClientTest, ReadsEventsInOrder) {
  ASSERT_TRUE(attach());
  for (std::uint32_t tick = 1; tick <= 3; ++tick) {
    kernel_.push_event({0, ILK_EVENT_MODE, tick, {}});
  }
  ilk_event_t event{};
  for (std::uint32_t tick = 1; tick <= 3; ++tick) {
    ASSERT_TRUE(client_.read_event(event));
    EXPECT_EQ(event.tick, tick);
  }
  EXPECT_FALSE(client_.read_event(event));
  EXPECT_EQ(client_.events_lost(), 0u);
}

TEST_F(LinkClientTest, CountsEventsThatWereOverwritten) {
  ASSERT_TRUE(attach());
  for (std::uint32_t tick = 1; tick <= ILK_LINK_EVENTS + 5; ++tick) {
    kernel_.push_event({0, ILK_EVENT_MODE, tick, {}});
  }
  ilk_event_t event{};
  ASSERT_TRUE(client_.read_event(event));
  EXPECT_EQ(event.tick, 6u);
  EXPECT_EQ(client_.events_lost(), 5u);
}

TEST_F(LinkClientTest, TellsTheKernelWhichTickItHandled) {
  ASSERT_TRUE(attach());
  client_.publish_seen(42);
  EXPECT_EQ(kernel_.app().seen_tick, 42u);
}

TEST_F(LinkClientTest, DoesNothingWithoutAKernel) {
  ilk_snapshot_t seen{};
  ilk_event_t event{};
  EXPECT_EQ(client_.wait(at_once), LinkWait::closed);
  EXPECT_FALSE(client_.read_snapshot(seen));
  EXPECT_FALSE(client_.read_event(event));
  EXPECT_EQ(client_.send({}), 0u);
  client_.publish_seen(1);
  client_.detach();
}

}  // namespace
}  // namespace interlock
