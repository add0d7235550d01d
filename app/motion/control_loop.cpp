#include "motion/control_loop.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <thread>
#include <utility>

namespace interlock {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds hello_timeout{500};
constexpr milliseconds snapshot_timeout{20};
constexpr milliseconds shortest_back_off{20};
constexpr milliseconds longest_back_off{500};
constexpr std::uint32_t heartbeat_period_ticks = 20;
/** Who holds motion authority. There is one console until users are known. */
constexpr std::uint32_t console_holder = 1;
/** Room in the notice queue that events leave to answers. */
constexpr std::size_t answer_reserve = 2 * Mailbox::command_capacity;

ilk_request_t request_of(std::uint32_t kind, std::uint32_t slot = 0) noexcept {
  ilk_request_t request{};
  request.kind = kind;
  request.axis = slot;
  return request;
}

}  // namespace

ControlLoop::ControlLoop(std::string link_socket, const RobotPlan& plan, Mailbox& mailbox)
    : link_(std::move(link_socket)), mode_(plan), mailbox_(mailbox), back_off_(shortest_back_off) {}

void ControlLoop::run(const std::stop_token& stop) noexcept {
  while (!stop.stop_requested()) {
    if (!link_.attached()) {
      attach_or_back_off(stop);
      continue;
    }
    switch (link_.wait(snapshot_timeout)) {
      case LinkWait::snapshot:
        if (link_.read_snapshot(view_.snapshot)) {
          tick();
        }
        break;
      case LinkWait::timeout:
        port_.begin_tick();
        obey_stop();
        break;
      case LinkWait::closed:
        lose_link();
        break;
    }
  }
  port_.begin_tick();
  (void)port_.send(request_of(ILK_REQUEST_STOP), HeartbeatOrigin{});
}

void ControlLoop::attach_or_back_off(const std::stop_token& stop) noexcept {
  const auto attached = link_.attach(hello_timeout);
  if (attached) {
    spdlog::info("attached to the kernel, generation {}", link_.generation());
    attach_complaint_.clear();
    back_off_ = shortest_back_off;
    view_.generation = link_.generation();
    heartbeat_sent_ = false;
    events_lost_ = 0;
    return;
  }
  std::string complaint = attached.error().message();
  if (complaint != attach_complaint_) {
    spdlog::warn("no kernel: {}; trying again", complaint);
    attach_complaint_ = std::move(complaint);
  }
  for (auto waited = milliseconds{0}; waited < back_off_ && !stop.stop_requested();
       waited += shortest_back_off) {
    refuse_commands();
    std::this_thread::sleep_for(shortest_back_off);
  }
  back_off_ = std::min(back_off_ * 2, longest_back_off);
}

void ControlLoop::lose_link() noexcept {
  spdlog::warn("the kernel closed the link, generation {}", link_.generation());
  port_.forget_all([this](const RequestOrigin& origin) { answer_lost(origin); });
  mode_.end_all(OrderReason::link_lost, view_.snapshot.state.tick);
  link_.detach();
  view_.attached = false;
  refuse_commands();
  publish();
}

void ControlLoop::tick() noexcept {
  view_.attached = true;
  view_.received = std::chrono::steady_clock::now();
  port_.begin_tick();
  obey_stop();
  read_events();
  send_heartbeat();
  take_commands();
  send_moves();
  publish();
  link_.publish_seen(view_.snapshot.state.tick);
}

void ControlLoop::obey_stop() noexcept {
  stops_seen_ = mailbox_.stops.load(std::memory_order_acquire);
  if (stops_seen_ == stops_sent_) {
    return;
  }
  mode_.end_all(OrderReason::stopped, view_.snapshot.state.tick);
  if (port_.send(request_of(ILK_REQUEST_STOP), StopOrigin{stops_seen_})) {
    stops_sent_ = stops_seen_;
  }
}

void ControlLoop::read_events() noexcept {
  ilk_event_t event{};
  for (std::uint32_t i = 0; i < ILK_LINK_EVENTS && link_.read_event(event); ++i) {
    if (event.kind == ILK_EVENT_VERDICT) {
      dispatch_verdict(event);
    } else {
      notify(event);
    }
  }
  if (link_.events_lost() != events_lost_) {
    events_dropped_ += link_.events_lost() - events_lost_;
    events_lost_ = link_.events_lost();
    port_.forget_all([this](const RequestOrigin& origin) { answer_lost(origin); });
  }
  if (events_dropped_ != 0 && room_for_events()) {
    notify(EventsLost{std::exchange(events_dropped_, 0)});
  }
}

