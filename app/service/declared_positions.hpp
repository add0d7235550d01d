/**
 * @file
 * Positions that a person declared, and how they are taken back.
 *
 * SET_HOME and RESTORE give an axis another position without a motion. For a minute, and for as long as the
 * axis rests where it was declared, its position before can be put back. What the kernel forgot of it is not
 * brought back by a program: the axis is not homed afterwards (decision 79).
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "robot/robot.hpp"
#include "service/axis_requests.hpp"
#include "service/clocks.hpp"
#include "system/utc_time.hpp"

namespace interlock {

/** The newest declaration: of one axis, or of several at once. Belongs to the network thread. */
class DeclaredPositions {
 public:
  static constexpr std::chrono::seconds undoable_for{60};

  /** Begins another declaration; the one before it cannot be undone any more. */
  void begin(std::string by, UtcTime time, SteadyTime now);

  /** The kernel accepted that request; `before` is the axis as it was seen just before. */
  void add(const AxisRequest& accepted, const ilk_axis_t& before) { axes_.push_back({accepted, before}); }

  /** It is undone for that axis. */
  void forget(const Axis& axis) {
    std::erase_if(axes_, [&](const Declared& each) { return each.request.axis == &axis; });
  }

  /** Whether there is something that may be undone still. */
  [[nodiscard]] bool is_open(SteadyTime now) const { return !axes_.empty() && now < began_ + undoable_for; }

  /** Schema `DeclaredPositions`, or null when nothing may be undone. */
  [[nodiscard]] nlohmann::json to_json(const ControlView& view, const ilk_config_t& config,
                                       SteadyTime now) const;

  /** The requests that undo it, in their order. Those of axes that moved, or were declared anew, are not to
   * be sent. */
  [[nodiscard]] std::vector<AxisRequest> undoing(const ControlView& view, const ilk_config_t& config) const;

 private:
  struct Declared {
    AxisRequest request;
    ilk_axis_t before;
  };

  std::string by_;
  UtcTime time_{};
  SteadyTime began_{};
  std::vector<Declared> axes_;
};

/** As `ask_each`, of SET_HOME or RESTORE: what the kernel accepts can be undone. */
boost::asio::awaitable<nlohmann::json> declare_each(const Context& context, const Caller& caller,
                                                    std::vector<AxisRequest> requests);

/** Undoes what was declared, as `ask_each`; what the kernel refuses may be tried again. */
boost::asio::awaitable<nlohmann::json> undo_each(const Context& context, const Caller& caller);

}  // namespace interlock
