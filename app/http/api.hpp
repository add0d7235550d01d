/**
 * @file
 * The interface of spec/openapi.yaml: owns what its route groups work with and keeps it going.
 */
#pragma once

#include <string>

#include "http/context.hpp"
#include "http/router.hpp"
#include "http/routes/bench_routes.hpp"
#include "http/routes/motor_routes.hpp"
#include "http/routes/proposal_routes.hpp"
#include "http/routes/system_routes.hpp"

namespace interlock::web {

/** What the interface shows and commands. Everything belongs to the network thread. */
class Api {
 public:
  /** `robot`, `config` and `mailbox` must outlive it; an empty `bench_socket` means that the hardware is
   * real. */
  Api(const boost::asio::any_io_executor& executor, const Robot& robot, const ilk_config_t& config,
      Mailbox& mailbox, const std::string& bench_socket);

  [[nodiscard]] const Router& router() const { return router_; }
  /** Who sends a request over the connection of that peer. */
  [[nodiscard]] static Caller caller_of(const Request& request, const std::string& peer);

  [[nodiscard]] StreamHub& stream() { return stream_; }

  /** Follows the control thread's notices; ends with the io_context. */
  boost::asio::awaitable<void> listen() { return control_.listen(); }

  /** Sends the state to the stream 30 times a second and looks after the bench pedal; ends with the
   * io_context. */
  boost::asio::awaitable<void> beat();

  /** Releases a pedal that is held over the network. */
  boost::asio::awaitable<void> release_pedal() { return bench_.release_pedal(); }

 private:
  void tell_of_changes();
  [[nodiscard]] OpenTargets open_targets() const;

  ControlClient control_;
  ProposalBook book_;
  StreamHub stream_;
  Bench bench_;
  Context context_;
  Router router_;
  SystemRoutes system_routes_{context_, router_};
  MotorRoutes motor_routes_{context_, router_};
  ProposalRoutes proposal_routes_{context_, router_};
  BenchRoutes bench_routes_{context_, router_};
};

}  // namespace interlock::web