void ControlLoop::dispatch_verdict(const ilk_event_t& event) noexcept {
  const std::uint32_t verdict = event.value[3];
  const auto origin = port_.settle(event.value[0]);
  if (!origin) {
    return;
  }
  if (const auto* move = std::get_if<MoveOrigin>(&*origin)) {
    mode_.on_verdict(move->slot, move->proposal, verdict, event.tick);
  } else if (const auto* ask = std::get_if<AskOrigin>(&*origin)) {
    notify(Answer{ask->ticket, verdict, event.tick});
  } else if (const auto* asked_stop = std::get_if<StopOrigin>(&*origin)) {
    notify(StopAnswer{asked_stop->stops, verdict, event.tick});
  }
  const bool routine =
      std::holds_alternative<HeartbeatOrigin>(*origin) || std::holds_alternative<MoveOrigin>(*origin);
  if (!routine || verdict != ILK_VERDICT_ACCEPTED) {
    notify(event);
  }
}

void ControlLoop::send_heartbeat() noexcept {
  const std::uint32_t now = view_.snapshot.state.tick;
  const bool due = !heartbeat_sent_ || now - heartbeat_tick_ >= heartbeat_period_ticks;
  if (!due || view_.snapshot.state.mode == ILK_MODE_INIT) {
    return;
  }
  ilk_request_t request = request_of(ILK_REQUEST_HEARTBEAT);
  request.holder = console_holder;
  if (port_.send(request, HeartbeatOrigin{})) {
    heartbeat_sent_ = true;
    heartbeat_tick_ = now;
  }
}

void ControlLoop::take_commands() noexcept {
  while (mailbox_.commands.read_available() != 0 && take(mailbox_.commands.front())) {
    mailbox_.commands.pop();
  }
}

/** False: not now, so it stays at the head of the queue until the next tick. */
bool ControlLoop::take(const Command& command) noexcept {
  const std::uint32_t now = view_.snapshot.state.tick;
  if (const auto* order = std::get_if<Order>(&command)) {
    const auto newer_than_stop = static_cast<std::int32_t>(order->stops - stops_seen_);
    if (newer_than_stop > 0) {
      return false;
    }
    mode_.take(*order, now);
    if (newer_than_stop < 0) {
      mode_.end(order->slot, order->proposal, OrderReason::stopped, now);
    }
    return true;
  }
  if (const auto* cancel = std::get_if<Cancel>(&command)) {
    mode_.end(cancel->slot, cancel->proposal, OrderReason::cancelled, now);
    return true;
  }
  const auto* ask = std::get_if<Ask>(&command);
  if (std::chrono::steady_clock::now() > ask->deadline) {
    answer_lost(AskOrigin{ask->ticket});
    return true;
  }
  ilk_request_t request = request_of(ask->kind, ask->slot);
  request.target_counts = ask->target_counts;
  return port_.send(request, AskOrigin{ask->ticket});
}

void ControlLoop::send_moves() noexcept {
  const MoveWishes wishes = mode_.tick(view_.snapshot);
  for (const MoveWish& wish : wishes.all()) {
    ilk_request_t request = request_of(ILK_REQUEST_MOVE, wish.slot);
    request.target_counts = wish.target_counts;
    request.drive = wish.drive;
    request.amplitude = wish.amplitude;
    request.lease_ticks = wish.lease_ticks;
    if (!port_.send(request, MoveOrigin{wish.slot, wish.proposal})) {
      mode_.on_unsent(wish);
    }
  }
}

void ControlLoop::publish() noexcept {
  view_.orders = mode_.orders();
  mailbox_.view.writing() = view_;
  mailbox_.view.publish();
  if (std::exchange(noticed_, false) || view_.orders != published_orders_) {
    published_orders_ = view_.orders;
    mailbox_.network_wake.signal();
  }
}

void ControlLoop::refuse_commands() noexcept {
  const std::uint32_t tick = view_.snapshot.state.tick;
  const bool any = mailbox_.commands.read_available() != 0;
  mailbox_.commands.consume_all([this, tick](const Command& command) {
    if (const auto* order = std::get_if<Order>(&command)) {
      mode_.take(*order, tick);
      mode_.end(order->slot, order->proposal, OrderReason::link_lost, tick);
    } else if (const auto* ask = std::get_if<Ask>(&command)) {
      answer_lost(AskOrigin{ask->ticket});
    }
  });
  const std::uint32_t stops = mailbox_.stops.load(std::memory_order_acquire);
  if (stops != stops_sent_) {
    stops_sent_ = stops;
    notify(StopAnswer{stops, std::nullopt, 0});
  }
  if (any || noticed_) {
    publish();
  }
}

void ControlLoop::answer_lost(const RequestOrigin& origin) noexcept {
  if (const auto* ask = std::get_if<AskOrigin>(&origin)) {
    notify(Answer{ask->ticket, std::nullopt, 0});
  } else if (const auto* asked_stop = std::get_if<StopOrigin>(&origin)) {
    notify(StopAnswer{asked_stop->stops, std::nullopt, 0});
  }
}

bool ControlLoop::room_for_events() const noexcept {
  return mailbox_.notices.write_available() > answer_reserve;
}

void ControlLoop::notify(const Notice& notice) noexcept {
  if (std::holds_alternative<ilk_event_t>(notice) && !room_for_events()) {
    ++events_dropped_;
    return;
  }
  noticed_ = mailbox_.notices.push(notice) || noticed_;
}

}  // namespace interlock
