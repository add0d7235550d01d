#include "bus_sim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "fixtures.hpp"
#include "link_socket.h"

namespace {

using interlock::host_test::Descriptor;
using interlock::host_test::eventually;
using interlock::host_test::one_axis_config;
using interlock::host_test::TemporaryDirectory;
using ::testing::HasSubstr;

enum class Manner { kAnswer, kFail, kSilent, kLate, kWrongTick, kShort };

/// The far end of the bus: answers hellos and exchanges in the manner that the test chooses.
class Peer {
 public:
  explicit Peer(const std::string& path, std::function<void(ilk_sim_hello_t&)> spoil_hello = {})
      : spoil_hello_(std::move(spoil_hello)), stop_(eventfd(0, EFD_CLOEXEC)) {
    ilk_error_t error{};
    EXPECT_EQ(ilk_link_listen(&socket_, path.c_str(), &error), ILK_LISTEN_OK) << error.text;
    thread_ = std::thread([this] { serve(); });
  }
  ~Peer() {
    eventfd_write(stop_.get(), 1);
    thread_.join();
    ilk_link_unlisten(&socket_);
  }

  std::atomic<Manner> manner{Manner::kAnswer};
  std::atomic<uint32_t> exchanges{0};
  std::atomic<uint32_t> last_tick{0};

 private:
  void serve() {
    Descriptor client;
    for (;;) {
      pollfd wanted[]{{stop_.get(), POLLIN, 0}, {socket_.descriptor, POLLIN, 0}, {client.get(), POLLIN, 0}};
      poll(wanted, 3, -1);
      if (wanted[0].revents != 0) {
        return;
      }
      if (wanted[1].revents != 0) {
        client = Descriptor(accept4(socket_.descriptor, nullptr, nullptr, SOCK_CLOEXEC));
        greet(client.get());
      } else if (wanted[2].revents != 0 && !answer(client.get())) {
        client.reset();
      }
    }
  }

  void greet(int client) {
    ilk_sim_hello_t hello{};
    recv(client, &hello, sizeof hello, 0);
    if (spoil_hello_) {
      spoil_hello_(hello);
    }
    send(client, &hello, sizeof hello, MSG_NOSIGNAL);
  }

  bool answer(int client) {
    ilk_sim_exchange_t exchange{};
    if (recv(client, &exchange, sizeof exchange, 0) != static_cast<ssize_t>(sizeof exchange)) {
      return false;
    }
    exchanges += 1;
    last_tick = exchange.tick;
    while (manner == Manner::kLate) {
      std::this_thread::yield();
    }
    ilk_sim_reply_t reply{};
    reply.magic = manner == Manner::kFail ? ILK_SIM_FAILED : ILK_SIM_MAGIC;
    reply.tick = exchange.tick + (manner == Manner::kWrongTick ? 1 : 0);
    reply.frames_received = 0x3FF;
    reply.pedal_no_closed = 1;
    reply.estop_loop_closed = 1;
    reply.frame[9][31] = exchange.frame[9][31];
    const size_t bytes = manner == Manner::kShort ? sizeof reply - 4 : sizeof reply;
    return manner == Manner::kSilent ||
           send(client, &reply, bytes, MSG_NOSIGNAL) == static_cast<ssize_t>(bytes);
  }

  std::function<void(ilk_sim_hello_t&)> spoil_hello_;
  Descriptor stop_;
  ilk_link_socket_t socket_{};
  std::thread thread_;
};

class SimulatedBus : public ::testing::Test {
 protected:
  void open(ilk_clock_t clock = ILK_CLOCK_SIM) {
    ilk_error_t error{};
    ASSERT_TRUE(ilk_bus_sim_open(&sim, path.c_str(), clock, &config, &stopped, &error)) << error.text;
    bus = ilk_bus_sim_driver(&sim);
  }
  std::string refusal() {
    ilk_error_t error{};
    EXPECT_FALSE(ilk_bus_sim_open(&sim, path.c_str(), ILK_CLOCK_SIM, &config, &stopped, &error));
    return error.text;
  }
  bool transact() { return bus.transact(bus.driver, ++tick, &out, &in); }
  bool succeeds() {
    transact();
    return in.transaction_done == 1;
  }

