/**
 * @file
 * The routes of spec/openapi.yaml.
 */
#pragma once

#include <memory>
#include <optional>

#include "http/bench_client.hpp"
#include "http/bench_pedal.hpp"
#include "http/control_client.hpp"
#include "http/router.hpp"
#include "http/stream_hub.hpp"
#include "proposals/proposal_book.hpp"
#include "robot/robot.hpp"

namespace interlock::web {

/** What the interface shows and commands. Everything belongs to the network thread. */
class Api {
 public:
  /** `robot`, `config` and `mailbox` must outlive it; an empty `bench_socket` means that the hardware is
   * real. */
  Api(const boost::asio::any_io_executor& executor, const Robot& robot, const ilk_config_t& config,
      Mailbox& mailbox, const std::string& bench_socket);

  [[nodiscard]] const Router& router() const { return router_; }
  [[nodiscard]] StreamHub& stream() { return stream_; }

  /** Follows the control thread's notices; ends with the io_context. */
  boost::asio::awaitable<void> listen() { return control_.listen(); }

  /** Sends the state to the stream 30 times a second and looks after the bench pedal; ends with the
   * io_context. */
  boost::asio::awaitable<void> beat();

  /** Releases a pedal that is held over the network. */
  boost::asio::awaitable<void> release_pedal();

 private:
  using Answering = boost::asio::awaitable<Reply>;

  void add_routes();
  void add_bench_routes();

  Reply status();
  Reply motors();
  Reply motor(const Parameters& parameters);
  Answering act_on_motor(const Parameters& parameters);
  Reply proposals();
  Reply propose(const Request& request);
  Reply proposal(const Parameters& parameters);
  Reply abort(const Parameters& parameters);
  Answering stop();
  Answering reset();
  Answering bench_status();
  Answering bench_command(const Request& request, const Parameters& parameters);

  tl::expected<void, Problem> take_pedal(nlohmann::json& body);
  Answering pass_to_bench(std::string command, nlohmann::json body);
  [[nodiscard]] tl::expected<const Axis*, Problem> axis_of(const std::string& slot) const;
  const ControlView& view();
  [[nodiscard]] tl::expected<void, Problem> need_kernel();
  Answering ask(std::uint32_t kind, std::uint32_t slot, std::string where);
  [[nodiscard]] OpenTargets open_targets() const;

  boost::asio::any_io_executor executor_;
  const Robot& robot_;
  const ilk_config_t& config_;
  ControlClient control_;
  ProposalBook book_;
  StreamHub stream_;
  std::optional<BenchClient> bench_;
  BenchPedal pedal_;
  Router router_;
};

}  // namespace interlock::web
