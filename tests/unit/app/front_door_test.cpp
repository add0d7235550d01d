#include "http/front_door.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "system/launch.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::size_t capacity = 3;

/** A door behind which nobody is: whom it lets in, and what it would record, lies there. */
class FrontDoorTest : public testing::Test {
 protected:
  FrontDoorTest() {
    EXPECT_TRUE(door_.listen({"127.0.0.1", 0}));
    launch(context_.get_executor(), door_.accept());
    launch(context_.get_executor(), door_.heartbeat());
    launch(context_.get_executor(), door_.listen_to_control());
    thread_ = std::jthread([this] { context_.run(); });
  }

  ~FrontDoorTest() override {
    context_.stop();
    thread_.join();
  }

  tcp::socket connect() {
    tcp::socket socket(clients_);
    socket.connect({asio::ip::make_address("127.0.0.1"), door_.port()});
    return socket;
  }

  void send(tcp::socket& socket, const std::string& first_line) {
    asio::write(socket, asio::buffer(first_line + " HTTP/1.1\r\nHost: 127.0.0.1:" +
                                     std::to_string(door_.port()) + "\r\nContent-Length: 0\r\n\r\n"));
  }

  static std::string answer_of(tcp::socket& socket) {
    std::string answer;
    boost::system::error_code error;
    asio::read_until(socket, asio::dynamic_buffer(answer), "}", error);
    return answer;
  }

  template <typename Work>
  auto in_door(Work work) {
    std::packaged_task<decltype(work())()> task(work);
    auto result = task.get_future();
    asio::post(context_, [&] { task(); });
    return result.get();
  }

  /** Waits for the next one that the door lets in. */
  Guest next_guest() {
    while (in_door([&] { return guests_.empty(); })) {
      std::this_thread::yield();
    }
    return in_door([&] {
      Guest guest = std::move(guests_.front());
      guests_.erase(guests_.begin());
      return guest;
    });
  }

  asio::io_context context_{1};
  asio::io_context clients_{1};
  std::unique_ptr<RealtimeChannel> channel_ = std::make_unique<RealtimeChannel>();
  std::vector<Guest> guests_;
  std::vector<StopMade> made_;
  FrontDoor door_{context_.get_executor(), *channel_, capacity,
                  [this](Guest guest) { guests_.push_back(std::move(guest)); },
                  [this](StopMade made) { made_.push_back(std::move(made)); }};
  std::jthread thread_;
};

TEST_F(FrontDoorTest, AStopIsSentAndAnsweredThoughNobodyIsBehindTheDoor) {
  tcp::socket client = connect();
  send(client, "POST /api/stop");
  EXPECT_NE(answer_of(client).find("200 OK"), std::string::npos);
  EXPECT_EQ(channel_->stops.load(), 1u);
  send(client, "POST /api/stop");
  EXPECT_NE(answer_of(client).find("200 OK"), std::string::npos) << "on the same connection";
  EXPECT_EQ(channel_->stops.load(), 2u);
  EXPECT_EQ(in_door([&] { return made_.size(); }), 2u);
}

TEST_F(FrontDoorTest, TheKernelsVerdictIsTheAnswer) {
  tcp::socket client = connect();
  send(client, "POST /api/stop");
  while (channel_->stops.load() == 0) {
    std::this_thread::yield();
  }
  in_door([&] { return 0; });
  channel_->stopped.writing() = {1, ILK_VERDICT_ACCEPTED, 77};
  channel_->stopped.publish();
  channel_->door_wake.signal();
  const std::string answer = answer_of(client);
  EXPECT_NE(answer.find(R"("tick":77)"), std::string::npos) << answer;
  EXPECT_NE(answer.find(R"("verdict":"ACCEPTED")"), std::string::npos) << answer;
}

TEST_F(FrontDoorTest, WhatIsNoStopIsLetInWhole) {
  for (const char* line : {"GET /api/status", "POST /api/stopped", "POST /api/sto"}) {
    tcp::socket client = connect();
    send(client, line);
    Guest guest = next_guest();
    tcp::socket inside(clients_, guest.protocol, guest.socket.release());
    std::string request;
    asio::read_until(inside, asio::dynamic_buffer(request), "\r\n\r\n");
    EXPECT_TRUE(request.starts_with(line)) << request;
  }
  EXPECT_EQ(channel_->stops.load(), 0u);
}

