#include "http/control_client.hpp"

#include <unistd.h>

#include <chrono>
#include <type_traits>

#include "network/as_result.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds ask_timeout{1000};
constexpr std::chrono::milliseconds stop_timeout{300};

}  // namespace

ControlClient::ControlClient(const asio::any_io_executor& executor, Mailbox& mailbox)
    : executor_(executor), mailbox_(mailbox), wake_(executor, ::dup(mailbox.network_wake.descriptor())) {}

const ControlView& ControlClient::view() {
  const ControlView& newest = mailbox_.view.newest();
  if (!newest.attached) {
    since_.reset();
  } else if (!since_ || newest.generation != generation_) {
    since_ = std::chrono::system_clock::now();
    generation_ = newest.generation;
  }
  return newest;
}

bool ControlClient::send(Command command) {
  std::visit(
      [this](auto& each) {
        if constexpr (requires { each.stops; }) {
          each.stops = stops();
        }
        if constexpr (std::is_same_v<decltype(each), Renewal&>) {
          each.held = view().moment(steady_clock::now());
        } else if constexpr (std::is_same_v<decltype(each), Approval&>) {
          each.held = view().moment(steady_clock::now());
        }
      },
      command);
  return mailbox_.commands.push(command);
}

asio::awaitable<std::optional<Answer>> ControlClient::ask(std::uint32_t kind, std::uint32_t slot,
                                                          std::int32_t target_counts) {
  const auto deadline = steady_clock::now() + ask_timeout;
  Waiter<Answer> waiter{std::nullopt, asio::steady_timer(executor_, deadline)};
  const std::uint32_t ticket = ++last_ticket_;
  if (!send(Ask{ticket, kind, slot, target_counts, deadline, 0})) {
    co_return std::nullopt;
  }
  asks_[ticket] = &waiter;
  co_await waiter.timer.async_wait(as_result);
  asks_.erase(ticket);
  co_return waiter.result;
}

asio::awaitable<std::optional<StopAnswer>> ControlClient::stop() { return stop_answered(mailbox_.stop()); }

asio::awaitable<std::optional<StopAnswer>> ControlClient::stop_answered(std::uint32_t number) {
  if (!view().attached) {
    co_return std::nullopt;
  }
  Waiter<StopAnswer> waiter{std::nullopt, asio::steady_timer(executor_, steady_clock::now() + stop_timeout)};
  const auto place = stops_.emplace(number, &waiter);
  co_await waiter.timer.async_wait(as_result);
  stops_.erase(place);
  co_return waiter.result;
}

void ControlClient::change_holder(std::uint32_t number) {
  mailbox_.holder.store(number, std::memory_order_release);
  mailbox_.stops.fetch_add(1, std::memory_order_release);
}

asio::awaitable<void> ControlClient::listen() {
  for (;;) {
    const auto [error] = co_await wake_.async_wait(asio::posix::stream_descriptor::wait_read, as_result);
    if (error) {
      co_return;
    }
    mailbox_.network_wake.clear();
    on_orders();
    mailbox_.notices.consume_all([this](const Notice& notice) { take(notice); });
  }
}

void ControlClient::take(const Notice& notice) {
  if (const auto* event = std::get_if<ilk_event_t>(&notice)) {
    on_event(*event);
  } else if (const auto* lost = std::get_if<EventsLost>(&notice)) {
    on_events_lost(*lost);
  } else if (const auto* answer = std::get_if<Answer>(&notice)) {
    const auto found = asks_.find(answer->ticket);
    if (found != asks_.end()) {
      found->second->result = *answer;
      found->second->timer.cancel();
    }
  } else if (const auto* stopped = std::get_if<StopAnswer>(&notice)) {
    for (auto each = stops_.begin(); each != stops_.end() && each->first <= stopped->stops; ++each) {
      each->second->result = *stopped;
      each->second->timer.cancel();
    }
  }
}

}  // namespace interlock::web
