#include "motion/request_port.hpp"

#include <gtest/gtest.h>

#include <future>

#include "kernel_side.hpp"

namespace interlock {
namespace {

class RequestPortTest : public testing::Test {
 protected:
  RequestPortTest() {
    std::future<void> accepted = std::async(std::launch::async, [this] { kernel_.accept(); });
    EXPECT_TRUE(link_.attach(std::chrono::minutes(5)));
    accepted.get();
    port_.begin_tick();
  }

  test::KernelSide kernel_;
  LinkClient link_{kernel_.socket()};
  RequestPort port_{link_};
};

TEST_F(RequestPortTest, SendsNoMoreThanTheKernelReadsInATick) {
  std::uint32_t sent = 0;
  while (port_.send({}, HeartbeatOrigin{})) {
    ++sent;
  }
  EXPECT_EQ(sent, static_cast<std::uint32_t>(ILK_REQUESTS_PER_TICK));
  port_.begin_tick();
  EXPECT_TRUE(port_.send({}, HeartbeatOrigin{}));
}

TEST_F(RequestPortTest, FindsWhoAskedByTheSequenceNumber) {
  ASSERT_TRUE(port_.send({}, CallOrigin{7}));
  ASSERT_TRUE(port_.send({}, ModeOrigin{ILK_REQUEST_MOVE, 3, 9}));
  EXPECT_EQ(std::get<ModeOrigin>(*port_.settle(2)).task, 9u);
  EXPECT_EQ(std::get<CallOrigin>(*port_.settle(1)).call_id, 7u);
}

TEST_F(RequestPortTest, SettlesEachRequestOnce) {
  ASSERT_TRUE(port_.send({}, CallOrigin{7}));
  EXPECT_TRUE(port_.settle(1));
  EXPECT_FALSE(port_.settle(1));
  EXPECT_FALSE(port_.settle(0));
  EXPECT_FALSE(port_.settle(99));
}

TEST_F(RequestPortTest, AVerdictThatNeverComesDoesNotStopTheNextRequests) {
  ASSERT_TRUE(port_.send({}, CallOrigin{7}));
  for (std::uint32_t i = 0; i < 2 * ILK_LINK_REQUESTS; ++i) {
    (void)kernel_.take_request();
    port_.begin_tick();
    ASSERT_TRUE(port_.send({}, HeartbeatOrigin{}));
  }
  EXPECT_FALSE(port_.settle(1));
  EXPECT_TRUE(port_.settle(2));
}

TEST_F(RequestPortTest, HandsBackWhatWasLost) {
  ASSERT_TRUE(port_.send({}, CallOrigin{7}));
  ASSERT_TRUE(port_.send({}, HeartbeatOrigin{}));
  std::uint32_t lost = 0;
  port_.forget_all([&](const RequestOrigin&) { ++lost; });
  EXPECT_EQ(lost, 2u);
  EXPECT_FALSE(port_.settle(1));
}

}  // namespace
}  // namespace interlock
