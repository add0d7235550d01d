#include "service/navigation.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "service/navigation_commands.hpp"
#include "service/reply.hpp"
#include "service/targeting_store.hpp"
#include "system/launch.hpp"

namespace interlock {
namespace {

namespace asio = boost::asio;
using igtl::PeerId;
using igtl::StatusCode;
using nlohmann::json;

constexpr auto navigation_result = asio::as_tuple(asio::use_awaitable);
constexpr std::chrono::milliseconds fastest_tracking{20};
constexpr const char* health_name = "robot_status";

igtl::Motion motion_of(const Proposal& proposal) {
  const bool failed = proposal.state == ProposalState::refused || proposal.state == ProposalState::aborted ||
                      proposal.state == ProposalState::expired;
  return {proposal.id,
          !is_open(proposal.state),
          {failed ? StatusCode::not_ready : StatusCode::ok, proposal.id,
           std::string(state_name(proposal.state)), proposal.detail}};
}

bool asks_for_motion(const igtl::Command& command) {
  return std::holds_alternative<igtl::SetMode>(command) || std::holds_alternative<igtl::StartUp>(command) ||
         std::holds_alternative<igtl::MoveToTarget>(command) ||
         std::holds_alternative<igtl::RetractProbe>(command);
}

igtl::Status stopped_before() {
  return {StatusCode::not_ready, 0, "STOPPED", "A stop came before its turn; ask for it again."};
}

}  // namespace

Navigation::Navigation(const Context& context)
    : context_(context), server_(context.executor), news_(context.executor, SteadyTime::max()) {
  listen_to_server();
}

void Navigation::start(NavigationOptions options) {
  options_ = std::move(options);
  if (options_.connect) {
    launch(context_.executor, server_.keep_connected(*options_.connect, connect_pause));
  }
  launch(context_.executor, server_.accept());
  launch(context_.executor, server_.heartbeat());
  launch(context_.executor, work());
  launch(context_.executor, keep_targeting());
  launch(context_.executor, tell_all());
}

void Navigation::listen_to_server() {
  server_.on_open = [this](PeerId peer) {
    sessions_[peer].dialect = igtl::make_dialect(options_.dialect);
    if (const auto opened = server_.find(peer)) {
      announce("opened", *opened);
    }
    let_first_control();
  };
  server_.on_message = [this](PeerId peer, const igtl::Message& message) { take(peer, message); };
  server_.on_refused = [this](PeerId peer, const igtl::Header& header, const igtl::FaultAt& fault) {
    const std::string place = fault.place.empty() ? "" : ", " + fault.place;
    const std::string text = header.type + place + ": " + std::string(igtl::fault_text(fault)) + ".";
    spdlog::warn("OpenIGTLink connection {}: \"{}\" was refused: {}", peer, header.device, text);
    const igtl::Status status{igtl::status_of(fault), 0, "FORMAT", text};
    react(peer, header.device, sessions_.at(peer).dialect->take_broken(header.device, status));
  };
  server_.is_in_motion = [this] { return is_moving(); };
  server_.on_close = [this](const igtl::Peer& peer, const std::string& reason) { lose(peer, reason); };
}

void Navigation::note_refusal(PeerId peer, const std::string& device, const std::string& reason) {
  server_.count_refusal(peer);
  spdlog::warn("OpenIGTLink connection {}: \"{}\" was refused: {}", peer, device, reason);
}

void Navigation::take(PeerId peer, const igtl::Message& message) {
  if (const auto hold = igtl::read_hold(message)) {
    igtl::Status status;
    if (!*hold) {
      status = {hold->error().code, 0, "UNWANTED", hold->error().reason};
    } else if (auto done = obey(peer, **hold)) {
      status = {StatusCode::ok, 0, "OK", std::move(*done)};
    } else {
      status = status_of(done.error());
    }
    if (status.code != StatusCode::ok) {
      note_refusal(peer, message.device, status.text);
    }
    server_.reply(peer, message.device, status);
    return;
  }
  react(peer, message.device, sessions_.at(peer).dialect->take(message, state(), grant_of(peer).has_value()));
}

HoldSource Navigation::source_of(PeerId peer) const {
  const auto sender = server_.find(peer);
  return {.peer = peer, .name = "OpenIGTLink " + (sender ? sender->address : std::to_string(peer))};
}

/** At once, and whoever says so, where that holds motion back: the gate is opened by the controller alone,
 * and a scan is ended by it or by its source. */
tl::expected<std::string, Problem> Navigation::obey(PeerId peer, const igtl::HoldMessage& message) {
  const HoldSource source = source_of(peer);
  const auto grant = grant_of(peer);
  if (const auto* signal = std::get_if<igtl::GateSignal>(&message)) {
    if (signal->open && !grant) {
      return fail(grant.error());
    }
    const std::string noted =
        context_.holds.gate_in_use() ? "Taken." : "Taken; the breathing gate is not in use.";
    return context_.holds.signal(source, *signal, std::chrono::steady_clock::now()).map([&] {
      return noted;
    });
  }
  const bool active = std::get<igtl::ScanState>(message).active;
  if (!active) {
    if (const auto may = context_.holds.may_end_scan(source, grant.has_value()); !may) {
      return fail(may.error());
    }
  }
  if (active == context_.holds.scanning()) {
    return active ? "A scan goes on already." : "No scan goes on.";
  }
  active ? context_.begin_scan(source) : context_.end_scan();
  json detail{{"scan", active ? "begun" : "ended"}, {"client", source.name}};
  context_.store.note(context_.entry(grant.value_or(Caller{}), AuditKind::setting, std::move(detail)));
  return active ? "Everything is held still." : "Motion may be approved again.";
}

/** A STOP goes out before anything is said of it. */
void Navigation::react(PeerId peer, const std::string& device, igtl::Reaction reaction) {
  const bool stops = reaction.command && std::holds_alternative<igtl::Stop>(*reaction.command);
  std::optional<Stopping> stopping;
  if (stops) {
    stopping = stop(peer);
  }
  if (reaction.ends) {
    end_motion(*reaction.ends);
  }
  if (!reaction.refused.empty()) {
    note_refusal(peer, device, reaction.refused);
  }
  if (reaction.word) {
    const auto sender = server_.find(peer);
    imager_.hear(*reaction.word, sender ? sender->address : "", context_.clock(), context_.steady_clock());
  }
  for (const auto& [name, body] : reaction.replies) {
    server_.reply(peer, name, body);
  }
  if (stopping) {
    launch(context_.executor, finish_stop(peer, device, std::move(*reaction.command), std::move(*stopping)));
  } else if (reaction.command) {
    enqueue(peer, device, std::move(*reaction.command));
  }
}

void Navigation::enqueue(PeerId peer, const std::string& device, igtl::Command command) {
  if (const auto* tracking = std::get_if<igtl::Track>(&command)) {
    track(peer, *tracking);
  } else if (tasks_.size() >= backlog) {
    finish(peer, device, command,
           {{StatusCode::busy, 0, "BUSY", "Too much waits to be done; send it again."}});
  } else {
    tasks_.push_back({peer, device, std::move(command), context_.control.stops()});
    news_.cancel();
  }
}

void Navigation::finish(PeerId peer, const std::string& device, const igtl::Command& command,
                        const igtl::Outcome& outcome) {
  const auto session = sessions_.find(peer);
  if (session == sessions_.end()) {
    if (outcome.proposal) {
      end_motion(*outcome.proposal);
    }
    return;
  }
  if (outcome.status.code != StatusCode::ok) {
    note_refusal(peer, device, outcome.status.text);
  }
  react(peer, device, session->second.dialect->finish(device, command, outcome));
}

/** Nobody wants it any more. */
void Navigation::end_motion(std::uint32_t proposal, const std::string& by) {
  const Proposal* open = context_.registry.find(proposal);
  if (open != nullptr && is_open(open->state) && !context_.registry.abort(proposal, by)) {
    (void)context_.control.stop();
    context_.registry.abort_all(
        "A navigation program ended its motion, and the control thread took no command.");
  }
}

/** Anybody may stop the robot; nothing is waited for before it is sent. */
Navigation::Stopping Navigation::stop(PeerId peer) {
  auto answered = context_.control.stop();
  const auto sender = server_.find(peer);
  Caller caller = grant_of(peer).value_or(Caller{});
  caller.peer = "openigtlink " + (sender ? sender->address : "");
  caller.is_program = true;
  context_.record_stop(caller, 0);
  return answered;
}

asio::awaitable<void> Navigation::finish_stop(PeerId peer, std::string device, igtl::Command command,
                                              Stopping stopping) {
  const igtl::Outcome outcome =
      co_await stopped(context_, std::move(stopping), std::get<igtl::Stop>(command).cuts_power);
  finish(peer, device, command, outcome);
}

void Navigation::track(PeerId peer, const igtl::Track& command) {
  std::optional<std::chrono::milliseconds> interval;
  if (command.interval_ms) {
    interval = std::max(std::chrono::milliseconds(*command.interval_ms), fastest_tracking);
  }
  sessions_.at(peer).tracking = interval;
  server_.reply(peer, "", igtl::TrackingReply{true});
}

/** A robot whose controller is gone pauses, whatever it moves for: somebody has to look, and to press the
 * pedal anew. What the program had asked for goes on only until another one takes its place. */
void Navigation::lose(const igtl::Peer& peer, const std::string& reason) {
  announce("closed", peer, reason);
  context_.holds.end_source({.peer = peer.id});
  sessions_.erase(peer.id);
  std::erase_if(tasks_, [&](const WaitingCommand& task) { return task.peer == peer.id; });
  if (!grant_ || grant_->peer != peer.id) {
    return;
  }
  const bool moves = context_.registry.may_move();
  context_.control.pause();
  spdlog::warn("the OpenIGTLink controller {} was lost: {}", peer.address, reason);
  context_.registry.lose_author(TaskSource::openigtlink, "The OpenIGTLink controller was lost.");
  for (const Proposal& each : context_.registry.newest_first()) {
    if (is_open(each.state) && each.task->source == TaskSource::openigtlink) {
      orphans_.push_back(each.id);
    }
  }
  json detail{{"action", "controller lost"}, {"client", peer.address}, {"reason", reason}, {"paused", moves}};
  context_.store.note(context_.entry(grant_->caller, AuditKind::connection, std::move(detail)));
  grant_.reset();
}

/** Consoles learn of it without asking. */
void Navigation::announce(const char* change, const igtl::Peer& peer, const std::string& reason) {
  json message{{"type", "connection"}, {"change", change},       {"connection", "openigtlink"},
               {"id", peer.id},        {"client", peer.address}, {"role", igtl::role_word(peer.role)}};
  if (!reason.empty()) {
    message["reason"] = reason;
  }
  context_.publish(message);
}

bool Navigation::give_role(PeerId id, igtl::Role role) {
  const auto before = server_.find(id);
  if (!before || !server_.set_role(id, role)) {
    return false;
  }
  if (before->role != role) {
    announce("role", *server_.find(id));
  }
  return true;
}

bool Navigation::set_role(PeerId id, igtl::Role role, const Caller& caller) {
  if (!give_role(id, role)) {
    return false;
  }
  if (role == igtl::Role::controller) {
    for (const std::uint32_t orphan : std::exchange(orphans_, {})) {
      end_motion(orphan, caller.user);
    }
    if (grant_ && grant_->peer != id) {
      give_role(grant_->peer, igtl::Role::observer);
    }
    grant_ = {id, caller, context_.motion_control.number()};
    grant_->caller.is_program = true;
    grant_->caller.peer = "openigtlink " + server_.find(id)->address;
  } else if (grant_ && grant_->peer == id) {
    grant_.reset();
  }
  return true;
}

void Navigation::change_holder() {
  if (grant_) {
    give_role(grant_->peer, igtl::Role::observer);
    grant_.reset();
  }
  let_first_control();
}

/** The oldest connection, when the robot's file says so and there is no other controller. */
void Navigation::let_first_control() {
  const auto& holding = context_.motion_control.holder();
  const std::vector<igtl::Peer> peers = server_.peers();
  if (!options_.first_controls || grant_ || !holding || peers.empty()) {
    return;
  }
  const auto session = context_.sessions.known(holding->session);
  if (!session) {
    return;
  }
  const Caller caller{holding->session, holding->user, session->user.role, peers.front().address};
  json detail{{"action", "role"},
              {"id", peers.front().id},
              {"client", peers.front().address},
              {"role", "controller"}};
  context_.store.note(context_.entry(caller, AuditKind::connection, std::move(detail)));
  set_role(peers.front().id, igtl::Role::controller, caller);
}

tl::expected<Caller, Problem> Navigation::grant_of(PeerId peer) const {
  if (!grant_ || grant_->peer != peer || grant_->hold != context_.motion_control.number()) {
    return fail({.status = Status::conflict,
                 .code = "CONTROL",
                 .detail = "This connection is an observer.",
                 .expected = "the role of the controller",
                 .next_step = "Whoever is in control gives it in the console's panel Navigation."});
  }
  Caller caller = grant_->caller;
  caller.asked = std::chrono::steady_clock::now();
  return caller;
}

/** Whether somebody asked for a stop after it had asked for motion. */
bool Navigation::is_overtaken(const WaitingCommand& task) const {
  return asks_for_motion(task.command) && context_.control.stops() != task.stops;
}

asio::awaitable<void> Navigation::work() {
  for (;;) {
    if (tasks_.empty()) {
      news_.expires_at(SteadyTime::max());
      co_await news_.async_wait(navigation_result);
      continue;
    }
    const WaitingCommand task = std::move(tasks_.front());
    tasks_.pop_front();
    igtl::Outcome outcome;
    if (const auto caller = grant_of(task.peer); !caller) {
      outcome.status = status_of(caller.error());
    } else if (is_overtaken(task)) {
      outcome.status = stopped_before();
    } else {
      outcome = co_await carry_out(context_, *caller, task.device, task.command);
    }
    if (outcome.proposal && is_overtaken(task)) {
      end_motion(*outcome.proposal);
      outcome = {stopped_before()};
    }
    co_await refresh_targeting();
    finish(task.peer, task.device, task.command, outcome);
  }
}

/** Later: the registry is in the middle of what it tells. */
void Navigation::tell(const Proposal& proposal) {
  if (proposal.task->source == TaskSource::openigtlink) {
    asio::post(context_.executor, [this, motion = motion_of(proposal)] { follow(motion); });
  }
}

void Navigation::follow(const igtl::Motion& motion) {
  for (auto& [peer, session] : sessions_) {
    for (const auto& [name, body] : session.dialect->follow(motion, state())) {
      server_.reply(peer, name, body);
    }
  }
}

/** Apart from `tell_all`, which waits for no store. */
asio::awaitable<void> Navigation::keep_targeting() {
  asio::steady_timer timer(context_.executor);
  for (;;) {
    timer.expires_after(fastest_tracking);
    const auto [error] = co_await timer.async_wait(navigation_result);
    if (error) {
      co_return;
    }
    co_await refresh_targeting();
  }
}

asio::awaitable<void> Navigation::tell_all() {
  asio::steady_timer timer(context_.executor);
  SteadyTime next_telling;
  SteadyTime next_due;
  for (;;) {
    timer.expires_after(fastest_tracking);
    const auto [error] = co_await timer.async_wait(navigation_result);
    if (error) {
      co_return;
    }
    if (server_.empty() || !targeting_revision_) {
      continue;
    }
    const SteadyTime now = std::chrono::steady_clock::now();
    if (now >= next_telling) {
      next_telling = now + telling_period;
      const std::uint32_t tick = context_.view().snapshot.state.system.tick;
      velocities_.measure(context_.robot, context_.view());
      probe_velocity_.measure(tick, context_.robot.period_us, state().measured_cp);
      tell_messages(now);
    }
    if (now >= next_due) {
      next_due = now + (is_moving() ? motion_period : telling_period);
      tell_what_is_due(now);
    }
    tell_tracking(now);
  }
}

void Navigation::tell_messages(SteadyTime now) {
  const igtl::RobotState present = state();
  for (auto& [peer, session] : sessions_) {
    const bool is_health_due = now - session.health >= health_period;
    const igtl::Outgoings messages = session.dialect->told(present);
    std::erase_if(session.told, [&](const auto& each) {
      return std::ranges::find(messages, each.first, &igtl::Outgoing::first) == messages.end();
    });
    for (const auto& [name, body] : messages) {
      const bool is_health = name == health_name;
      const auto before = session.told.find(name);
      if (before == session.told.end() || before->second != body || (is_health && is_health_due)) {
        session.told.insert_or_assign(name, body);
        session.health = is_health ? now : session.health;
        server_.show(peer, name, body);
      }
    }
  }
}

/** Whether a motion is approved that a controller's loss has to end. */
bool Navigation::is_moving() const { return grant_ && context_.registry.may_move(); }

/** In order with the answers. */
void Navigation::tell_what_is_due(SteadyTime now) {
  const igtl::RobotState present = state();
  for (auto& [peer, session] : sessions_) {
    const bool has_to_hear = is_moving() && grant_->peer == peer;
    for (const auto& [name, body] : session.dialect->heartbeat(now, present, has_to_hear)) {
      server_.reply(peer, name, body);
    }
  }
}

void Navigation::tell_tracking(SteadyTime now) {
  std::optional<igtl::TrackingData> tracking;
  for (auto& [peer, session] : sessions_) {
    if (session.tracking && now - session.tracked >= *session.tracking) {
      tracking = tracking ? tracking : igtl::tracking_of(state());
      session.tracked = now;
      server_.show(peer, "robot", *tracking);
    }
  }
}

/** Read anew when it changed, by whomever. */
asio::awaitable<void> Navigation::refresh_targeting() {
  const std::uint32_t revision = context_.registry.targeting_revision();
  if (targeting_revision_ == revision) {
    co_return;
  }
  const auto present = co_await present_targeting(context_);
  if (present) {
    targeting_ = *present;
    targeting_revision_ = revision;
  }
}

/** No pose is told before it is known what the probe is like. */
igtl::RobotState Navigation::state() const {
  igtl::RobotState state = robot_state(context_, targeting_, velocities_);
  state.measured_cv = probe_velocity_.per_s();
  if (!targeting_revision_) {
    state.measured_cp.reset();
    state.desired_cp.reset();
    state.measured_cf.reset();
  }
  return state;
}

}  // namespace interlock
