#include "plant/sim/bus_server.hpp"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <iostream>

namespace interlock::plant::sim {
namespace {

/** What is wrong with the hello of a kernel; empty when nothing is. */
std::string fault_of(const ilk_sim_hello_t& hello, Microseconds period) {
  const auto differs = [](const char* what, std::uint64_t found, std::uint64_t expected) {
    return std::string(what) + " " + std::to_string(found) + ", expected " + std::to_string(expected);
  };
  if (hello.magic != ILK_SIM_MAGIC) {
    return "first word is not that of a hello";
  }
  if (hello.version != ILK_SIM_VERSION) {
    return differs("bus version", hello.version, ILK_SIM_VERSION);
  }
  if (hello.frame_words != ILK_FRAME_WORDS) {
    return differs("frame words", hello.frame_words, ILK_FRAME_WORDS);
  }
  if (hello.period_us != period.count()) {
    return differs("period in us", hello.period_us, period.count());
  }
  if (hello.clock != ILK_CLOCK_REAL && hello.clock != ILK_CLOCK_SIM) {
    return differs("clock", hello.clock, ILK_CLOCK_SIM);
  }
  return {};
}

std::string reason_of(int error) { return std::strerror(error); }

}  // namespace

BusServer::BusServer(Listener listener, Plant& plant, std::uint32_t config_crc)
    : listener_(std::move(listener)), plant_(plant), config_crc_(config_crc) {}

void BusServer::add_descriptors(std::vector<pollfd>& descriptors) const {
  descriptors.push_back({.fd = listener_.descriptor(), .events = POLLIN, .revents = 0});
  if (client_.is_open()) {
    descriptors.push_back({.fd = client_.get(), .events = POLLIN, .revents = 0});
  }
}

void BusServer::serve(std::span<const pollfd> ready) {
  if (follows_wall_clock()) {
    follow_wall_clock();
  }
  // The old kernel's end is seen before a new one is let in.
  if (ready.size() > 1 && ready[1].revents != 0) {
    serve_client();
  }
  if (ready[0].revents != 0) {
    accept_client();
  }
}

void BusServer::follow_wall_clock() {
  const auto elapsed = std::chrono::duration_cast<std::chrono::microseconds>(WallClock::now() - wall_);
  wall_ += elapsed;
  plant_.advance(Microseconds(static_cast<std::uint64_t>(elapsed.count())));
}

void BusServer::serve_client() {
  // A byte more than the longest record shows one that is too long.
  std::array<unsigned char, sizeof(ilk_sim_exchange_t) + 1> buffer;
  const ssize_t received = ::recv(client_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (received < 0 && (errno == EAGAIN || errno == EINTR)) {
    return;
  }
  if (received <= 0) {
    detach("");
  } else if (!clock_ && static_cast<std::size_t>(received) == sizeof(ilk_sim_hello_t)) {
    ilk_sim_hello_t hello;
    std::memcpy(&hello, buffer.data(), sizeof hello);
    answer_hello(hello);
  } else if (clock_ && static_cast<std::size_t>(received) == sizeof(ilk_sim_exchange_t)) {
    ilk_sim_exchange_t exchange;
    std::memcpy(&exchange, buffer.data(), sizeof exchange);
    answer_exchange(exchange);
  } else {
    detach("a record of " + std::to_string(received) + " bytes, expected " +
           std::to_string(clock_ ? sizeof(ilk_sim_exchange_t) : sizeof(ilk_sim_hello_t)));
  }
}

void BusServer::answer_hello(const ilk_sim_hello_t& hello) {
  if (const std::string fault = fault_of(hello, plant_.period()); !fault.empty()) {
    detach(fault);
    return;
  }
  if (hello.config_crc != config_crc_) {
    std::cerr
        << "interlock-sim: the kernel runs another configuration than the plant's; compile the robot file "
           "once and give it to both\n";
  }
  ilk_sim_hello_t answer = hello;
  answer.config_crc = config_crc_;
  if (!send(&answer, sizeof answer)) {
    return;
  }
  clock_ = static_cast<ilk_clock_t>(hello.clock);
  if (!started_) {
    started_ = true;
    wall_ = WallClock::now();
  }
}

void BusServer::answer_exchange(const ilk_sim_exchange_t& exchange) {
  if (exchange.magic != ILK_SIM_MAGIC) {
    detach("first word is not that of an exchange");
    return;
  }
  const ilk_sim_reply_t reply = plant_.exchange(exchange);
  const bool simulated_clock = clock_ == ILK_CLOCK_SIM;
  send(&reply, sizeof reply);
  if (simulated_clock) {
    plant_.advance(plant_.period());
  }
}

bool BusServer::send(const void* record, std::size_t bytes) {
  if (::send(client_.get(), record, bytes, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(bytes)) {
    return true;
  }
  // A kernel that died in between is no news: the end of its socket says so.
  detach(errno == EPIPE || errno == ECONNRESET ? "" : "an answer could not be sent: " + reason_of(errno));
  return false;
}

void BusServer::detach(const std::string& reason) {
  if (!reason.empty()) {
    std::cerr << "interlock-sim: bus closed: " << reason << '\n';
  }
  if (clock_ == ILK_CLOCK_SIM) {
    wall_ = WallClock::now();
  }
  client_ = FileDescriptor();
  clock_.reset();
}

void BusServer::accept_client() {
  FileDescriptor arrived = listener_.accept();
  if (!arrived.is_open()) {
    return;
  }
  if (clock_) {
    std::cerr << "interlock-sim: a second kernel was turned away; one is attached\n";
    return;
  }
  client_ = std::move(arrived);
}

}  // namespace interlock::plant::sim
