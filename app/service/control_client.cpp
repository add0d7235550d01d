#include "service/control_client.hpp"

#include <unistd.h>

#include <chrono>
#include <type_traits>

#include "system/as_result.hpp"

namespace interlock {
namespace {

namespace asio = boost::asio;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds ask_timeout{1000};
constexpr std::chrono::milliseconds stop_timeout{300};

}  // namespace

ControlClient::ControlClient(const asio::any_io_executor& executor, RealtimeChannel& channel)
    : executor_(executor), channel_(channel), wake_(executor, ::dup(channel.network_wake.descriptor())) {}

const ControlView& ControlClient::view() {
  const ControlView& newest = channel_.view.newest();
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
  return channel_.commands.push(command);
}

asio::awaitable<std::optional<KernelResponse>> ControlClient::ask(std::uint32_t kind, std::uint32_t slot,
                                                                  std::int32_t target_counts) {
  const auto deadline = steady_clock::now() + ask_timeout;
  Waiter<KernelResponse> waiter{std::nullopt, asio::steady_timer(executor_, deadline)};
  const std::uint32_t call_id = ++last_call_id_;
  if (!send(KernelCall{call_id, kind, slot, target_counts, deadline, 0})) {
    co_return std::nullopt;
  }
  calls_[call_id] = &waiter;
  co_await waiter.timer.async_wait(as_result);
  calls_.erase(call_id);
  co_return waiter.result;
}

asio::awaitable<std::optional<StopAnswer>> ControlClient::stop() { return stop_answered(channel_.stop()); }

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
  channel_.holder.store(number, std::memory_order_release);
  channel_.stops.fetch_add(1, std::memory_order_release);
}

asio::awaitable<void> ControlClient::listen() {
  for (;;) {
    const auto [error] = co_await wake_.async_wait(asio::posix::stream_descriptor::wait_read, as_result);
    if (error) {
      co_return;
    }
    channel_.network_wake.clear();
    on_orders();
    channel_.notices.consume_all([this](const Notice& notice) { take(notice); });
  }
}

void ControlClient::take(const Notice& notice) {
  if (const auto* event = std::get_if<ilk_event_t>(&notice)) {
    on_event(*event);
  } else if (const auto* lost = std::get_if<EventsLost>(&notice)) {
    on_events_lost(*lost);
  } else if (const auto* answer = std::get_if<KernelResponse>(&notice)) {
    const auto found = calls_.find(answer->call_id);
    if (found != calls_.end()) {
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

}  // namespace interlock
