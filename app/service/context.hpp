/**
 * @file
 * What the route groups work with. Everything in it belongs to the network thread.
 */
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "log/log.hpp"
#include "proposals/motion_registry.hpp"
#include "robot/robot.hpp"
#include "service/alarms.hpp"
#include "service/bench.hpp"
#include "service/biopsy_service.hpp"
#include "service/clocks.hpp"
#include "service/control_client.hpp"
#include "service/hold_service.hpp"
#include "service/live_sessions.hpp"
#include "service/loaded_trajectory.hpp"
#include "service/motion_control.hpp"
#include "service/reply.hpp"
#include "service/stop_records.hpp"
#include "service/store_executor.hpp"
#include "service/work_pool.hpp"

namespace interlock {

class DeclaredPositions;
struct InForce;

struct Context {
  boost::asio::any_io_executor executor;
  const Robot& robot;
  const ilk_config_t& config;
  ControlClient& control;
  MotionRegistry& registry;
  Bench& bench;
  BiopsyService& biopsy;
  HoldService& holds;
  StoreExecutor& store;
  LiveSessions& sessions;
  MotionControl& motion_control;
  WorkPool& work;
  LoadedTrajectory& trajectory;
  InForce& in_force;
  DeclaredPositions& declared_positions;
  StopRecords& stop_records;
  Alarms& alarms;
  Log& log;
  std::function<void(const nlohmann::json&)> publish; /**< a message to every console */
  std::function<UtcTime()> clock;
  std::function<SteadyTime()> steady_clock;
  const std::uint64_t& role_refusals;     /**< requests of users whose role does not suffice */
  std::filesystem::path noted_heads = {}; /**< that the recorder wrote; empty: this machine notes none */

  /** The newest view, after the registry has followed its tasks. The reference holds until the next call. */
  [[nodiscard]] const ControlView& view() const;

  /** 503 NO_KERNEL unless a kernel is connected. */
  [[nodiscard]] tl::expected<void, Problem> need_kernel() const;

  /** As `need_kernel`, and 503 NO_KERNEL when its newest state is more than 250 ms old: nobody may consent to
   * a motion by what may not be true any more. */
  [[nodiscard]] tl::expected<void, Problem> need_present_state() const;

  /** 409 CONTROL, naming who is in control, unless the caller is. */
  [[nodiscard]] tl::expected<void, Problem> need_control(const Caller& caller) const;

  /** What to record of something that the caller does, now. */
  [[nodiscard]] AuditEntry entry(const Caller& caller, AuditKind kind, nlohmann::json detail) const;

  /** Ends every proposal, and writes down who stopped the robot; the STOP itself is on its way already. Those
   * of nobody who is logged in, and of programs, are counted when they come faster than `StopRecords` has
   * them recorded.
   *
   * @param unrecorded how many STOPs just before it are not written down one by one
   * @param begun the record as it was begun when the STOP came; empty: it came now */
  void record_stop(const Caller& caller, std::uint32_t unrecorded,
                   std::optional<AuditEntry> begun = std::nullopt) const;

  /** Holds everything still for a scan of that source: nothing is approved until it is over. */
  void begin_scan(const HoldSource& source) const;
  /** The scan is over. */
  void end_scan() const;
  /** Holds what was held when the app ended. */
  void restore_holds(const nlohmann::json& kept) const;

  /** Has the record written that is due, if one is. */
  void note(std::optional<AuditEntry> entry) const;

  /**
   * Records what the caller is about to do, and says then whether the caller still may: 503 STORE, 401 LOGIN
   * when the session has ended meanwhile, 409 CONTROL when it has lost control. What follows without
   * waiting is rightful.
   */
  [[nodiscard]] boost::asio::awaitable<tl::expected<void, Problem>> record_then_recheck(
      const Caller& caller, AuditKind kind, nlohmann::json detail) const;

  /**
   * Announces one request, sends it to the kernel and answers with its verdict: `VerdictAnswer`, 409 with the
   * verdict as code, 503 NO_KERNEL, or a problem of `announce`. DISABLE waits for no store.
   *
   * @param where what was asked of what, for the audit and the problem's detail
   * @param target_counts position of a RESTORE
   */
  [[nodiscard]] boost::asio::awaitable<Reply> ask_kernel(const Caller& caller, std::uint32_t kind,
                                                         std::uint32_t slot, std::string where,
                                                         std::int32_t target_counts = 0) const;
};

}  // namespace interlock