  TemporaryDirectory directory;
  std::string path = directory.file("bus");
  ilk_config_t config = one_axis_config();
  volatile sig_atomic_t stopped = 0;
  ilk_bus_sim_t sim{};
  ilk_bus_t bus{};
  ilk_outputs_t out{};
  ilk_inputs_t in{};
  uint32_t tick = 0;
};

TEST_F(SimulatedBus, TransactionBringsFramesAndContacts) {
  Peer peer(path);
  open();
  out.frame[9][31] = 0xABCD;
  EXPECT_TRUE(transact());
  EXPECT_EQ(in.transaction_done, 1u);
  EXPECT_EQ(in.frames_received, 0x3FFu);
  EXPECT_EQ(in.pedal_no_closed, 1u);
  EXPECT_EQ(in.pedal_nc_closed, 0u);
  EXPECT_EQ(in.estop_loop_closed, 1u);
  EXPECT_EQ(in.frame[9][31], 0xABCDu);
  EXPECT_EQ(peer.last_tick, tick);
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, FailedTransactionHasNoFramesAndKeepsTheContacts) {
  Peer peer(path);
  open();
  ASSERT_TRUE(succeeds());
  for (const Manner manner : {Manner::kFail, Manner::kWrongTick, Manner::kShort}) {
    peer.manner = manner;
    EXPECT_TRUE(transact());
    EXPECT_EQ(in.transaction_done, 0u);
    EXPECT_EQ(in.frames_received, 0u);
    EXPECT_EQ(in.estop_loop_closed, 1u);
    peer.manner = Manner::kAnswer;
    EXPECT_TRUE(succeeds());
  }
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, SilentPlantGetsNoSecondExchange) {
  Peer peer(path);
  open(ILK_CLOCK_REAL);
  peer.manner = Manner::kSilent;
  for (int n = 0; n < 5; ++n) {
    transact();
    EXPECT_EQ(in.transaction_done, 0u);
  }
  EXPECT_TRUE(eventually([&] { return peer.exchanges == 1; }));
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, SimulatedTimeWaitsForALatePlant) {
  Peer peer(path);
  open();
  peer.manner = Manner::kLate;
  std::thread plant([&] {
    ASSERT_TRUE(eventually([&] { return peer.exchanges == 1; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    peer.manner = Manner::kAnswer;
  });
  EXPECT_TRUE(succeeds());
  plant.join();
  EXPECT_EQ(peer.exchanges, 1u);
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, StopEndsTheWaitForALatePlant) {
  Peer peer(path);
  open();
  peer.manner = Manner::kSilent;
  // As in the kernel: by the handler of a signal, in the thread that waits.
  static volatile sig_atomic_t* flag = nullptr;
  flag = &stopped;
  std::signal(SIGUSR1, [](int) { *flag = 1; });
  const pthread_t loop = pthread_self();
  std::thread user([&] {
    EXPECT_TRUE(eventually([&] { return peer.exchanges == 1; }));
    pthread_kill(loop, SIGUSR1);
  });
  EXPECT_FALSE(succeeds());
  user.join();
  std::signal(SIGUSR1, SIG_DFL);
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, PlantThatDiesDuringTheWaitIsLostAtOnceAndItsSuccessorServes) {
  std::optional<Peer> peer(std::in_place, path);
  open();
  peer->manner = Manner::kSilent;
  std::thread plant([&] {
    EXPECT_TRUE(eventually([&] { return peer->exchanges == 1; }));
    peer.emplace(path);
  });
  EXPECT_FALSE(transact());
  EXPECT_EQ(in.transaction_done, 0u);
  plant.join();
  EXPECT_TRUE(eventually([&] { return succeeds(); }));
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, DeadPlantFailsEachTransactionAndFramesFlowWhenItReturns) {
  std::optional<Peer> peer(std::in_place, path);
  open();
  for (int life = 0; life < 3; ++life) {
    ASSERT_TRUE(eventually([&] { return succeeds(); }));
    peer.reset();
    EXPECT_TRUE(eventually([&] { return !transact(); }));
    EXPECT_EQ(in.transaction_done, 0u);
    EXPECT_EQ(in.frames_received, 0u);
    peer.emplace(path);
  }
  ASSERT_TRUE(eventually([&] { return succeeds(); }));
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, PlantThatDiedOwingAReplyIsForgiven) {
  std::optional<Peer> peer(std::in_place, path);
  open(ILK_CLOCK_REAL);
  peer->manner = Manner::kSilent;
  transact();
  peer.emplace(path);
  EXPECT_TRUE(eventually([&] { return succeeds(); }));
  ilk_bus_sim_close(&sim);
}

TEST_F(SimulatedBus, PlantThatIsNotThereIsNamed) {
  EXPECT_THAT(refusal(), HasSubstr(path));
  path = std::string(150, 'b');
  EXPECT_THAT(refusal(), HasSubstr("150 characters; expected 1 to 107"));
}

TEST_F(SimulatedBus, PlantOnOtherTermsIsRefusedWithBothOfThem) {
  const auto refused = [&](std::function<void(ilk_sim_hello_t&)> spoil) {
    Peer peer(path, std::move(spoil));
    return refusal();
  };
  EXPECT_THAT(refused([](auto& hello) { hello.version = 9; }), HasSubstr("version 9"));
  EXPECT_THAT(refused([](auto& hello) { hello.magic = 0; }), HasSubstr("magic 0x00000000"));
  EXPECT_THAT(refused([](auto& hello) { hello.frame_words += 32; }), HasSubstr("words; expected"));
  EXPECT_THAT(refused([](auto& hello) { hello.period_us = 500; }), HasSubstr("500 us"));
  EXPECT_THAT(refused([](auto& hello) { hello.clock = ILK_CLOCK_REAL; }), HasSubstr("clock 0"));
}

}  // namespace
