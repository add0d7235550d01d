/**
 * @file
 * What holds motion still from outside: the breathing gate, and a scan.
 *
 * Belongs to the network thread; how old a signal is, the control thread judges (motion/outside_holds.hpp).
 * Both begin at once, whoever asks. Only whoever is in control turns the gate off; a scan is ended by whoever
 * is in control, or by its source. What a source leaves behind stays held: its gate is closed, its scan goes
 * on. So does what was held when the app ended.
 */
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "igtl/command.hpp"
#include "motion/outside_holds.hpp"
#include "service/clocks.hpp"
#include "service/control_client.hpp"
#include "service/reply.hpp"

namespace interlock {

/** Who signals, or scans: a session, or a connection of OpenIGTLink. */
struct HoldSource {
  std::uint32_t session = 0; /**< 0: a connection */
  std::uint32_t peer = 0;
  std::string name = {}; /**< as people know it */

  /** Whether it is that one, whatever it is called. */
  [[nodiscard]] bool is(const HoldSource& other) const {
    return session == other.session && peer == other.peer;
  }
};

/** Breathing gate and scan, as people and programs set them. */
class HoldService {
 public:
  /** Of the setting in which the store has what is `kept`. */
  static constexpr const char* setting = "holds";

  /** `control` must outlive it. */
  explicit HoldService(ControlClient& control) : control_(control) {}

  /** Turns the breathing gate on or off. */
  void use_gate(bool in_use);

  /**
   * A signal of the breathing gate, valid from when it came. It is kept whether or not the gate is in use.
   * 409 GATE_SOURCE for one that opens it, while a signal of another source is valid, whatever that says;
   * whoever says "hold" is believed.
   */
  tl::expected<void, Problem> signal(const HoldSource& source, const igtl::GateSignal& signal,
                                     std::chrono::steady_clock::time_point came);

  /** A scan begins; one that goes on stays whose it is. */
  void begin_scan(const HoldSource& source, UtcTime time, SteadyTime now);

  /** 409 SCANNING unless that source began it, or is in control. Nothing changes when none goes on. */
  [[nodiscard]] tl::expected<void, Problem> may_end_scan(const HoldSource& source, bool in_control) const;

  /** The scan is over. */
  void end_scan();

  /** That session or connection has ended. */
  void end_source(const HoldSource& source);

  /** Whether the gate is in use. */
  [[nodiscard]] bool gate_in_use() const { return holds_.gate.in_use; }
  /** Whether a scan goes on. */
  [[nodiscard]] bool scanning() const { return holds_.scanning; }

  /** What is to be held still after a restart of the app. */
  [[nodiscard]] nlohmann::json kept() const;
  /** Holds what `kept` gave before the restart. */
  void restore(const nlohmann::json& kept, UtcTime time, SteadyTime now);

  /** Schema `Holds` of spec/openapi.yaml, but for the age of the scan. */
  [[nodiscard]] nlohmann::json to_json() const;
  /** The same, and the age of the scan. */
  [[nodiscard]] nlohmann::json to_json(SteadyTime now) const;

 private:
  void publish() { control_.set_holds(holds_); }

  struct Scan {
    HoldSource source;
    UtcTime begun;
    SteadyTime since;
  };

  /** The newest signal of a source. */
  struct Given {
    HoldSource source;
    DeadmanTimer signal;
  };

  ControlClient& control_;
  OutsideHolds holds_;
  std::vector<Given> given_;         /**< one of each source while it is valid, the newest last */
  std::optional<HoldSource> source_; /**< of the gate's newest signal, until it ends */
  Scan scan_;                        /**< while `scanning` */
};

}  // namespace interlock
