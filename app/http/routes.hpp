/**
 * @file
 * The routes of the interface, in groups: each object adds its routes to the router and answers them.
 */
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "history/capture.hpp"
#include "history/history.hpp"
#include "history/history_feed.hpp"
#include "http/broadcaster.hpp"
#include "http/router.hpp"
#include "kinematics/family.hpp"
#include "service/context.hpp"
#include "service/drafts.hpp"
#include "service/login_guard.hpp"
#include "service/navigation.hpp"
#include "service/run_recorder.hpp"
#include "service/targeting_store.hpp"
#include "store/sessions.hpp"

namespace interlock::web {

/**
 * Routes of one's own account: login, logout, sessions and password. Administrators see and end the sessions
 * of others, too.
 */
class AccountRoutes {
 public:
  /** Both must outlive it. */
  AccountRoutes(const Context& context, Router& router);

 private:
  boost::asio::awaitable<Reply> login(const Call& call);
  boost::asio::awaitable<Reply> logout(const Call& call);
  boost::asio::awaitable<Reply> change_password(const Call& call);
  [[nodiscard]] Reply session(const Call& call) const;
  [[nodiscard]] nlohmann::json listed(const Session& session, const Caller& caller) const;
  boost::asio::awaitable<Reply> sessions(const Call& call);
  boost::asio::awaitable<Reply> end_session(const Call& call);
  tl::expected<LoginGuard::Attempt, Problem> begin_attempt(const Call& call, const std::string& name);
  [[nodiscard]] boost::asio::awaitable<void> pause(std::chrono::seconds time) const;
  boost::asio::awaitable<tl::expected<std::optional<Authenticated>, Problem>> authenticate(std::string name,
                                                                                           Password password);

