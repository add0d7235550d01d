#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench.hpp"
#include "plant/sim/file_descriptor.hpp"
#include "temporary_folder.hpp"

extern char** environ;

namespace interlock::plant::test {
namespace {

using nlohmann::json;
using sim::FileDescriptor;
using ::testing::HasSubstr;

constexpr const char* kPlant = R"([[axis]]
slot = 0
name = "a"
start_from_switch_counts = 300
[[axis]]
slot = 2
name = "b"
start_counts = 0
[[axis]]
slot = 3
name = "c"
start_from_switch_counts = 300
[[axis]]
slot = 4
name = "d"
start_counts = 0
[[axis]]
slot = 5
name = "e"
start_counts = 0
)";

/** interlock-sim as a child, its output in pipes. */
class Child {
 public:
  explicit Child(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), INTERLOCK_SIM);
    std::vector<char*> argv;
    for (std::string& argument : arguments) {
      argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    int out[2];
    int err[2];
    EXPECT_EQ(::pipe2(out, O_CLOEXEC), 0);
    EXPECT_EQ(::pipe2(err, O_CLOEXEC), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    EXPECT_EQ(::posix_spawn(&pid_, INTERLOCK_SIM, &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    ::close(out[1]);
    ::close(err[1]);
    out_ = FileDescriptor(out[0]);
    err_ = FileDescriptor(err[0]);
  }

  ~Child() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }

  std::string first_line() { return read_until(out_, '\n'); }
  std::string error_text() { return read_until(err_, '\0'); }

  void signal(int number) const { ::kill(pid_, number); }

  int exit_code() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  static std::string read_until(const FileDescriptor& pipe, char end) {
    std::string text;
    char letter;
    while (::read(pipe.get(), &letter, 1) == 1 && letter != end) {
      text += letter;
    }
    return text;
  }

  pid_t pid_ = -1;
  FileDescriptor out_;
  FileDescriptor err_;
};

FileDescriptor connect_to(const std::filesystem::path& path, int type) {
  FileDescriptor socket(::socket(AF_UNIX, type | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return socket;
}

/** The control socket, a line each way. */
class Control {
 public:
  explicit Control(const std::filesystem::path& path) : socket_(connect_to(path, SOCK_STREAM)) {}

  void send(const std::string& text) const {
    EXPECT_EQ(::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }

  json answer() {
    std::size_t end = 0;
    while ((end = received_.find('\n')) == std::string::npos) {
      char buffer[65536];
      const ssize_t count = ::recv(socket_.get(), buffer, sizeof buffer, 0);
      if (count <= 0) {
        return nullptr;
      }
      received_.append(buffer, static_cast<std::size_t>(count));
    }
    const json parsed = json::parse(received_.substr(0, end));
    received_.erase(0, end + 1);
    return parsed;
  }

  json ask(const std::string& line) {
    send(line + "\n");
    return answer();
  }

  void end_sending() const { ::shutdown(socket_.get(), SHUT_WR); }

 private:
  FileDescriptor socket_;
  std::string received_;
};

/** The kernel's end of the bus: frames without drive, or as the test fills them. */
class Kernel {
 public:
  Kernel(const std::filesystem::path& path, ilk_clock_t clock) : socket_(connect_to(path, SOCK_SEQPACKET)) {
    const ilk_sim_hello_t hello{ILK_SIM_MAGIC, ILK_SIM_VERSION, ILK_FRAME_WORDS, 1000, clock, 0};
    ::send(socket_.get(), &hello, sizeof hello, MSG_NOSIGNAL);
    attached = ::recv(socket_.get(), &answer, sizeof answer, 0) == sizeof answer;
    exchange.magic = ILK_SIM_MAGIC;
    exchange.power = 1;
  }

  /** One exchange; false when the plant closed the bus. */
  bool tick() {
    for (auto& frame : exchange.frame) {
      frame[0] = 0xFEFEFE01u;
      frame[13] = exchange.tick;
      frame[ILK_FRAME_WORDS - 1] = 0;
      frame[ILK_FRAME_WORDS - 1] = wire::checksum(wire::FrameView(frame));
    }
    ::send(socket_.get(), &exchange, sizeof exchange, MSG_NOSIGNAL);
    ++exchange.tick;
    return ::recv(socket_.get(), &reply, sizeof reply, 0) == sizeof reply;
  }

  void run(int ticks) {
    for (int n = 0; n < ticks; ++n) {
      ASSERT_TRUE(tick());
    }
  }

  void send_raw(const void* record, std::size_t bytes) const {
    ::send(socket_.get(), record, bytes, MSG_NOSIGNAL);
  }
  bool is_closed_by_plant() const {
    char byte;
    return ::recv(socket_.get(), &byte, 1, 0) <= 0;
  }

  ilk_sim_hello_t answer{};
  ilk_sim_exchange_t exchange{};
  ilk_sim_reply_t reply{};
  bool attached = false;

 private:
  FileDescriptor socket_;
};

/** Asks until the plant, which runs on by itself, has dropped the amplifier of the first card. */
json status_once_amplifier_is_off(Control& control) {
  for (;;) {
    const json status = control.ask(R"({"command":"status"})");
    if (status["cards"][0]["amplifier"] == false) {
      return status;
    }
  }
}

class InterlockSim : public ::testing::Test {
 protected:
  InterlockSim() {
    write_robot(sample_robot(), folder_ / "r.ilkc");
    folder_.write("p.toml", kPlant);
  }

  std::vector<std::string> arguments() const {
    return {"--plant", folder_ / "p.toml", "--robot", folder_ / "r.ilkc", "--bus",
            bus_,      "--control",        control_};
  }

  TemporaryFolder folder_;
  std::filesystem::path bus_ = folder_ / "bus";
  std::filesystem::path control_ = folder_ / "control";
};

TEST_F(InterlockSim, SaysReadyServesAndRemovesItsSocketsOnSignal) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Child child(arguments());
    EXPECT_EQ(child.first_line(), "ready bus=" + bus_.string() + " control=" + control_.string());
    EXPECT_TRUE(std::filesystem::is_socket(bus_));
    child.signal(signal);
    EXPECT_EQ(child.exit_code(), 0);
    EXPECT_FALSE(std::filesystem::exists(bus_));
    EXPECT_FALSE(std::filesystem::exists(control_));
  }
}

TEST_F(InterlockSim, SimulatedClockMovesByExchangesOnly) {
  Child child(arguments());
  child.first_line();
  Control control(control_);
  EXPECT_EQ(control.ask(R"({"command":"status"})")["tick"], 0);
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  ASSERT_TRUE(kernel.attached);
  EXPECT_NE(kernel.answer.config_crc, 0u);
  kernel.run(250);
  EXPECT_EQ(control.ask(R"({"command":"status"})")["tick"], 250);
  EXPECT_EQ(kernel.reply.tick, 249u);
}

TEST_F(InterlockSim, SamePlantAsInProcess) {
  Child child(arguments());
  child.first_line();
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  Plant twin(sample_robot(), default_parameters(sample_robot()), 1);
  for (int n = 0; n < 500; ++n) {
    kernel.exchange.frame[kNonPwm][3] = 0x40000000u + 100'000;
    kernel.exchange.frame[kNonPwm][14] = 1;
    ASSERT_TRUE(kernel.tick());
    ilk_sim_exchange_t same = kernel.exchange;
    same.tick -= 1;
    const ilk_sim_reply_t expected = twin.tick(same);
    ASSERT_EQ(std::memcmp(&kernel.reply, &expected, sizeof expected), 0) << "tick " << n;
  }
}

TEST_F(InterlockSim, CommandsOfSeveralClientsActAtTheirTick) {
  Child child(arguments());
  child.first_line();
  Control one(control_);
  Control two(control_);
  EXPECT_EQ(one.ask(R"({"id":1,"command":"estop","pulled":true,"at":20})"),
            json::parse(R"({"id":1,"ok":true,"tick":20})"));
  EXPECT_EQ(two.ask(R"({"id":"x","command":"estop","pulled":false,"at":40})")["tick"], 40);
  two.send(R"({"command":"status","at":30})"
           "\n");
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  kernel.run(20);
  EXPECT_EQ(kernel.reply.estop_loop_closed, 1u);
  kernel.run(1);
  EXPECT_EQ(kernel.reply.estop_loop_closed, 0u);
  kernel.run(9);
  const json waited = two.answer();
  EXPECT_EQ(waited["tick"], 30);
  EXPECT_EQ(waited["estop"]["pulled"], true);
  kernel.run(20);
  EXPECT_EQ(kernel.reply.estop_loop_closed, 1u);
  EXPECT_EQ(one.ask(R"({"command":"record_event","kind":"estop_pulled"})")["event_tick"], 20);
  EXPECT_EQ(one.ask(R"({"command":"record","from":19,"to":21})")["entries"].size(), 3u);
}

TEST_F(InterlockSim, RefusedCommandNamesItsReasonAndChangesNothing) {
  Child child(arguments());
  child.first_line();
  Control control(control_);
  const json before = control.ask(R"({"command":"status"})");
  EXPECT_EQ(control.ask(R"({"id":9,"command":"jam","slot":8,"jammed":true})"),
            json::parse(R"({"id":9,"ok":false,"error":"slot 8 has no card"})"));
  EXPECT_EQ(control.ask(R"({"command":"pedal","pressed":"yes"})")["ok"], false);
  EXPECT_EQ(control.ask("rubbish")["ok"], false);
  EXPECT_EQ(control.ask(std::string(20'000, 'x'))["error"], "a line has at most 4096 bytes");
  EXPECT_EQ(control.ask(R"({"command":"status"})"), before);
}

TEST_F(InterlockSim, ClientThatStopsSendingGetsItsAnswers) {
  Child child(arguments());
  child.first_line();
  Control control(control_);
  control.send("{\"command\":\"pedal\",\"pressed\":true}\n{\"command\":\"status\"}\n");
  control.end_sending();
  EXPECT_EQ(control.answer()["ok"], true);
  EXPECT_EQ(control.answer()["ok"], true);
  EXPECT_EQ(control.answer(), nullptr);
}

TEST_F(InterlockSim, LongRecordAndIdleClientDoNotHoldUpTheBus) {
  Child child(arguments());
  child.first_line();
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  kernel.run(20'000);
  Control reader(control_);
  Control idle(control_);
  idle.send("{\"command\":\"record\",\"from\":0,\"to\":100000}\n");
  reader.send("{\"command\":\"record\",\"from\":0,\"to\":19999}\n");
  kernel.run(2'000);
  EXPECT_EQ(reader.answer()["entries"].size(), 20'000u);
}

TEST_F(InterlockSim, CommandsOfAClientThatLeftAtOnceStillAct) {
  Child child(arguments());
  child.first_line();
  {
    Control hasty(control_);
    hasty.send("{\"command\":\"estop\",\"pulled\":true}\n");
  }
  Control control(control_);
  control.ask(R"({"command":"status"})");
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  kernel.run(1);
  EXPECT_EQ(kernel.reply.estop_loop_closed, 0u);
}

TEST_F(InterlockSim, DeadKernelLeavesAmplifiersOffWithinFiveMillisecondsInEitherClock) {
  for (const ilk_clock_t clock : {ILK_CLOCK_SIM, ILK_CLOCK_REAL}) {
    Child child(arguments());
    child.first_line();
    Control control(control_);
    {
      Kernel kernel(bus_, clock);
      for (int n = 0; n < 50; ++n) {
        kernel.exchange.frame[kPwm][3] = 1000;
        kernel.exchange.frame[kPwm][14] = 1;
        ASSERT_TRUE(kernel.tick());
      }
    }
    const json later = status_once_amplifier_is_off(control);
    EXPECT_EQ(later["kernel"]["attached"], false);
    EXPECT_EQ(later["cards"][0]["watchdog_tripped"], true);
    const std::int64_t silent =
        control.ask(R"({"command":"record_event","kind":"kernel_silent"})")["event_tick"];
    const std::int64_t off =
        control.ask(R"({"command":"record_event","kind":"amplifiers_off"})")["event_tick"];
    EXPECT_EQ(off - silent, 5);
    Kernel next(bus_, clock);
    EXPECT_TRUE(next.attached) << "a new kernel is served";
    next.run(3);
  }
}

TEST_F(InterlockSim, RealClockSilenceTripsTheWatchdogOfAnAttachedKernel) {
  Child child(arguments());
  child.first_line();
  Control control(control_);
  Kernel kernel(bus_, ILK_CLOCK_REAL);
  kernel.exchange.frame[kPwm][3] = 1000;
  kernel.exchange.frame[kPwm][14] = 1;
  kernel.run(2);
  const json later = status_once_amplifier_is_off(control);
  EXPECT_EQ(later["kernel"]["attached"], true);
  EXPECT_EQ(later["cards"][0]["watchdog_tripped"], true);
}

TEST_F(InterlockSim, SecondKernelIsTurnedAwayAndTheFirstGoesOn) {
  Child child(arguments());
  child.first_line();
  Kernel first(bus_, ILK_CLOCK_SIM);
  first.run(5);
  Kernel second(bus_, ILK_CLOCK_SIM);
  EXPECT_FALSE(second.attached);
  first.run(5);
}

TEST_F(InterlockSim, WrongHelloOrRecordClosesTheBusAndTheNextKernelIsServed) {
  Child child(arguments());
  child.first_line();
  const ilk_sim_hello_t good{ILK_SIM_MAGIC, ILK_SIM_VERSION, ILK_FRAME_WORDS, 1000, ILK_CLOCK_SIM, 0};
  for (std::size_t word = 0; word < 5; ++word) {
    FileDescriptor socket = connect_to(bus_, SOCK_SEQPACKET);
    std::uint32_t words[6];
    std::memcpy(words, &good, sizeof good);
    words[word] ^= 0x40u;
    ::send(socket.get(), words, sizeof words, MSG_NOSIGNAL);
    char byte;
    EXPECT_EQ(::recv(socket.get(), &byte, 1, 0), 0) << "word " << word;
  }
  for (const std::size_t bytes :
       {std::size_t{1}, sizeof(ilk_sim_exchange_t) - 1, sizeof(ilk_sim_exchange_t) + 1}) {
    Kernel kernel(bus_, ILK_CLOCK_SIM);
    ASSERT_TRUE(kernel.attached);
    const std::vector<char> record(bytes);
    kernel.send_raw(record.data(), bytes);
    EXPECT_TRUE(kernel.is_closed_by_plant()) << bytes << " bytes";
  }
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  EXPECT_TRUE(kernel.attached);
}

TEST_F(InterlockSim, ReplacesTheSocketsOfADeadProcessOnly) {
  {
    Child killed(arguments());
    killed.first_line();
    killed.signal(SIGKILL);
    killed.exit_code();
  }
  ASSERT_TRUE(std::filesystem::is_socket(bus_));
  Child child(arguments());
  EXPECT_THAT(child.first_line(), HasSubstr("ready"));
  Child second(arguments());
  EXPECT_EQ(second.exit_code(), 2);
  EXPECT_THAT(second.error_text(), HasSubstr("another process listens there"));
  Kernel kernel(bus_, ILK_CLOCK_SIM);
  kernel.run(3);
}

TEST_F(InterlockSim, FaultyStartNamesItsReasonAndEndsWithTwo) {
  const auto fault_with = [this](std::size_t argument, const std::string& value) {
    std::vector<std::string> changed = arguments();
    changed[argument] = value;
    Child child(changed);
    const std::string text = child.error_text();
    EXPECT_EQ(child.exit_code(), 2);
    return text;
  };
  EXPECT_THAT(fault_with(1, folder_ / "none.toml"), HasSubstr("none.toml"));
  EXPECT_THAT(fault_with(1, folder_.write("bad.toml", "[pedal]\nlag_ms = -1\n")),
              HasSubstr("bad.toml:2: lag_ms: expected a number from 0 to 1000"));
  EXPECT_THAT(fault_with(3, folder_ / "none.ilkc"), HasSubstr("none.ilkc: cannot be read"));
  EXPECT_THAT(fault_with(5, folder_.write("file", "")), HasSubstr("exists and is no socket"));
  EXPECT_THAT(fault_with(5, std::string(200, 'x')), HasSubstr("a socket path has 1 to 107 characters"));
  EXPECT_THAT(fault_with(7, "/nonexistent/control"), HasSubstr("/nonexistent/control: cannot be made"));
  EXPECT_THAT(fault_with(0, "--plent"), HasSubstr("--plant is required"));
}

}  // namespace
}  // namespace interlock::plant::test
