/**
 * @file
 * What holds motion still from outside, beside the pedal: a breathing gate and a scan.
 *
 * The network thread sets both whole; the control thread judges in each tick how old the gate's signal is. A
 * gate that is in use lets the insertion advance only while its newest signal says "open" and is valid still:
 * what is unknown is closed.
 */
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>

#include "motion/deadman_timer.hpp"

namespace interlock {

/** What the breathing gate says of the insertion now. */
enum class GateState : std::uint8_t {
  off,      /**< not in use: nothing waits for it */
  open,     /**< the insertion may advance */
  hold,     /**< it may not */
  no_signal /**< it may not: none came, the newest is too old, or its source is gone */
};

/** As the interface spells it. */
constexpr std::string_view gate_state_name(GateState state) noexcept {
  constexpr std::array<std::string_view, 4> names{"off", "open", "hold", "no_signal"};
  return names[static_cast<std::size_t>(state)];
}

/** Bounds of the time for which a signal of the gate is valid, and what counts where it states none. */
constexpr std::chrono::milliseconds shortest_gate_signal{50};
constexpr std::chrono::milliseconds usual_gate_signal{500};
constexpr std::chrono::milliseconds longest_gate_signal{2000};

/** The breathing gate, as it was last set. */
struct BreathingGate {
  bool in_use = false;
  bool open = false;                      /**< what the newest signal says */
  DeadmanTimer signal{usual_gate_signal}; /**< held since that came, for its validity */

  /** What it says at that moment. */
  [[nodiscard]] GateState at(const Moment& now) const noexcept {
    if (!in_use) {
      return GateState::off;
    }
    if (!signal.held() || signal.overdue(now)) {
      return GateState::no_signal;
    }
    return open ? GateState::open : GateState::hold;
  }
};

/** Both, as the network thread sets them. */
struct OutsideHolds {
  BreathingGate gate;
  bool scanning = false; /**< nothing may move */
};

/** What stands still in a tick, whatever the pedal says. */
struct StandStill {
  bool all = false;         /**< every motion, as if the pedal were released */
  bool insertion = false;   /**< the insertion, unless it withdraws */
  bool needs_press = false; /**< the insertion until the pedal is pressed anew, whatever the gate says */

  bool operator==(const StandStill&) const = default;
};

}  // namespace interlock
