#include "igtl/stop_scout.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <memory>
#include <vector>

#include "igtl/codec.hpp"
#include "igtl/frame.hpp"
#include "system/file_descriptor.hpp"

namespace interlock::igtl {
namespace {

ByteVector text(std::string_view name, const std::string& content) {
  return write_frame(2, "STRING", name, 0, encode(Text{content}));
}

ByteVector joined(const std::vector<ByteVector>& parts) {
  ByteVector all;
  for (const ByteVector& each : parts) {
    all.insert(all.end(), each.begin(), each.end());
  }
  return all;
}

TEST(StopsIn, EveryWayToAskForAStopCountsWhereverItBegins) {
  const ByteVector pose = write_frame(1, "TRANSFORM", "CURRENT_POSE", 0, encode(Transform{}));
  EXPECT_EQ(stops_in(joined({pose, pose})), 0u);
  const std::vector<ByteVector> stops{text("STOP", ""),
                                      write_frame(1, "STATUS", "stop", 0, encode(Status{})),
                                      write_frame(2, "WORD", "EMERGENCY", 0, ByteVector(8, 1)),
                                      text("MODE", "stop"),
                                      text("state_command", "pause"),
                                      text("arm/state_command", "pause"),
                                      text("CMD_17", "STOP"),
                                      text("CMD_0003", "EMERGENCY")};
  for (const ByteVector& stop : stops) {
    EXPECT_EQ(stops_in(joined({pose, stop, pose})), 1u);
    const ByteVector late(pose.begin() + 7, pose.end());  // whose beginning was read already
    EXPECT_EQ(stops_in(joined({late, stop, stop})), 2u);
  }
  EXPECT_EQ(stops_in(joined(stops)), stops.size());
}

TEST(StopsIn, WhatIsNoStopOrHasNotComeYetDoesNotCount) {
  const ByteVector mode = text("MODE", "stop");
  for (const ByteVector& other : {text("NOTE", "stop"), text("MODE", "draping"), text("STOPPED", ""),
                                  text("CMD_1", "STOP_NOT"), ByteVector(mode.begin(), mode.end() - 1),
                                  ByteVector(mode.begin(), mode.begin() + header_bytes - 1), ByteVector{}}) {
    EXPECT_EQ(stops_in(other), 0u);
  }
  ByteVector spoiled = mode;
  spoiled.back() ^= 1u;
  EXPECT_EQ(stops_in(spoiled), 0u) << "its checksum is wrong";
}

/** A connection whose reader is the test. */
class StopScoutTest : public testing::Test {
 protected:
  StopScoutTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    program_ = FileDescriptor(ends[0]);
    app_ = FileDescriptor(ends[1]);
    scout_.watch(app_.get(), connection_);
  }

  void send(const ByteVector& bytes) {
    EXPECT_EQ(::send(program_.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  }

  void read_all() {
    ByteVector bytes(StopScout::reach);
    while (::recv(app_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
    }
  }

  /** Lets the scout look at what is unread, more than once. */
  void look() {
    const auto end = std::chrono::steady_clock::now() + 4 * StopScout::time_to_read;
    while (std::chrono::steady_clock::now() < end) {
      door_.run_one_for(StopScout::time_to_read);
    }
  }

  void wait_for_stops(int count) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (stops_ < count && std::chrono::steady_clock::now() < end) {
      door_.run_one_for(StopScout::time_to_read);
    }
    ASSERT_EQ(stops_, count);
  }

  boost::asio::io_context door_;
  int stops_ = 0;
  StopScout scout_{door_.get_executor(), [this] { ++stops_; }};
  FileDescriptor program_;
  FileDescriptor app_;
  std::shared_ptr<int> connection_ = std::make_shared<int>();
};

TEST_F(StopScoutTest, AStopThatNobodyReadsIsCarriedOutOnce) {
  const ByteVector query = write_frame(1, "GET_STATUS", "", 0, {});
  for (int i = 0; i < 200; ++i) {
    send(query);
  }
  look();
  EXPECT_EQ(stops_, 0);
  send(text("STOP", ""));
  wait_for_stops(1);
  look();
  EXPECT_EQ(stops_, 1) << "it still waits there";
  send(text("CMD_1", "STOP"));
  wait_for_stops(2);
  read_all();
  look();
  EXPECT_EQ(stops_, 2);
}

TEST_F(StopScoutTest, ItEndsWithTheConnectionAndHoldsNoSocketThen) {
  connection_.reset();
  send(text("STOP", ""));
  door_.run();
  EXPECT_EQ(stops_, 0) << "nobody is connected";
  app_ = FileDescriptor();
  EXPECT_LT(::send(program_.get(), "x", 1, MSG_NOSIGNAL), 0) << "nobody holds the other end";
}

TEST_F(StopScoutTest, ItEndsWhenTheProgramGoes) {
  program_ = FileDescriptor();
  door_.run();
  EXPECT_EQ(stops_, 0);
}

}  // namespace
}  // namespace interlock::igtl
