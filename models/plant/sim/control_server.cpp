#include "plant/sim/control_server.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace interlock::plant::sim {
namespace {

constexpr std::size_t kMostClients = 16;
constexpr std::size_t kLongestLine = 4096;
constexpr const char* kTooLong = "a line has at most 4096 bytes";
constexpr std::size_t kMostUnsent = 64 * 1024;
constexpr std::size_t kMostWaiting = 64;
/** About 10 us of formatting between two looks at the bus. */
constexpr std::uint64_t kEntriesAtOnce = 16;

}  // namespace

pollfd ControlClient::descriptor() const {
  const int read = !ended_ && received_.size() <= kLongestLine ? POLLIN : 0;
  const int write = unsent_.empty() ? 0 : POLLOUT;
  return {.fd = socket_.get(), .events = static_cast<short>(read | write), .revents = 0};
}

bool ControlClient::may_answer() const { return !long_answer_ && unsent_.size() < kMostUnsent; }

bool ControlClient::has_work() const { return gone_ || long_answer_ || (may_answer() && has_line()); }

bool ControlClient::is_done() const {
  return ended_ && !has_line() && !long_answer_ && waiting_.empty() && (gone_ || unsent_.empty());
}

void ControlClient::serve(const pollfd& ready, Plant& plant, const BusServer& bus) {
  if ((ready.revents & (POLLHUP | POLLERR)) != 0) {
    give_up();
  }
  if ((ready.revents & POLLIN) != 0 || (gone_ && received_.size() <= kLongestLine)) {
    receive();
  }
  if (long_answer_) {
    if (long_answer_->append(plant.record(), kEntriesAtOnce, unsent_)) {
      long_answer_.reset();
    }
  } else {
    answer_due_queries(plant, bus);
    if (may_answer() && has_line()) {
      answer_line(plant, bus);
    }
  }
  transmit();
}

void ControlClient::receive() {
  std::array<char, kLongestLine> buffer;
  const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (count > 0) {
    received_.append(buffer.data(), static_cast<std::size_t>(count));
  } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
    ended_ = true;
  }
  if (!has_line() && received_.size() > kLongestLine) {
    // The rest of the line is thrown away as it comes; one refusal stands for all of it.
    if (!discarding_) {
      unsent_ += refused({nullptr, kTooLong});
    }
    discarding_ = true;
    received_.clear();
  }
}

void ControlClient::answer_line(Plant& plant, const BusServer& bus) {
  const std::size_t end = received_.find('\n');
  const std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  if (std::exchange(discarding_, false)) {
    return;
  }
  if (line.size() > kLongestLine) {
    unsent_ += refused({nullptr, kTooLong});
    return;
  }
  const auto request = parse_request(line, plant.ticks());
  if (request) {
    act(*request, plant, bus);
  } else {
    unsent_ += refused(request.error());
  }
}

void ControlClient::act(const Request& request, Plant& plant, const BusServer& bus) {
  if (const auto* command = std::get_if<command::Command>(&request.wish)) {
    const auto tick = plant.schedule(*command, request.at);
    unsent_ += tick ? accepted(request.id, *tick) : refused({request.id, tick.error()});
  } else if (request.at.value_or(plant.ticks()) < plant.ticks()) {
    unsent_ += refused({request.id, plant.past_text(*request.at)});
  } else if (request.at.value_or(plant.ticks()) == plant.ticks()) {
    answer_query(request, plant, bus);
  } else if (waiting_.size() < kMostWaiting) {
    waiting_.push_back(request);
  } else {
    unsent_ += refused({request.id, std::to_string(kMostWaiting) + " queries already wait for their tick"});
  }
}

void ControlClient::answer_due_queries(Plant& plant, const BusServer& bus) {
  const auto due = std::find_if(waiting_.begin(), waiting_.end(),
                                [&plant](const Request& request) { return *request.at <= plant.ticks(); });
  if (due != waiting_.end()) {
    answer_query(*due, plant, bus);
    waiting_.erase(due);
  }
}

void ControlClient::answer_query(const Request& request, Plant& plant, const BusServer& bus) {
  if (const auto* range = std::get_if<RecordQuery>(&request.wish)) {
    long_answer_.emplace(request.id, plant, *range);
  } else if (const auto* event = std::get_if<EventQuery>(&request.wish)) {
    unsent_ += accepted(request.id, plant.ticks(), newest_of(plant, event->kind));
  } else if (std::holds_alternative<ImageQuery>(request.wish)) {
    unsent_ += accepted(request.id, plant.ticks(), image_of(plant));
  } else {
    unsent_ += accepted(request.id, plant.ticks(), status_of(plant, bus.clock()));
  }
}

void ControlClient::transmit() {
  if (gone_ || unsent_.empty()) {
    unsent_.clear();
    return;
  }
  const ssize_t count = ::send(socket_.get(), unsent_.data(), std::min(unsent_.size(), kMostUnsent),
                               MSG_NOSIGNAL | MSG_DONTWAIT);
  if (count > 0) {
    unsent_.erase(0, static_cast<std::size_t>(count));
  } else if (count < 0 && errno != EAGAIN && errno != EINTR) {
    give_up();
  }
}

void ControlClient::give_up() {
  gone_ = true;
  waiting_.clear();
  long_answer_.reset();
}

ControlServer::ControlServer(Listener listener, Plant& plant, const BusServer& bus)
    : listener_(std::move(listener)), plant_(plant), bus_(bus) {}

void ControlServer::add_descriptors(std::vector<pollfd>& descriptors) const {
  descriptors.push_back({.fd = listener_.descriptor(), .events = POLLIN, .revents = 0});
  for (const ControlClient& client : clients_) {
    descriptors.push_back(client.descriptor());
  }
}

bool ControlServer::has_work() const {
  return std::any_of(clients_.begin(), clients_.end(),
                     [](const ControlClient& client) { return client.has_work(); });
}

void ControlServer::serve(std::span<const pollfd> ready) {
  for (std::size_t index = 0; index < clients_.size(); ++index) {
    clients_[index].serve(ready[index + 1], plant_, bus_);
  }
  std::erase_if(clients_, [](const ControlClient& client) { return client.is_done(); });
  if (ready[0].revents != 0) {
    accept_client();
  }
}

void ControlServer::accept_client() {
  FileDescriptor arrived = listener_.accept();
  if (!arrived.is_open()) {
    return;
  }
  if (clients_.size() == kMostClients) {
    const std::string answer =
        refused({nullptr, std::to_string(kMostClients) + " clients are connected; close one of them"});
    ::send(arrived.get(), answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return;
  }
  clients_.emplace_back(std::move(arrived));
}

}  // namespace interlock::plant::sim
