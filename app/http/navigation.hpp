/**
 * @file
 * Navigation programs over OpenIGTLink: what they ask for becomes a setting or a proposal under the motion
 * authority of whoever made one of them the controller, or is refused with its reason; what the robot is and
 * does is told to all of them. docs/openigtlink.md.
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
#include <optional>
#include <string>

#include "http/context.hpp"
#include "http/targeting.hpp"
#include "igtl/hub.hpp"
#include "igtl/thesis.hpp"

namespace interlock::web {

class Navigation {
 public:
  /** Wishes that wait; one more is refused. */
  static constexpr std::size_t backlog = 64;
  /** Between two looks at what has changed and is to be told. */
  static constexpr std::chrono::milliseconds telling_period{100};
  /** Between two health messages, although nothing has changed. */
  static constexpr std::chrono::milliseconds health_period{1000};

  /** `context` must outlive it. */
  explicit Navigation(const Context& context);

  [[nodiscard]] igtl::Hub& hub() { return hub_; }
  [[nodiscard]] const igtl::Hub& hub() const { return hub_; }

  /** Serves connections until the io_context ends. */
  void start();

  /**
   * Makes a connection the controller or an observer. The controller acts for the caller, who must hold the
   * motion authority, for as long as the caller does; the one before becomes an observer. False when there is
   * no such connection.
   */
  bool set_role(igtl::PeerId id, igtl::Role role, const Caller& caller);

  /** The motion authority has changed: nobody acts for the former holder any more. */
  void drop_controller();

  /** Tells of a proposal that came from a navigation program. */
  void tell(const Proposal& proposal);

 private:
  /** On whose behalf a connection acts. */
  struct Mandate {
    igtl::PeerId peer = 0;
    Caller caller;
    std::uint32_t hold = 0; /**< number of the motion authority by which it was given */
  };

  /** A wish that waits for its turn. */
  struct Task {
    igtl::PeerId peer = 0;
    std::string device;
    igtl::Wish wish;
  };

  /** What a peer was told, and wants to be told. */
  struct Told {
    std::map<std::string, igtl::Body> messages; /**< by name */
    SteadyTime health;
    std::optional<std::chrono::milliseconds> tracking; /**< between two TDATA */
    SteadyTime tracked;
  };

  /** Positions at a tick, from which velocities follow. */
  struct Passed {
    std::uint32_t tick = 0;
    std::vector<double> positions;
  };

  using Done = tl::expected<std::string, Problem>;

  void listen_to_hub();
  void take(igtl::PeerId peer, const igtl::Message& message);
  void stop(igtl::PeerId peer, const std::string& device);
  void track(igtl::PeerId peer, const igtl::Track& wish);
  void show(igtl::PeerId peer, const igtl::Show& wish);
  void lose(const igtl::Peer& peer, const std::string& reason);
  void answer(igtl::PeerId peer, const std::string& device, const std::string& text);
  void refuse(igtl::PeerId peer, const std::string& device, const igtl::Status& status);
  [[nodiscard]] tl::expected<Caller, Problem> mandate_of(igtl::PeerId peer) const;

  boost::asio::awaitable<void> work();
  boost::asio::awaitable<Done> carry_out(const Task& task, const Caller& caller);
  boost::asio::awaitable<Done> change(const Caller& caller, const igtl::Wish& wish);
  boost::asio::awaitable<Done> load(const Caller& caller, const igtl::LoadRows& rows);
  boost::asio::awaitable<Done> enter_mode(const Caller& caller, std::string mode);
  [[nodiscard]] Done go_manual() const;

  boost::asio::awaitable<void> tell_all();
  boost::asio::awaitable<void> refresh_targeting();
  void measure_velocities();
  void tell_messages(SteadyTime now);
  void tell_tracking(SteadyTime now);
  [[nodiscard]] igtl::RobotState state() const;

  const Context& context_;
  igtl::Hub hub_;
  std::optional<Mandate> mandate_;
  std::deque<Task> tasks_;
  boost::asio::steady_timer news_; /**< cancelled when there is a task */
  std::map<igtl::PeerId, Told> told_;
  Targeting targeting_;
  std::optional<std::uint32_t> targeting_revision_; /**< of `targeting_`; empty: none was read yet */
  Passed passed_;
  std::vector<double> velocities_; /**< units/s; empty while unknown */
};

}  // namespace interlock::web