  const Context& context_;
  LoginGuard guard_;
};

/** Routes of the audit. */
class AuditRoutes {
 public:
  /** Both must outlive it. */
  AuditRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> records(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> verify(const Call& call) const;

  const Context& context_;
};

/** Routes by which control is requested, released, handed over and taken. */
class MotionControlRoutes {
 public:
  /** Both must outlive it. */
  MotionControlRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> request(const Call& call) const;
  [[nodiscard]] Reply release(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> hand_over(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> take_over(const Call& call) const;
  [[nodiscard]] Success shown(const Call& call, Status status = Status::ok) const;
  /** 409 REPLAY where nothing could move. */
  [[nodiscard]] tl::expected<void, Problem> need_robot() const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<void, Problem>> record_then_recheck(
      const Call& call, const char* action) const;

  const Context& context_;
};

/** Routes of the simulated hardware. */
class BenchRoutes {
 public:
  /** Both must outlive it. */
  BenchRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> status(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> command(const Call& call) const;

  const Context& context_;
};

/** Routes of Cooperative Biopsy: forces and their zero, membranes, images. */
class BiopsyRoutes {
 public:
  /** Both must outlive it. */
  BiopsyRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply show() const;
  [[nodiscard]] tl::expected<void, Problem> need_needle() const;
  [[nodiscard]] tl::expected<void, Problem> need_closed() const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_membranes(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> reset_membranes(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> zero(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<void, Problem>> record_then_recheck(
      const Call& call, nlohmann::json detail) const;
  [[nodiscard]] Reply take_image(const Call& call) const;
  [[nodiscard]] Reply show_image(const nlohmann::json& body) const;

  const Context& context_;
};

/** Routes of the connections to the app. */
class CommunicationRoutes {
 public:
  /** All must outlive it. */
  CommunicationRoutes(const Context& context, Navigation& navigation, Broadcaster& stream, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> list() const;
  [[nodiscard]] boost::asio::awaitable<Reply> disconnect(const Call& call) const;
  [[nodiscard]] Reply list_navigation() const;
  [[nodiscard]] boost::asio::awaitable<Reply> end_navigation(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_role(const Call& call) const;

  const Context& context_;
  Navigation& navigation_;
  Broadcaster& stream_;
};

// Routes of what has been, for plots: decimated, and tick by tick from the kernel's black box.

/** What is known of former ticks. */
struct Past {
  HistoryFeed* feed = nullptr;     /**< must outlive what is given it; null: nothing is decimated */
  std::filesystem::path black_box; /**< socket of the kernel's; empty: there is none to read */
};

/** `GET /api/history` and `GET /api/capture`, and what they read: the decimated past and the black box. */
class HistoryRoutes {
 public:
  /** Context and router must outlive it. */
  HistoryRoutes(const Context& context, Past past, Router& router);

  /** Takes over what was decimated since the last call, and shows it to the runs; at least once a second. */
  void keep(RunRecorder& runs);

 private:
  [[nodiscard]] Reply history(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> capture(const Call& call) const;

  /** Gives the span what velocity and forces are found by. */
  void add_rules(CaptureSpan& span) const;

  [[nodiscard]] std::optional<ForceScales> force_scales() const;

  const Context& context_;
  Past past_;
  History history_;
};

/** Routes of the alarms. */
class AlarmRoutes {
 public:
  /** Both must outlive it. */
  AlarmRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply list() const;
  [[nodiscard]] boost::asio::awaitable<Reply> acknowledge(const Call& call) const;

  const Context& context_;
};

/** Routes of what holds motion still: the breathing gate, and a scan. */
class HoldRoutes {
 public:
  /** Both must outlive it. */
  HoldRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply show() const;
  [[nodiscard]] boost::asio::awaitable<Reply> use_gate(const Call& call) const;
  [[nodiscard]] Reply signal(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_scan(const Call& call) const;

  const Context& context_;
};

/** Routes of jogging: a move towards one end of an axis' range, held by renewals. */
class JogRoutes {
 public:
  /** Both must outlive it. */
  JogRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> begin(const Call& call) const;
  [[nodiscard]] Reply renew(const Call& call) const;

  const Context& context_;
};

/** Routes of the app's log. */
class LogRoutes {
 public:
  /** Both must outlive it. */
  LogRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply lines(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_level(const Call& call) const;
  [[nodiscard]] Success answer(const std::vector<LogLine>& lines) const;

  const Context& context_;
};

// Routes of the robot as its file describes it, and of its modes.

/** Schema `ModeAnswer` of spec/openapi.yaml. */
nlohmann::json mode_json(const Robot& robot, std::string_view mode);

/** Routes of the mode, and of what the robot is. */
class ModeRoutes {
 public:
  /** Both must outlive it. */
  ModeRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply robots() const;
  [[nodiscard]] Reply mode() const;
  [[nodiscard]] tl::expected<std::string, Problem> desired_mode(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> set_mode(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<Task, Problem>> task_for(std::string mode,
                                                                             std::string author) const;
  [[nodiscard]] Reply go_manual(const std::string& by) const;

  const Context& context_;
};

/** Routes of the axes. */
class MotorRoutes {
 public:
  /** Both must outlive it. */
  MotorRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply motors() const;
  [[nodiscard]] Reply motor(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> act(const Call& call) const;
  [[nodiscard]] tl::expected<const Axis*, Problem> axis_of(const std::string& slot_or_name) const;

  const Context& context_;
};

/** Routes that save, compare and set the positions of several axes. */
class PositionRoutes {
 public:
  /** Both must outlive it. */
  PositionRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply save() const;
  [[nodiscard]] Reply compare(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> restore(const Call& call) const;
  [[nodiscard]] Reply declared() const;
  [[nodiscard]] boost::asio::awaitable<Reply> undo(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> zero_all(const Call& call) const;

  const Context& context_;
};

/** Routes of the proposals. */
class ProposalRoutes {
 public:
  /** Both must outlive it. */
  ProposalRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply list() const;
  [[nodiscard]] boost::asio::awaitable<tl::expected<Task, Problem>> task_of(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> propose(const Call& call) const;
  /** How the registry takes somebody's consent: `approve` or `confirm`. */
  using Consent = tl::expected<Proposal, Refusal> (MotionRegistry::*)(std::uint32_t, const ControlView&,
                                                                      std::chrono::steady_clock::time_point);
  /** @param word for what was consented to, in the audit */
  [[nodiscard]] boost::asio::awaitable<Reply> consent(const Call& call, const char* word, Consent give) const;
  [[nodiscard]] boost::asio::awaitable<Reply> reject(const Call& call) const;
  [[nodiscard]] Reply show(const Call& call) const;
  [[nodiscard]] Reply robot_file(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> plan(const Call& call) const;
  [[nodiscard]] Reply abort(const Call& call) const;

  const Context& context_;
};

/**
 * Routes of the system as a whole: status, metrics, the kernel's configuration, STOP, RESET and the stream's
 * address.
 */
class SystemRoutes {
 public:
  /** All must outlive it. */
  SystemRoutes(const Context& context, const Broadcaster& stream, Router& router);

 private:
  [[nodiscard]] Reply status() const;
  [[nodiscard]] Reply configuration() const;
  [[nodiscard]] Reply metrics() const;
  [[nodiscard]] boost::asio::awaitable<Reply> stop(const Call& call) const;

  const Context& context_;
  const Broadcaster& stream_;
};

/** Routes of registration, entry, target and probe. */
class TargetingRoutes {
 public:
  /** Both must outlive it. */
  TargetingRoutes(const Context& context, Router& router);

 private:
  void add_change(Router& router, const char* path, TargetingChange make);
  [[nodiscard]] boost::asio::awaitable<Reply> show() const;
  [[nodiscard]] boost::asio::awaitable<Reply> show_alignment() const;
  [[nodiscard]] boost::asio::awaitable<Reply> show_history() const;
  [[nodiscard]] boost::asio::awaitable<Reply> show_reach();
  [[nodiscard]] boost::asio::awaitable<Reply> expire(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> change(const Call& call, TargetingChange make) const;

  /** Where the robot gets to with a probe: schema `Reach`. */
  struct KnownReach {
    ProbeOffsets probe;
    nlohmann::json body;
  };

  const Context& context_;
  std::optional<KnownReach> reach_; /**< the newest that was asked for */
};

/** Routes of the cases. */
class CaseRoutes {
 public:
  /** Both must outlive it. */
  CaseRoutes(const Context& context, Router& router);

 private:
  boost::asio::awaitable<Reply> open(const Call& call) const;
  boost::asio::awaitable<Reply> add_note(const Call& call) const;

  const Context& context_;
};

/** Routes of the runs. */
class RunRoutes {
 public:
  /** Both must outlive it. */
  RunRoutes(const Context& context, Router& router);

 private:
  boost::asio::awaitable<Reply> list(const Call& call) const;
  boost::asio::awaitable<Reply> csv(const Call& call) const;
  boost::asio::awaitable<Reply> annotate(const Call& call) const;
  boost::asio::awaitable<Reply> retain(const Call& call) const;

  const Context& context_;
};

/** Routes of the trajectory that is loaded. */
class TrajectoryRoutes {
 public:
  static constexpr const char* path = "/api/trajectory";

  /** Both must outlive it. */
  TrajectoryRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] Reply show() const;
  [[nodiscard]] boost::asio::awaitable<Reply> load(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> unload(const Call& call) const;

  const Context& context_;
};

/** Routes by which administrators keep the users. */
class UserRoutes {
 public:
  /** Both must outlive it. */
  UserRoutes(const Context& context, Router& router);

 private:
  [[nodiscard]] boost::asio::awaitable<Reply> list() const;
  [[nodiscard]] boost::asio::awaitable<Reply> add(const Call& call) const;
  [[nodiscard]] boost::asio::awaitable<Reply> change(const Call& call) const;

  const Context& context_;
};

}  // namespace interlock::web
