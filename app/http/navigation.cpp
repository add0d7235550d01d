#include "http/navigation.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

#include "http/alignment_view.hpp"
#include "http/path_drafts.hpp"
#include "http/problems.hpp"
#include "http/proposing.hpp"
#include "http/targeting_change.hpp"
#include "http/targeting_store.hpp"
#include "http/trajectory_loading.hpp"
#include "robot/catalog.hpp"
#include "trajectory/trajectory_builder.hpp"

namespace interlock::web {
namespace {

namespace asio = boost::asio;
using igtl::PeerId;
using igtl::StatusCode;
using nlohmann::json;

constexpr auto navigation_result = asio::as_tuple(asio::use_awaitable);
constexpr std::chrono::milliseconds fastest_tracking{20};
constexpr const char* health_name = "robot_status";
constexpr const char* known_modes = "manual, trajectory, draping, targeting or insertion";

const std::vector<std::string>& capabilities() {
  static const std::vector<std::string> types{"TRANSFORM", "STRING", "STATUS",      "POINT",     "POSITION",
                                              "NDARRAY",   "TDATA",  "GET_CAPABIL", "STT_TDATA", "STP_TDATA"};
  return types;
}

StatusCode status_code(const Problem& problem) {
  static const std::map<std::string, StatusCode> codes{
      {"AUTHORITY", StatusCode::access_denied},  {"LOGIN", StatusCode::access_denied},
      {"ROLE", StatusCode::access_denied},       {"OVERLOADED", StatusCode::busy},
      {"UNREACHABLE", StatusCode::unreachable},  {"INVALID", StatusCode::configuration},
      {"MODE", StatusCode::unknown_instruction}, {"NOT_FOUND", StatusCode::not_found},
      {"INTERNAL", StatusCode::unknown_error}};
  const auto found = codes.find(problem.code);
  if (found != codes.end()) {
    return found->second;
  }
  return problem.status == Status::unprocessable_entity ? StatusCode::configuration : StatusCode::not_ready;
}

igtl::Status status_of(const Problem& problem) {
  std::string text = problem.detail;
  text += problem.expected.empty() ? "" : " Expected: " + problem.expected + ".";
  text += problem.next_step.empty() ? "" : " " + problem.next_step;
  return {status_code(problem), 0, problem.code, std::move(text)};
}

/** What the body of a change of targeting says, and who reads it. */
struct Asked {
  TargetingChange make;
  json body;
};

std::optional<Asked> targeting_of(const igtl::Wish& wish) {
  if (const auto* registration = std::get_if<igtl::SetRegistration>(&wish)) {
    return Asked{with_registration, {{"registration", registration->scanner_from_robot}}};
  }
  if (const auto* pose = std::get_if<igtl::ReportPose>(&wish)) {
    return Asked{with_reported_pose, {{"current_position", pose->scanner_from_probe}}};
  }
  if (const auto* point = std::get_if<igtl::SetPoint>(&wish)) {
    return Asked{with_target, {{point->is_target ? "target_point" : "entry_point", point->position}}};
  }
  if (const auto* offset = std::get_if<igtl::SetOffset>(&wish)) {
    return Asked{with_target, {{std::string(offset->field), offset->mm}}};
  }
  return std::nullopt;
}

/** Names of the columns: a time, then a position, or a position and a velocity, of each axis of the robot. */
tl::expected<std::vector<std::string>, Problem> columns_of(const Robot& robot, std::size_t count) {
  const std::size_t axes = robot.axes.size();
  if (count != 1 + axes && count != 1 + 2 * axes) {
    return fail({.status = Status::unprocessable_entity,
                 .code = "COLUMNS",
                 .detail = "The trajectory has " + std::to_string(count) + " columns.",
                 .expected = std::to_string(1 + axes) + " (time and positions) or " +
                             std::to_string(1 + 2 * axes) + " (with velocities), axes in the file's order"});
  }
  std::vector<std::string> columns{"time [s]"};
  for (const Axis& axis : robot.axes) {
    const std::string unit(unit_name(axis.unit));
    columns.push_back(axis.name + " [" + unit + "]");
    if (count != 1 + axes) {
      columns.push_back(axis.name + " [" + unit + "/s]");
    }
  }
  return columns;
}

TrajectoryResult<TimedTrajectory> built(const igtl::LoadRows& rows, std::vector<std::string> columns,
                                        const Robot& robot) {
  auto builder = TrajectoryBuilder::create(std::move(columns), robot, velocity_limits(robot));
  if (!builder) {
    return tl::unexpected(builder.error());
  }
  for (std::size_t at = 0; at < rows.values.size(); at += rows.columns) {
    if (const auto added = builder->add({&rows.values[at], rows.columns}); !added) {
      return tl::unexpected(added.error());
    }
  }
  return std::move(*builder).finish();
}

/** Of each axis, in its unit; none without a kernel. */
std::vector<double> positions_in(const Robot& robot, const ControlView& view) {
  std::vector<double> positions;
  for (const Axis& axis : robot.axes) {
    if (view.attached) {
      positions.push_back(axis.to_unit(view.snapshot.state.axis[axis.slot].position_counts));
    }
  }
  return positions;
}

igtl::Status health_of(const ControlView& view) {
  if (!view.attached) {
    return {StatusCode::not_ready, 0, "NO_KERNEL", "No kernel is connected."};
  }
  const std::string mode = catalog::name(catalog::Family::mode, view.snapshot.state.mode);
  if (view.snapshot.state.mode == ILK_MODE_LOCKED) {
    return {StatusCode::hardware_failure, 0, mode, "The kernel is locked; the console says why."};
  }
  return {StatusCode::ok, 0, mode, "The kernel is in mode " + mode + "."};
}

}  // namespace

Navigation::Navigation(const Context& context)
    : context_(context), hub_(context.executor), news_(context.executor, SteadyTime::max()) {
  listen_to_hub();
}

void Navigation::start() {
  asio::co_spawn(context_.executor, hub_.accept(), asio::detached);
  asio::co_spawn(context_.executor, hub_.beat(), asio::detached);
  asio::co_spawn(context_.executor, work(), asio::detached);
  asio::co_spawn(context_.executor, tell_all(), asio::detached);
}

void Navigation::listen_to_hub() {
  hub_.on_open = [this](PeerId peer) { told_[peer] = {}; };
  hub_.on_message = [this](PeerId peer, const igtl::Message& message) { take(peer, message); };
  hub_.on_refused = [this](PeerId peer, const igtl::Header& header, igtl::Fault fault) {
    refuse(peer, header.device,
           {igtl::status_of(fault), 0, "FORMAT",
            header.type + ": " + std::string(igtl::fault_text(fault)) + "."});
  };
  hub_.on_close = [this](const igtl::Peer& peer, const std::string& reason) { lose(peer, reason); };
}

void Navigation::answer(PeerId peer, const std::string& device, const std::string& text) {
  hub_.reply(peer, device, igtl::Status{StatusCode::ok, 0, "OK", text});
}

void Navigation::refuse(PeerId peer, const std::string& device, const igtl::Status& status) {
  spdlog::warn("OpenIGTLink connection {}: \"{}\" was refused: {}", peer, device, status.text);
  hub_.reply(peer, device, status);
}

void Navigation::take(PeerId peer, const igtl::Message& message) {
  auto wish = igtl::read_wish(message);
  if (!wish) {
    hub_.count_refusal(peer);
    refuse(peer, message.device, {wish.error().code, 0, "UNWANTED", wish.error().reason});
  } else if (std::holds_alternative<igtl::Stop>(*wish)) {
    stop(peer, message.device);
  } else if (const auto* noted = std::get_if<igtl::Noted>(&*wish)) {
    if (noted->is_answered) {
      answer(peer, message.device, "Noted.");
    }
  } else if (const auto* wanted = std::get_if<igtl::Show>(&*wish)) {
    show(peer, *wanted);
  } else if (const auto* tracking = std::get_if<igtl::Track>(&*wish)) {
    track(peer, *tracking);
  } else if (tasks_.size() >= backlog) {
    hub_.count_refusal(peer);
    refuse(peer, message.device, {StatusCode::busy, 0, "BUSY", "Too much waits to be done; send it again."});
  } else {
    tasks_.push_back({peer, message.device, std::move(*wish)});
    news_.cancel();
  }
}

/** Anybody may stop the robot; nothing is waited for. */
void Navigation::stop(PeerId peer, const std::string& device) {
  (void)context_.control.stop();
  const auto sender = hub_.find(peer);
  const std::string address = sender ? sender->address : "";
  spdlog::warn("STOP by OpenIGTLink peer {}", address);
  context_.book.abort_all("STOP.");
  context_.store.note(context_.entry({}, AuditKind::stop, {{"peer", "openigtlink " + address}}));
  answer(peer, device, "STOP was sent to the kernel.");
}

void Navigation::track(PeerId peer, const igtl::Track& wish) {
  std::optional<std::chrono::milliseconds> interval;
  if (wish.interval_ms) {
    interval = std::max(std::chrono::milliseconds(*wish.interval_ms), fastest_tracking);
  }
  told_[peer].tracking = interval;
  hub_.reply(peer, "", igtl::TrackingReply{true});
}

void Navigation::show(PeerId peer, const igtl::Show& wish) {
  if (igtl::asks_for(wish.query, "CAPABILITY")) {
    hub_.reply(peer, wish.device, igtl::Capability{capabilities()});
    return;
  }
  const igtl::RobotState now = state();
  if (igtl::asks_for(wish.query, "TDATA")) {
    hub_.reply(peer, wish.device, igtl::tracking_of(now));
    return;
  }
  bool any = false;
  for (const auto& [name, body] : igtl::messages_of(now)) {
    if (igtl::asks_for(wish.query, igtl::type_of(body)) && (wish.device.empty() || wish.device == name)) {
      hub_.reply(peer, name, body);
      any = true;
    }
  }
  if (!any) {
    hub_.count_refusal(peer);
    refuse(peer, wish.device,
           {StatusCode::not_found, 0, "NOT_FOUND",
            "There is no " + wish.query.type + " \"" + wish.device + "\" now."});
  }
}

/** A robot that moves for a program which is gone stops. */
void Navigation::lose(const igtl::Peer& peer, const std::string& reason) {
  told_.erase(peer.id);
  std::erase_if(tasks_, [&](const Task& task) { return task.peer == peer.id; });
  if (!mandate_ || mandate_->peer != peer.id) {
    return;
  }
  const std::vector<Proposal> proposals = context_.book.newest_first();
  const bool moves =
      std::ranges::any_of(proposals, [](const Proposal& each) { return is_approved(each.state); });
  if (moves) {
    (void)context_.control.stop();
  }
  spdlog::warn("the OpenIGTLink controller {} was lost: {}", peer.address, reason);
  context_.book.abort_all("The OpenIGTLink controller was lost.");
  json detail{
      {"action", "controller lost"}, {"client", peer.address}, {"reason", reason}, {"stopped", moves}};
  context_.store.note(context_.entry(mandate_->caller, AuditKind::connection, std::move(detail)));
  mandate_.reset();
}

bool Navigation::set_role(PeerId id, igtl::Role role, const Caller& caller) {
  if (!hub_.set_role(id, role)) {
    return false;
  }
  if (role == igtl::Role::controller) {
    if (mandate_ && mandate_->peer != id) {
      hub_.set_role(mandate_->peer, igtl::Role::observer);
    }
    mandate_ = {id, caller, context_.authority.number()};
    mandate_->caller.peer = "openigtlink " + hub_.find(id)->address;
  } else if (mandate_ && mandate_->peer == id) {
    mandate_.reset();
  }
  return true;
}

void Navigation::drop_controller() {
  if (mandate_) {
    hub_.set_role(mandate_->peer, igtl::Role::observer);
    mandate_.reset();
  }
}

tl::expected<Caller, Problem> Navigation::mandate_of(PeerId peer) const {
  if (!mandate_ || mandate_->peer != peer || mandate_->hold != context_.authority.number()) {
    return fail({.status = Status::conflict,
                 .code = "AUTHORITY",
                 .detail = "This connection is an observer.",
                 .expected = "the role of the controller",
                 .next_step = "Whoever holds the motion authority gives it under Communication."});
  }
  return mandate_->caller;
}

asio::awaitable<void> Navigation::work() {
  for (;;) {
    if (tasks_.empty()) {
      news_.expires_at(SteadyTime::max());
      co_await news_.async_wait(navigation_result);
      continue;
    }
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    const auto caller = mandate_of(task.peer);
    Done done = caller.map([](const Caller&) { return std::string(); });
    if (caller) {
      done = co_await carry_out(task, *caller);
    }
    if (done) {
      answer(task.peer, task.device, *done);
    } else {
      hub_.count_refusal(task.peer);
      refuse(task.peer, task.device, status_of(done.error()));
    }
  }
}

asio::awaitable<Navigation::Done> Navigation::carry_out(const Task& task, const Caller& caller) {
  json detail{{"action", "message"}, {"name", task.device}, {"client", caller.peer}};
  context_.store.note(context_.entry(caller, AuditKind::connection, std::move(detail)));
  std::string thrown;
  try {
    if (const auto* rows = std::get_if<igtl::LoadRows>(&task.wish)) {
      co_return co_await load(caller, *rows);
    }
    if (const auto* mode = std::get_if<igtl::SetMode>(&task.wish)) {
      co_return co_await enter_mode(caller, mode->mode);
    }
    co_return co_await change(caller, task.wish);
  } catch (const std::exception& exception) {
    thrown = exception.what();
  }
  spdlog::critical("OpenIGTLink message \"{}\" threw: {}", task.device, thrown);
  co_return fail(
      {.code = "INTERNAL", .detail = "The app failed to do it.", .next_step = "Report it with the log."});
}

asio::awaitable<Navigation::Done> Navigation::change(const Caller& caller, const igtl::Wish& wish) {
  auto asked = targeting_of(wish);
  if (!asked) {
    co_return fail({.code = "INTERNAL", .detail = "Nobody carries out such a wish."});
  }
  const auto changed = co_await change_targeting(context_, caller, asked->make, std::move(asked->body));
  co_return changed.map([](const Targeting&) { return std::string("It was stored."); });
}

asio::awaitable<Navigation::Done> Navigation::load(const Caller& caller, const igtl::LoadRows& rows) {
  auto columns = columns_of(context_.robot, rows.columns);
  if (!columns) {
    co_return fail(columns.error());
  }
  auto work = [rows, columns = std::move(*columns), robot = &context_.robot] {
    return built(rows, columns, *robot);
  };
  auto done = co_await context_.work.run(std::move(work));
  if (!done) {
    co_return fail(done.error());
  }
  if (!*done) {
    co_return fail(unreadable(done->error()));
  }
  const auto loaded = co_await load_trajectory(context_, caller, std::move(**done));
  co_return loaded.map([] { return std::string("The trajectory was loaded."); });
}

Navigation::Done Navigation::go_manual() const {
  (void)context_.view();
  const Proposal* open = context_.book.open_mode();
  if (open != nullptr) {
    if (const auto ended = context_.book.abort(open->id); !ended) {
      return fail(refused(ended.error()));
    }
  }
  return "The robot is in manual mode.";
}

asio::awaitable<Navigation::Done> Navigation::enter_mode(const Caller& caller, std::string mode) {
  if (mode == "manual") {
    co_return go_manual();
  }
  tl::expected<PathDraft, Problem> draft = fail({.status = Status::conflict,
                                                 .code = "MODE",
                                                 .detail = "\"" + mode + "\" cannot be had from here.",
                                                 .expected = known_modes,
                                                 .next_step = "Homing is started in the console."});
  if (mode == "trajectory") {
    draft = trajectory_draft(context_.trajectory, caller.user);
  } else if (mode == "draping") {
    draft = draping_draft(context_.robot, caller.user);
  } else if (mode == "targeting" || mode == "insertion") {
    draft = co_await pose_draft(context_, PoseWish{false, mode == "insertion"}, caller.user);
  }
  if (!draft) {
    co_return fail(draft.error());
  }
  draft->source = ProposalSource::openigtlink;
  Draft wanted = std::move(*draft);
  const auto made = co_await propose(context_, caller, std::move(wanted));
  co_return made.map([](const Proposal& proposal) {
    return "Proposal " + std::to_string(proposal.id) + ": " + proposal.detail;
  });
}

void Navigation::tell(const Proposal& proposal) {
  if (proposal.kind != ProposalKind::path || proposal.path.source != ProposalSource::openigtlink) {
    return;
  }
  const bool failed = proposal.state == ProposalState::refused || proposal.state == ProposalState::aborted ||
                      proposal.state == ProposalState::expired;
  const igtl::Status status{failed ? StatusCode::not_ready : StatusCode::ok, proposal.id,
                            std::string(state_name(proposal.state)), proposal.detail};
  for (const igtl::Peer& peer : hub_.peers()) {
    hub_.reply(peer.id, "proposal", status);
  }
}

asio::awaitable<void> Navigation::tell_all() {
  asio::steady_timer timer(context_.executor);
  SteadyTime next_telling;
  for (;;) {
    timer.expires_after(fastest_tracking);
    const auto [error] = co_await timer.async_wait(navigation_result);
    if (error) {
      co_return;
    }
    if (hub_.empty()) {
      continue;
    }
    co_await refresh_targeting();
    const SteadyTime now = std::chrono::steady_clock::now();
    if (now >= next_telling) {
      next_telling = now + telling_period;
      measure_velocities();
      tell_messages(now);
    }
    tell_tracking(now);
  }
}

void Navigation::tell_messages(SteadyTime now) {
  const std::vector<igtl::Outgoing> messages = igtl::messages_of(state());
  for (auto& [peer, told] : told_) {
    const bool is_health_due = now - told.health >= health_period;
    for (const auto& [name, body] : messages) {
      const bool is_health = name == health_name;
      const auto before = told.messages.find(name);
      if (before == told.messages.end() || before->second != body || (is_health && is_health_due)) {
        told.messages.insert_or_assign(name, body);
        told.health = is_health ? now : told.health;
        hub_.show(peer, name, body);
      }
    }
  }
}

void Navigation::tell_tracking(SteadyTime now) {
  std::optional<igtl::TrackingData> tracking;
  for (auto& [peer, told] : told_) {
    if (told.tracking && now - told.tracked >= *told.tracking) {
      tracking = tracking ? tracking : igtl::tracking_of(state());
      told.tracked = now;
      hub_.show(peer, "robot", *tracking);
    }
  }
}

/** Read anew when it changed, by whomever. */
asio::awaitable<void> Navigation::refresh_targeting() {
  const std::uint32_t revision = context_.book.targeting_revision();
  if (targeting_revision_ == revision) {
    co_return;
  }
  const auto present = co_await present_targeting(context_);
  if (present) {
    targeting_ = *present;
    targeting_revision_ = revision;
  }
}

/** From two positions, as the kernel tells none. */
void Navigation::measure_velocities() {
  const ControlView& view = context_.view();
  const Passed before =
      std::exchange(passed_, {view.snapshot.state.tick, positions_in(context_.robot, view)});
  const double seconds = static_cast<double>(passed_.tick - before.tick) * context_.robot.period_us * 1e-6;
  velocities_.clear();
  if (before.positions.size() == passed_.positions.size() && seconds > 0.0) {
    for (std::size_t i = 0; i < passed_.positions.size(); ++i) {
      velocities_.push_back((passed_.positions[i] - before.positions[i]) / seconds);
    }
  }
}

igtl::RobotState Navigation::state() const {
  const ControlView& view = context_.view();
  igtl::RobotState state;
  state.scanner_from_robot = targeting_.registration;
  state.entry = targeting_.entry_point;
  state.target = targeting_.target_point;
  state.treatment_to_tip_mm = targeting_.treatment_to_tip_mm;
  state.robot_to_entry_mm = targeting_.robot_to_entry_mm;
  state.cannula_to_treatment_mm = targeting_.cannula_to_treatment_mm;
  state.treatment_to_robot_at_home_mm = targeting_.treatment_to_robot_at_home_mm;
  state.mode = context_.book.app_mode();
  state.health = health_of(view);
  const RobotPoses poses = robot_poses(context_.robot, targeting_, view);
  state.measured_cp = poses.current;
  state.desired_cp = poses.desired;
  state.measured_jp = positions_in(context_.robot, view);
  state.measured_jv = velocities_;
  if (!poses.setpoints.empty()) {
    state.desired_jp = state.measured_jp;
  }
  for (std::size_t i = 0; i < state.desired_jp.size(); ++i) {
    const Axis& axis = context_.robot.axes[i];
    const auto setpoint = std::ranges::find(poses.setpoints, axis.slot, &AxisSetpoint::slot);
    if (setpoint != poses.setpoints.end()) {
      state.desired_jp[i] = axis.to_unit(setpoint->counts);
    }
  }
  return state;
}

}  // namespace interlock::web
