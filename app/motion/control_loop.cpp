#include "motion/control_loop.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <thread>
#include <type_traits>
#include <utility>

#include "motion/blocking_condition.hpp"

namespace interlock {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds hello_timeout{500};
constexpr milliseconds snapshot_timeout{20};
constexpr milliseconds shortest_back_off{20};
constexpr milliseconds longest_back_off{500};
constexpr std::uint32_t heartbeat_period_ticks = 20;
/** Without a sign of the threads that serve people, which give thirty a second: motion ends within 200 ms. */
constexpr milliseconds service_timeout{150};
/** Room in the notice queue that events leave to answers. */
constexpr std::size_t answer_reserve = 2 * RealtimeChannel::command_capacity;

ilk_request_t request_of(std::uint32_t kind, std::uint32_t slot = 0) noexcept {
  ilk_request_t request{};
  request.kind = kind;
  request.axis = slot;
  return request;
}

}  // namespace

ControlLoop::ControlLoop(std::string link_socket, Modes modes, LinkageWatch linkages,
                         RealtimeChannel& channel, TickObserver* observer, LinkUse use)
    : link_(std::move(link_socket)),
      modes_(std::move(modes), std::move(linkages)),
      channel_(channel),
      observer_(observer),
      use_(use),
      back_off_(shortest_back_off) {
  view_.replay = use == LinkUse::replay;
}

void ControlLoop::run(const std::stop_token& stop) noexcept {
  publish();
  while (!stop.stop_requested()) {
    rounds_.fetch_add(1, std::memory_order_relaxed);
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
        miss_tick();
        break;
      case LinkWait::closed:
        lose_link();
        break;
    }
  }
  if (use_ == LinkUse::control) {
    port_.begin_tick();
    (void)port_.send(request_of(ILK_REQUEST_STOP), HeartbeatOrigin{});
  }
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
  modes_.end_all(TaskReason::link_lost, view_.snapshot.state.system.tick);
  port_.forget_all([this](const RequestOrigin& origin) { answer_lost(origin); });
  link_.detach();
  view_.attached = false;
  refuse_commands();
  publish();
}

void ControlLoop::tick() noexcept {
  view_.attached = true;
  view_.received = std::chrono::steady_clock::now();
  if (use_ == LinkUse::control) {
    control();
  } else {
    watch();
  }
  publish();
  if (observer_ != nullptr) {
    observer_->see(view_);
  }
  link_.publish_seen(view_.snapshot.state.system.tick);
}

void ControlLoop::control() noexcept {
  port_.begin_tick();
  watch_service();
  obey_stop();
  obey_pause();
  obey_holds();
  read_events();
  send_heartbeat();
  take_commands();
  end_let_go();
  send_requests();
}

/** Whoever asks for something is told that it was not sent. */
void ControlLoop::watch() noexcept {
  read_events();
  refuse_commands();
}

/** No tick came within the time of many: a STOP waits for none. */
void ControlLoop::miss_tick() noexcept {
  if (use_ == LinkUse::replay) {
    refuse_commands();
    return;
  }
  port_.begin_tick();
  watch_service();
  obey_stop();
  obey_pause();
}

/** Whoever holds a control down, or would press STOP, waits in vain for a thread that stands still: that is a
 * STOP. Of time for which this thread did not run itself only as much counts as a round takes, since the
 * others may not have run either; the kernel has its own eye on that. */
void ControlLoop::watch_service() noexcept {
  const auto now = std::chrono::steady_clock::now();
  const auto passed = std::min<std::chrono::nanoseconds>(now - std::exchange(round_, now), snapshot_timeout);
  const auto stands_still = [passed](Sign& sign, std::uint32_t count) {
    const bool goes_on = count == 0 || std::exchange(sign.seen, count) != count;
    sign.still = goes_on ? std::chrono::nanoseconds{0} : sign.still + passed;
    return sign.still >= service_timeout;
  };
  const bool network = stands_still(network_, channel_.served.load(std::memory_order_relaxed));
  const bool door = stands_still(door_, channel_.door_kept.load(std::memory_order_relaxed));
  if (!std::exchange(nobody_served_, network || door) && nobody_served_) {
    channel_.stop();
  }
}

void ControlLoop::obey_stop() noexcept {
  stops_seen_ = channel_.stops.load(std::memory_order_acquire);
  if (stops_seen_ == stops_sent_) {
    return;
  }
  const bool holder_changed = channel_.holder.load(std::memory_order_relaxed) != holder_sent_;
  modes_.end_all(nobody_served_   ? TaskReason::nobody_served
                 : holder_changed ? TaskReason::control_changed
                                  : TaskReason::stopped,
                 view_.snapshot.state.system.tick);
  if (port_.send(request_of(ILK_REQUEST_STOP), StopOrigin{stops_seen_})) {
    stops_sent_ = stops_seen_;
  }
}

