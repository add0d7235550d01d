/**
 * @file
 * The interface of spec/openapi.yaml: owns what its route groups work with and keeps it going.
 */
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "http/front_door.hpp"
#include "http/log_tail.hpp"
#include "http/router.hpp"
#include "http/routes.hpp"
#include "service/context.hpp"
#include "service/declared_positions.hpp"
#include "service/navigation.hpp"
#include "service/registration_watch.hpp"
#include "service/run_recorder.hpp"

namespace interlock::web {

/** STOP and the status: they wait for no store, and are answered however many connections there are. */
bool is_always_answered(std::string_view path);

/** What the interface shows and commands. Everything belongs to the network thread. */
class Api {
 public:
  /**
   * `robot`, `config`, `channel`, `store` and `log` must outlive it.
   *
   * @param bench_socket empty means that the hardware is real
   * @param past what is known of former ticks
   */
  Api(const boost::asio::any_io_executor& executor, const Robot& robot, const ilk_config_t& config,
      RealtimeChannel& channel, const std::string& bench_socket, StoreExecutor& store, Log& log,
      const Clocks& clocks = {}, Past past = {});

  /** Has the STOPs written that were counted only. */
  ~Api();

  Api(const Api&) = delete;
  Api& operator=(const Api&) = delete;

  [[nodiscard]] const Router& router() const { return router_; }

  /** What the route of the request answers. A refusal for the caller's role is logged and counted. */
  boost::asio::awaitable<Reply> route(const Request& request, const Caller& caller);

  /** Who sends a request over the connection of that peer: nobody, unless its cookies open exactly one
   * session. 503 STORE when that cannot be told. */
  boost::asio::awaitable<tl::expected<Caller, Problem>> caller_of(const Request& request, std::string peer);

  /** Has the check of the audit compare the heads that the recorder noted in that file. */
  void compare_with(std::filesystem::path noted_heads) { context_.noted_heads = std::move(noted_heads); }

  /** Holds what was held when the app ended (`HoldService::kept`). */
  void restore_holds(const nlohmann::json& kept);

  /** Ends every proposal, and records by whom the robot was stopped. */
  boost::asio::awaitable<void> record_stop(StopMade made);

  /** Who follows the state. */
  [[nodiscard]] Broadcaster& stream() { return stream_; }

  /** The proposals. */
  [[nodiscard]] MotionRegistry& registry() { return registry_; }

  /** The motions that are kept. */
  [[nodiscard]] RunRecorder& runs() { return runs_; }

  /** What asks somebody to act. */
  [[nodiscard]] Alarms& alarms() { return alarms_; }

  /** The navigation programs; they come once its server listens and it was started. */
  [[nodiscard]] Navigation& navigation() { return navigation_; }

  /** Follows the control thread's notices; ends with the io_context. */
  boost::asio::awaitable<void> listen() { return control_.listen(); }

  /** Sends the state to the stream 30 times a second, and checks the bench pedal, the registration and who is
   * in control; ends with the io_context. */
  boost::asio::awaitable<void> broadcast();

  /** Ends sessions that are over, logs how often the last line came again, and records STOPs that were
   * counted, after each pause; ends with the io_context. */
  boost::asio::awaitable<void> sweep_sessions(std::chrono::milliseconds pause);

  /** Releases a pedal that is held over the network. */
  boost::asio::awaitable<void> release_pedal() { return bench_.release_pedal("The app ended."); }

 private:
  void follow_proposals();
  void follow_kernel();
  void follow_sessions();
  void follow_streams();
  void note_refusal(const Request& request, const Caller& caller, const Problem& problem);
  void tell_biopsy(const ControlView& seen);
  void publish_holds();
  boost::asio::awaitable<void> keep_holds();
  void look_after_pedal(const ControlView& seen);
  void look_after_registration(const ControlView& seen);
  boost::asio::awaitable<void> expire_registration(std::string reason);
  void look_after_sessions();
  void look_after_alarms(const ControlView& seen);
  boost::asio::awaitable<tl::expected<std::optional<Session>, Problem>> session_of(const Request& request);

  ControlClient control_;
  MotionRegistry registry_;
  Broadcaster stream_;
  LogTail log_tail_;
  Bench bench_;
  BiopsyService biopsy_;
  HoldService holds_{control_};
  nlohmann::json published_holds_;
  nlohmann::json kept_holds_ = holds_.kept(); /**< as the store has it, or soon will */
  LiveSessions sessions_;
  MotionControl motion_control_;
  WorkPool work_;
  LoadedTrajectory trajectory_;
  InForce in_force_;
  DeclaredPositions declared_positions_;
  StopRecords stops_;
  Alarms alarms_;
  std::uint64_t role_refusals_ = 0;
  Context context_;
  RunRecorder runs_{context_};
  Navigation navigation_;
  RegistrationWatch registration_watch_;
  Router router_;
  std::uint32_t beats_ = 0;
  SystemRoutes system_routes_{context_, stream_, router_};
  PositionRoutes position_routes_{context_, router_}; /**< before the axes, whose pattern its paths match */
  MotorRoutes motor_routes_{context_, router_};
  ProposalRoutes proposal_routes_{context_, router_};
  HoldRoutes hold_routes_{context_, router_};
  AlarmRoutes alarm_routes_{context_, router_};
  JogRoutes jog_routes_{context_, router_};
  BenchRoutes bench_routes_{context_, router_};
  BiopsyRoutes biopsy_routes_{context_, router_};
  AccountRoutes account_routes_{context_, router_};
  UserRoutes user_routes_{context_, router_};
  MotionControlRoutes motion_control_routes_{context_, router_};
  ModeRoutes mode_routes_{context_, router_};
  LogRoutes log_routes_{context_, router_};
  HistoryRoutes history_routes_;
  CaseRoutes case_routes_{context_, router_};
  RunRoutes run_routes_{context_, router_};
  TargetingRoutes targeting_routes_{context_, router_};
  TrajectoryRoutes trajectory_routes_{context_, router_};
  CommunicationRoutes communication_routes_{context_, navigation_, stream_, router_};
  AuditRoutes audit_routes_{context_, router_};
};

}  // namespace interlock::web
