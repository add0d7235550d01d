#include "http/api.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/steady_timer.hpp>
#include <random>

#include "http/same_origin.hpp"
#include "proposals/proposal_json.hpp"
#include "service/reply.hpp"
#include "service/status_json.hpp"
#include "service/targeting_store.hpp"
#include "store/settings.hpp"
#include "system/as_result.hpp"
#include "system/launch.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
using nlohmann::json;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds beat_period{33};
/** Ten times a second. */
constexpr std::uint32_t beats_per_biopsy = 3;
/** Without any request, and without an open stream, which counts as one. */
constexpr std::chrono::seconds holder_idle_limit{60};

/** Of this start of the app, and none before. */
std::int64_t some_epoch() {
  std::random_device draw;
  const std::uint64_t bits = static_cast<std::uint64_t>(draw()) << 32u | draw();
  return static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(latest_epoch)) + 1;
}

}  // namespace

bool is_always_answered(std::string_view path) { return path == "/api/stop" || path == "/api/status"; }

Api::Api(const boost::asio::any_io_executor& executor, const Robot& robot, const ilk_config_t& config,
         RealtimeChannel& channel, const std::string& bench_socket, StoreExecutor& store, Log& log,
         const Clocks& clocks, Past past)
    : control_(executor, channel),
      registry_(
          robot, config, [this](const Command& command) { return control_.send(command); }, clocks.utc),
      log_tail_(executor, log.ring(), stream_),
      bench_(executor, bench_socket),
      biopsy_(robot),
      sessions_(store, clocks),
      motion_control_(static_cast<std::uint32_t>(std::chrono::system_clock::to_time_t(clocks.utc()))),
      in_force_{some_epoch()},
      alarms_(robot, config),
      context_{executor,
               robot,
               config,
               control_,
               registry_,
               bench_,
               biopsy_,
               holds_,
               store,
               sessions_,
               motion_control_,
               work_,
               trajectory_,
               in_force_,
               declared_positions_,
               stops_,
               alarms_,
               log,
               [this](const json& message) { stream_.send_text(message); },
               clocks.utc,
               clocks.steady,
               role_refusals_},
      navigation_(context_),
      registration_watch_(robot, config),
      router_([this](const Caller& caller) -> std::optional<Problem> {
        const auto held = context_.need_control(caller);
        return held ? std::nullopt : std::optional(held.error());
      }),
      history_routes_(context_, std::move(past), router_) {
  follow_proposals();
  follow_kernel();
  follow_sessions();
  follow_streams();
}

Api::~Api() { context_.note(stops_.take()); }

void Api::follow_proposals() {
  registry_.on_change([this](const Proposal& proposal) {
    json message = to_json(proposal);
    spdlog::info("proposal {} of {}: {}: {}", proposal.id, proposal.task->author, state_name(proposal.state),
                 proposal.detail);
    AuditEntry entry = context_.entry({}, AuditKind::proposal, message);
    const auto& holding = motion_control_.holder();
    entry.actor = proposal.changed_by;
    if (holding && holding->user == proposal.task->author && holding->user == proposal.changed_by) {
      entry.session = holding->session;
    }
    context_.store.note(std::move(entry));
    message["type"] = "proposal";
    stream_.send_text(message);
    navigation_.tell(proposal);
    runs_.follow(proposal);
    alarms_.follow(proposal);
    const PathTask* path = proposal.work<PathTask>();
    if (proposal.state == ProposalState::done && path != nullptr && path->program == trajectory_.program) {
      trajectory_ = {};
    }
  });
  registry_.on_mode_change([this](std::string_view mode) {
    json message = mode_json(context_.robot, mode);
    message["type"] = "mode";
    stream_.send_text(message);
  });
}

void Api::follow_kernel() {
  // Before any answer of the kernel: whoever is answered finds expired what that request expired.
  control_.on_orders = [this] {
    look_after_registration(context_.view());
    publish_holds();
  };
  control_.on_event = [this](const ilk_event_t& event) {
    json message = event_json(event);
    spdlog::info("{}", event_words(context_.robot, event));
    stream_.send_text(message);
    // That the kernel stopped is in the record of the STOP, of which there may be thousands a second.
    const bool stopped = event.value[1] == ILK_REQUEST_STOP && event.value[3] == ILK_VERDICT_ACCEPTED;
    if (event.kind == ILK_EVENT_VERDICT && !stopped) {
      AuditEntry entry = context_.entry({}, AuditKind::verdict, std::move(message));
      entry.actor = audit_actor::kernel;
      entry.tick = event.tick;
      context_.store.note(std::move(entry));
    }
  };
  control_.on_events_lost = [this](const EventsLost& lost) {
    spdlog::warn("{} kernel events were lost", lost.count);
    stream_.send_text(events_lost_json(lost.count));
  };
}