TEST_F(FrontDoorTest, AConnectionThatHadAnotherAnswerComesBackAndMayStop) {
  tcp::socket client = connect();
  send(client, "GET /api/status");
  Guest guest = next_guest();
  tcp::socket inside(clients_, guest.protocol, guest.socket.release());
  std::string request;
  asio::read_until(inside, asio::dynamic_buffer(request), "\r\n\r\n");
  door_.come_back({FileDescriptor(inside.release()), guest.protocol, guest.peer, false, {}});
  send(client, "POST /api/stop");
  EXPECT_NE(answer_of(client).find("200 OK"), std::string::npos);
}

TEST_F(FrontDoorTest, StopsThatNobodyRecordsAreCountedAndToldWithTheNextThatIsRecorded) {
  constexpr std::uint32_t beyond = 6;
  std::vector<tcp::socket> clients;
  for (std::uint32_t i = 0; i < FrontDoor::most_unrecorded + beyond; ++i) {
    clients.push_back(connect());
    send(clients.back(), "POST /api/stop");
  }
  for (tcp::socket& each : clients) {
    EXPECT_NE(answer_of(each).find("200 OK"), std::string::npos);
  }
  EXPECT_EQ(channel_->stops.load(), FrontDoor::most_unrecorded + beyond) << "each is sent";
  EXPECT_EQ(in_door([&] { return made_.size(); }), FrontDoor::most_unrecorded);
  door_.recorded();
  tcp::socket client = connect();
  send(client, "POST /api/stop");
  EXPECT_NE(answer_of(client).find("200 OK"), std::string::npos);
  EXPECT_EQ(in_door([&] { return made_.back().unrecorded; }), beyond);
}

TEST_F(FrontDoorTest, WhoeverHasWaitedLongestMakesRoom) {
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < capacity + 1; ++i) {
    idle.push_back(connect());
  }
  EXPECT_EQ(answer_of(idle.front()), "") << "closed";
  send(idle.back(), "POST /api/stop");
  EXPECT_NE(answer_of(idle.back()).find("200 OK"), std::string::npos);
}

TEST_F(FrontDoorTest, NobodyWhoseRequestIsThereMakesRoom) {
  std::vector<tcp::socket> idle;
  for (std::size_t i = 0; i < capacity; ++i) {
    idle.push_back(connect());
  }
  while (in_door([&] { return door_.waiting(); }) < capacity) {
    std::this_thread::yield();
  }
  tcp::socket late = in_door([&] {
    tcp::socket connected = connect();
    send(idle.front(), "POST /api/stop");
    return connected;
  });
  EXPECT_NE(answer_of(idle.front()).find("200 OK"), std::string::npos);
  EXPECT_EQ(answer_of(idle[1]), "") << "closed";
}

TEST_F(FrontDoorTest, StrangersMakeRoomForThoseWhoWereLoggedIn) {
  tcp::socket known = connect();
  send(known, "GET /api/motors");
  Guest guest = next_guest();
  tcp::socket inside(clients_, guest.protocol, guest.socket.release());
  std::string request;
  asio::read_until(inside, asio::dynamic_buffer(request), "\r\n\r\n");
  door_.come_back({FileDescriptor(inside.release()), guest.protocol, guest.peer, true, {}});
  std::vector<tcp::socket> strangers;
  for (std::size_t i = 0; i < 2 * capacity; ++i) {
    strangers.push_back(connect());
  }
  EXPECT_EQ(answer_of(strangers.front()), "") << "closed";
  send(known, "POST /api/stop");
  EXPECT_NE(answer_of(known).find("200 OK"), std::string::npos);
}

TEST_F(FrontDoorTest, WhatIsFoundAfterALongPauseCameNoLaterThanThePauseBegan) {
  constexpr std::chrono::milliseconds pause{600};
  tcp::socket client = connect();
  const auto ended = in_door([&] {
    send(client, "GET /api/status");
    std::this_thread::sleep_for(pause);
    return std::chrono::steady_clock::now();
  });
  EXPECT_LE(next_guest().came, ended - pause);
}

TEST_F(FrontDoorTest, AStopWhoseBodyIsNotThereYetIsAnsweredAtOnce) {
  tcp::socket client = connect();
  asio::write(client, asio::buffer("POST /api/stop HTTP/1.1\r\nHost: 127.0.0.1:" +
                                   std::to_string(door_.port()) + "\r\nContent-Length: 9\r\n\r\n"));
  EXPECT_NE(answer_of(client).find("200 OK"), std::string::npos);
}

TEST_F(FrontDoorTest, ShowsThatItIsKept) {
  const std::uint32_t before = channel_->door_kept.load();
  while (channel_->door_kept.load() == before) {
    std::this_thread::yield();
  }
}

}  // namespace
}  // namespace interlock::web
