/**
 * @file
 * Navigation programs over OpenIGTLink: what they ask for becomes a setting or a proposal of the user who is
 * in control and made one of them the controller, or is refused with its reason; what the robot is and does
 * is told to all of them. docs/openigtlink.md.
 *
 * Belongs to the network thread. STOP is carried out as soon as it is read, whoever sends it; everything else
 * that waits for the store is done one by one, in its order.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "igtl/dialect.hpp"
#include "igtl/igtl_server.hpp"
#include "service/context.hpp"
#include "service/imager.hpp"
#include "service/navigation_state.hpp"
#include "service/targeting.hpp"

namespace interlock {

/** How the app speaks OpenIGTLink. */
struct NavigationOptions {
  std::string dialect = "thesis"; /**< a name that `igtl::make_dialect` knows */
  /** The first connection is the controller of whoever is in control. */
  bool first_controls = false;
  /** A program that listens, to which the app connects, again and again. */
  std::optional<boost::asio::ip::tcp::endpoint> connect;
};

/** Ties the server of OpenIGTLink to robot, proposals and control. */
class Navigation {
 public:
  /** Between two attempts to connect. */
  static constexpr std::chrono::milliseconds connect_pause{500};
  /** Commands that wait; one more is refused. */
  static constexpr std::size_t backlog = 64;
  /** Between two looks at what has changed and is to be told. */
  static constexpr std::chrono::milliseconds telling_period{100};
  /** Between two messages to the controller while something moves: that its machine is gone shows by one that
   * is not acknowledged. */
  static constexpr std::chrono::milliseconds motion_period{50};
  /** Between two health messages, although nothing has changed. */
  static constexpr std::chrono::milliseconds health_period{1000};

  /** `context` must outlive it. */
  explicit Navigation(const Context& context);

  /** The connections of OpenIGTLink. */
  [[nodiscard]] igtl::IgtlServer& server() { return server_; }
  [[nodiscard]] const igtl::IgtlServer& server() const { return server_; }

  /** Serves connections until the io_context ends. */
  void start(NavigationOptions options);

  [[nodiscard]] const std::string& dialect() const { return options_.dialect; }

  /**
   * Makes a connection the controller or an observer. The controller acts for the caller, who must be in
   * control, for as long as the caller is; the one before becomes an observer. False when there is no such
   * connection.
   */
  bool set_role(igtl::PeerId id, igtl::Role role, const Caller& caller);

  /** What imagers said last. */
  [[nodiscard]] const Imager& imager() const { return imager_; }

  /** Control changed hands: nobody acts for the former holder any more. */
  void change_holder();

  /** Tells of a proposal that came from a navigation program. */
  void tell(const Proposal& proposal);

 private:
  /** On whose behalf a connection acts. */
  struct ControllerGrant {
    igtl::PeerId peer = 0;
    Caller caller;
    std::uint32_t hold = 0; /**< number of the hold of control by which it was given */
  };

  /** A command that waits for its turn. */
  struct WaitingCommand {
    igtl::PeerId peer = 0;
    std::string device;
    igtl::Command command;
    std::uint32_t stops = 0; /**< STOPs that came before it */
  };

  /** How a peer is talked to, what it was told, and wants to be told. */
  struct Session {
    std::unique_ptr<igtl::Dialect> dialect;
    std::map<std::string, igtl::Body> told; /**< by name */
    SteadyTime health;
    std::optional<std::chrono::milliseconds> tracking; /**< between two TDATA */
    SteadyTime tracked;
  };

  using Stopping = boost::asio::awaitable<std::optional<StopAnswer>>;

  void listen_to_server();
  void take(igtl::PeerId peer, const igtl::Message& message);
  void react(igtl::PeerId peer, const std::string& device, igtl::Reaction reaction);
  [[nodiscard]] tl::expected<std::string, Problem> obey(igtl::PeerId peer, const igtl::HoldMessage& message);
  [[nodiscard]] HoldSource source_of(igtl::PeerId peer) const;
  void enqueue(igtl::PeerId peer, const std::string& device, igtl::Command command);
  void finish(igtl::PeerId peer, const std::string& device, const igtl::Command& command,
              const igtl::Outcome& outcome);
  void end_motion(std::uint32_t proposal, const std::string& by = {});
  Stopping stop(igtl::PeerId peer);
  boost::asio::awaitable<void> finish_stop(igtl::PeerId peer, std::string device, igtl::Command command,
                                           Stopping stopping);
  void track(igtl::PeerId peer, const igtl::Track& command);
  void lose(const igtl::Peer& peer, const std::string& reason);
  void let_first_control();
  void announce(const char* change, const igtl::Peer& peer, const std::string& reason = "");
  bool give_role(igtl::PeerId id, igtl::Role role);
  void note_refusal(igtl::PeerId peer, const std::string& device, const std::string& reason);
  [[nodiscard]] tl::expected<Caller, Problem> grant_of(igtl::PeerId peer) const;

  boost::asio::awaitable<void> work();
  boost::asio::awaitable<void> tell_all();
  boost::asio::awaitable<void> keep_targeting();
  boost::asio::awaitable<void> refresh_targeting();
  void follow(const igtl::Motion& motion);
  void tell_messages(SteadyTime now);
  void tell_what_is_due(SteadyTime now);
  void tell_tracking(SteadyTime now);
  [[nodiscard]] bool is_moving() const;
  [[nodiscard]] bool is_overtaken(const WaitingCommand& task) const;
  [[nodiscard]] igtl::RobotState state() const;

  const Context& context_;
  NavigationOptions options_;
  igtl::IgtlServer server_;
  std::optional<ControllerGrant> grant_;
  std::vector<std::uint32_t> orphans_; /**< proposals of controllers that were lost */
  std::deque<WaitingCommand> tasks_;
  boost::asio::steady_timer news_; /**< cancelled when there is a task */
  std::map<igtl::PeerId, Session> sessions_;
  Targeting targeting_;
  std::optional<std::uint32_t> targeting_revision_; /**< of `targeting_`; empty: none was read yet */
  AxisVelocities velocities_;
  Imager imager_;
  PoseVelocity probe_velocity_;
};

}  // namespace interlock