void Api::follow_streams() {
  stream_.on_stop = [this](const Caller& caller) {
    control_.stop_unanswered();
    context_.record_stop(caller, 0);
  };
  stream_.on_change = [this](const Broadcaster::Subscriber& subscriber, bool opened) {
    stream_.send_text({{"type", "connection"},
                       {"change", opened ? "opened" : "closed"},
                       {"connection", "console"},
                       {"id", subscriber.id},
                       {"client", subscriber.caller.peer},
                       {"user", subscriber.caller.user}},
                      subscriber.id);
  };
}

void Api::follow_sessions() {
  sessions_.on_end([this](std::uint32_t session) {
    motion_control_.release(session);
    holds_.end_source({.session = session});
    stream_.end_session(session);
    if (bench_.held_by(session)) {
      std::string why = "Session " + std::to_string(session) + ", which pressed it, has ended.";
      launch(context_.executor, bench_.release_pedal(std::move(why)));
    }
  });
  motion_control_.on_change([this](bool holder_changed) {
    if (holder_changed) {
      control_.change_holder(motion_control_.number());
      registry_.abort_all("Control changed hands.");
      navigation_.change_holder();
      const auto& holding = motion_control_.holder();
      spdlog::warn("{} is in control", holding ? holding->user : "nobody");
      json detail{{"action", "change"},
                  {"holder", holding ? json(holding->user) : json()},
                  {"session", holding ? json(holding->session) : json()},
                  {"number", motion_control_.number()}};
      AuditEntry entry = context_.entry({}, AuditKind::control, std::move(detail));
      entry.actor = audit_actor::app;
      context_.store.note(std::move(entry));
    }
    stream_.send_text([this](const Caller& caller) {
      json message = motion_control_.shown_to(caller.session);
      message["type"] = "control";
      return message;
    });
  });
}

asio::awaitable<Reply> Api::route(const Request& request, const Caller& caller) {
  Reply reply = co_await router_.route(request, caller);
  if (!reply) {
    note_refusal(request, caller, reply.error());
  }
  co_return reply;
}

/** Without what changes from one attempt to the next, so that the log takes repetitions together. */
void Api::note_refusal(const Request& request, const Caller& caller, const Problem& problem) {
  if (problem.code != "ROLE") {
    return;
  }
  ++role_refusals_;
  spdlog::warn("{} was refused {} {}: {}", caller.user, std::string(request.method_string()),
               path_of(request), problem.detail);
}

asio::awaitable<tl::expected<Caller, Problem>> Api::caller_of(const Request& request, std::string peer) {
  Caller caller;
  caller.peer = std::move(peer);
  const auto session = co_await session_of(request);
  if (!session) {
    co_return fail(session.error());
  }
  if (*session) {
    caller.session = (*session)->number;
    caller.user = (*session)->user.name;
    caller.role = (*session)->user.role;
    sessions_.note_peer(caller.session, caller.peer);
  }
  co_return caller;
}

/** Of several cookies of the name, which pages of other ports of this machine can set, one that opens nothing
 * takes nothing away; two that open different sessions leave open which is meant. */
asio::awaitable<tl::expected<std::optional<Session>, Problem>> Api::session_of(const Request& request) {
  std::optional<Session> found;
  const std::string name = session_cookie(request);
  const std::vector<std::string> tokens = cookies_of(request, name);
  for (const std::string& token : tokens) {
    std::optional<Session> session = sessions_.find_at_hand(token);
    if (!session && !is_always_answered(path_of(request))) {
      auto stored = co_await sessions_.find(token);
      if (!stored) {
        co_return fail(stored.error());
      }
      session = std::move(*stored);
    }
    if (session && found && session->number != found->number) {
      co_return std::nullopt;
    }
    if (session) {
      found = std::move(session);
    }
  }
  co_return found;
}

asio::awaitable<void> Api::record_stop(StopMade made) {
  // Of now: the store may be a while.
  AuditEntry entry = context_.entry({}, AuditKind::stop, json::object());
  const auto known = co_await caller_of(made.header, made.peer);
  Caller stranger;
  stranger.peer = std::move(made.peer);
  context_.record_stop(known ? *known : stranger, made.unrecorded, std::move(entry));
}

void Api::tell_biopsy(const ControlView& seen) {
  if (!biopsy_.has_needle() || stream_.empty() || ++beats_ % beats_per_biopsy != 0) {
    return;
  }
  json message = biopsy_.to_json(seen, registry_.open_biopsy() != nullptr);
  message["type"] = "biopsy";
  stream_.send_text(message);
}