/** The kernel leaves MOTION, and each mode sees that as it sees the pedal's release. */
void ControlLoop::obey_pause() noexcept {
  const std::uint32_t pauses = channel_.pauses.load(std::memory_order_acquire);
  if (pauses != pauses_sent_ && port_.send(request_of(ILK_REQUEST_STOP), HeartbeatOrigin{})) {
    pauses_sent_ = pauses;
  }
}

/** A signal's age is judged here, in each tick. Who holds the pedal waits for a breath: once somebody has
 * turned the gate off meanwhile, nothing starts before the next press, even if it is turned on again and
 * opens. */
void ControlLoop::obey_holds() noexcept {
  const OutsideHolds& holds = channel_.holds.newest();
  const GateState gate = holds.gate.at(view_.moment(view_.received));
  noticed_ = noticed_ || gate != view_.gate || holds.scanning != view_.scanning;
  view_.gate = gate;
  view_.scanning = holds.scanning;
  const bool closed = gate != GateState::off && gate != GateState::open;
  const bool held = view_.snapshot.state.system.mode == ILK_MODE_MOTION;
  still_.needs_press = held && (still_.needs_press || (still_.insertion && gate == GateState::off));
  still_.insertion = closed || still_.needs_press;
  still_.all = holds.scanning;
  modes_.hold(still_);
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
    port_.forget_all([this](const RequestOrigin& origin) { lose_verdict(origin); });
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
  const auto* request = std::get_if<ModeOrigin>(&*origin);
  if (request != nullptr) {
    modes_.on_verdict(*request, verdict, event.tick);
  } else if (const auto* call = std::get_if<CallOrigin>(&*origin)) {
    notify(KernelResponse{call->call_id, verdict, event.tick});
    if (const auto reason = cancelled_by(call->kind); reason && verdict == ILK_VERDICT_ACCEPTED) {
      modes_.end_axis(call->slot, *reason, event.tick);
    }
  } else if (const auto* asked_stop = std::get_if<StopOrigin>(&*origin)) {
    answer({asked_stop->stops, verdict, event.tick});
  }
  const bool is_move = request != nullptr && request->kind == ILK_REQUEST_MOVE;
  const bool routine = is_move || std::holds_alternative<HeartbeatOrigin>(*origin);
  if (!routine || verdict != ILK_VERDICT_ACCEPTED) {
    notify(event);
  }
}

/** The kernel may have accepted it, and a snapshot does not show what an axis was in between: a task that
 * the acceptance would have ended goes on only if somebody proposes it again. */
void ControlLoop::lose_verdict(const RequestOrigin& origin) noexcept {
  const auto* call = std::get_if<CallOrigin>(&origin);
  if (call != nullptr && cancelled_by(call->kind)) {
    modes_.end_axis(call->slot, TaskReason::verdict_lost, view_.snapshot.state.system.tick);
  }
  answer_lost(origin);
}

void ControlLoop::send_heartbeat() noexcept {
  const std::uint32_t now = view_.snapshot.state.system.tick;
  const std::uint32_t holder = channel_.holder.load(std::memory_order_acquire);
  const bool due =
      !heartbeat_sent_ || holder != holder_sent_ || now - heartbeat_tick_ >= heartbeat_period_ticks;
  if (!due || view_.snapshot.state.system.mode == ILK_MODE_INIT) {
    return;
  }
  ilk_request_t request = request_of(ILK_REQUEST_HEARTBEAT);
  request.holder = holder;
  if (port_.send(request, HeartbeatOrigin{})) {
    heartbeat_sent_ = true;
    holder_sent_ = holder;
    heartbeat_tick_ = now;
  }
}

/** One that is not taken now stays at the head of the queue until the next tick. */
void ControlLoop::take_commands() noexcept {
  const auto taken = [this](const Command& command) {
    return std::visit([this](const auto& each) { return take(each); }, command);
  };
  while (channel_.commands.read_available() != 0 && taken(channel_.commands.front())) {
    channel_.commands.pop();
  }
}

bool ControlLoop::take(const Approval& approval) noexcept {
  const std::uint32_t now = view_.snapshot.state.system.tick;
  const std::int32_t newer = newer_than_stop(approval.stops);
  if (newer > 0) {
    return false;
  }
  const std::uint32_t task = approval.task->id;
  modes_.take(approval.task, now);
  if (newer < 0) {
    modes_.end(task, nobody_served_ ? TaskReason::nobody_served : TaskReason::stopped, now);
  } else if (std::chrono::steady_clock::now() > approval.deadline) {
    modes_.end(task, TaskReason::approved_late, now);
  }
  const MoveTask* move = approval.task->work.find<MoveTask>();
  if (move != nullptr && move->slot < ILK_SLOTS) {
    Jog& jog = jogs_[move->slot];
    jog.task = task;
    jog.lease.release();
    if (move->jog) {
      jog.lease.hold(approval.held);
    }
  }
  return true;
}

/** One that comes late brings no jog back. */
bool ControlLoop::take(const Renewal& renewal) noexcept {
  for (Jog& jog : jogs_) {
    if (jog.task == renewal.task && jog.lease.held() && !jog.lease.overdue(renewal.held)) {
      jog.lease.hold(renewal.held);
    }
  }
  return true;
}

void ControlLoop::end_let_go() noexcept {
  const Moment now = view_.moment(view_.received);
  for (Jog& jog : jogs_) {
    if (jog.lease.overdue(now)) {
      modes_.end(jog.task, TaskReason::let_go, now.tick);
      jog.lease.release();
    }
  }
}

bool ControlLoop::take(const SeenImage& seen) noexcept {
  modes_.see(seen);
  return true;
}

/** One from before a STOP, or that comes late, lets nothing go on. */
bool ControlLoop::take(const Confirmation& confirmation) noexcept {
  const std::int32_t newer = newer_than_stop(confirmation.stops);
  if (newer > 0) {
    return false;
  }
  if (newer == 0 && std::chrono::steady_clock::now() <= confirmation.deadline) {
    modes_.confirm(confirmation.task, view_.snapshot.state.system.tick);
  }
  return true;
}

bool ControlLoop::take(const Cancel& cancel) noexcept {
  modes_.end(cancel.task, TaskReason::cancelled, view_.snapshot.state.system.tick);
  return true;
}

/** Below 0: it was asked for before the newest STOP, or nobody is served; above 0: that STOP has still to be
 * obeyed. */
std::int32_t ControlLoop::newer_than_stop(std::uint32_t stops) const noexcept {
  return nobody_served_ ? -1 : static_cast<std::int32_t>(stops - stops_seen_);
}

bool ControlLoop::take(const KernelCall& call) noexcept {
  const CallOrigin origin{call.call_id, call.kind, call.slot};
  const std::int32_t newer = newer_than_stop(call.stops);
  if (newer > 0) {
    return false;
  }
  const bool overtaken = newer < 0 && call.kind != ILK_REQUEST_DISABLE;
  if (overtaken || std::chrono::steady_clock::now() > call.deadline) {
    answer_lost(origin);
    return true;
  }
  ilk_request_t request = request_of(call.kind, call.slot);
  request.target_counts = call.target_counts;
  return port_.send(request, origin);
}

void ControlLoop::send_requests() noexcept {
  const KernelRequests requests = modes_.tick(view_.snapshot);
  for (const KernelRequest& request : requests.all()) {
    if (!port_.send(sent_form(request, view_.snapshot.state.system.consent), request.origin)) {
      modes_.on_unsent(request);
    }
  }
}

void ControlLoop::publish() noexcept {
  modes_.report(view_);
  channel_.view.writing() = view_;
  channel_.view.publish();
  const bool changed = view_.tasks != published_tasks_ || view_.biopsy != published_biopsy_;
  if (std::exchange(noticed_, false) || changed) {
    published_tasks_ = view_.tasks;
    published_biopsy_ = view_.biopsy;
    channel_.network_wake.signal();
  }
}

/** Without the link nothing is open that a command could end or renew. */
void ControlLoop::refuse_commands() noexcept {
  const bool any = channel_.commands.read_available() != 0;
  channel_.commands.consume_all([this](const Command& command) {
    if (const auto* approval = std::get_if<Approval>(&command)) {
      const std::uint32_t tick = view_.snapshot.state.system.tick;
      modes_.take(approval->task, tick);
      modes_.end(approval->task->id, TaskReason::link_lost, tick);
    } else if (const auto* call = std::get_if<KernelCall>(&command)) {
      answer_lost(CallOrigin{call->call_id, call->kind, call->slot});
    }
  });
  const std::uint32_t stops = channel_.stops.load(std::memory_order_acquire);
  if (stops != stops_sent_) {
    stops_sent_ = stops;
    answer({stops, std::nullopt, 0});
  }
  if (any || noticed_) {
    publish();
  }
}

void ControlLoop::answer(const StopAnswer& answer) noexcept {
  notify(answer);
  channel_.stopped.writing() = answer;
  channel_.stopped.publish();
  channel_.door_wake.signal();
}

void ControlLoop::answer_lost(const RequestOrigin& origin) noexcept {
  if (const auto* call = std::get_if<CallOrigin>(&origin)) {
    notify(KernelResponse{call->call_id, std::nullopt, 0});
  } else if (const auto* asked_stop = std::get_if<StopOrigin>(&origin)) {
    answer({asked_stop->stops, std::nullopt, 0});
  } else if (const auto* request = std::get_if<ModeOrigin>(&origin)) {
    modes_.on_verdict_lost(*request, view_.snapshot.state.system.tick);
  }
}

bool ControlLoop::room_for_events() const noexcept {
  return channel_.notices.write_available() > answer_reserve;
}

void ControlLoop::notify(const Notice& notice) noexcept {
  if (std::holds_alternative<ilk_event_t>(notice) && !room_for_events()) {
    ++events_dropped_;
    return;
  }
  noticed_ = channel_.notices.push(notice) || noticed_;
}

}  // namespace interlock