void Api::restore_holds(const json& kept) {
  context_.restore_holds(kept);
  kept_holds_ = kept;
}

asio::awaitable<void> Api::keep_holds() {
  auto work = [kept = kept_holds_, now = context_.clock()](Store& store) {
    return store.transact([&](Transaction& transaction) -> Stored<void> {
      Settings(transaction).set(HoldService::setting, kept, now);
      return {};
    });
  };
  if (const auto stored = co_await context_.store.run(std::move(work)); !stored) {
    spdlog::error("a restart of the app would forget what is held still: {}", stored.error().detail);
  }
}

/** Whenever something changed but the age of a scan. */
void Api::publish_holds() {
  json now = holds_.to_json();
  if (now != published_holds_) {
    published_holds_ = std::move(now);
    json message = holds_.to_json(context_.steady_clock());
    message["type"] = "holds";
    stream_.send_text(message);
  }
  if (json kept = holds_.kept(); kept != kept_holds_) {
    kept_holds_ = std::move(kept);
    launch(context_.executor, keep_holds());
  }
}

void Api::look_after_pedal(const ControlView& seen) {
  if (bench_.overdue(seen)) {
    spdlog::warn("the bench pedal was not renewed for 500 ms: released");
    launch(context_.executor,
           bench_.release_pedal("Its hold was not renewed for 500 ms, or the app stood still."));
  }
}

void Api::look_after_registration(const ControlView& seen) {
  std::string reason = registration_watch_.see(seen);
  if (!reason.empty()) {
    spdlog::warn("the registration expires, if there is one: {}", reason);
    launch(context_.executor, expire_registration(std::move(reason)));
  }
}

asio::awaitable<void> Api::expire_registration(std::string reason) {
  const Caller app;
  const auto kept = co_await interlock::expire_registration(context_, app, std::move(reason));
  if (!kept) {
    spdlog::error("why the registration expired is not kept: {}", kept.error().detail);
  }
}

void Api::look_after_alarms(const ControlView& seen) {
  const UtcTime time = context_.clock();
  const std::vector<Alarm> changed = alarms_.see(seen, context_.steady_clock(), time);
  for (const Alarm& alarm : changed) {
    const AlarmCondition& condition = alarm.condition;
    const std::string_view priority = alarm_priority_name(condition.priority);
    if (alarm.ended) {
      spdlog::info("alarm {} is over: {}", alarm.id, condition.text);
      continue;
    }
    spdlog::log(condition.priority == AlarmPriority::high ? spdlog::level::err : spdlog::level::warn,
                "alarm {}, priority {}: {} {}", alarm.id, priority, condition.text, condition.next_step);
    if (alarm.begun == time) {
      AuditEntry entry = context_.entry({}, AuditKind::alarm, to_json(alarm));
      entry.actor = audit_actor::app;
      context_.store.note(std::move(entry));
    }
  }
  if (!changed.empty()) {
    json message = alarms_.to_json();
    message["type"] = "alarms";
    stream_.send_text(message);
  }
}

void Api::look_after_sessions() {
  for (const Broadcaster::Subscriber& subscriber : stream_.subscribers()) {
    sessions_.touch(subscriber.caller.session);
  }
  if (const auto& holding = motion_control_.holder()) {
    const auto idle = sessions_.idle(holding->session);
    if (!idle || *idle >= holder_idle_limit) {
      spdlog::warn("{} was away for too long", holding->user);
      motion_control_.release(holding->session);
    }
  }
}

asio::awaitable<void> Api::sweep_sessions(std::chrono::milliseconds pause) {
  asio::steady_timer timer(context_.executor);
  for (;;) {
    co_await sessions_.sweep();
    context_.log.tell_repetitions();
    context_.note(stops_.due(context_.steady_clock()));
    timer.expires_after(pause);
    const auto [error] = co_await timer.async_wait(as_result);
    if (error) {
      co_return;
    }
  }
}

asio::awaitable<void> Api::broadcast() {
  asio::steady_timer timer(context_.executor, steady_clock::now());
  for (;;) {
    timer.expires_at(std::max(timer.expiry() + beat_period, steady_clock::now()));
    const auto [error] = co_await timer.async_wait(as_result);
    if (error) {
      co_return;
    }
    control_.say_served();
    history_routes_.keep(runs_);
    const ControlView& seen = context_.view();
    runs_.check();
    if (!stream_.empty()) {
      stream_.send_state(
          encode_state(seen, context_.config, open_targets(context_.robot, registry_), steady_clock::now()));
    }
    tell_biopsy(seen);
    publish_holds();
    look_after_pedal(seen);
    look_after_registration(seen);
    look_after_sessions();
    look_after_alarms(seen);
  }
}

}  // namespace interlock::web
