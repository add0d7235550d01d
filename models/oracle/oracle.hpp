/**
 * @file
 * The oracle: a second opinion on every tick.
 *
 * Written from the kernel's specification and spec/frames.md, before its author read the kernel. It shares no
 * code, header or name with the kernel or the plant. It sees what goes over the wire and what is physically
 * so, keeps a reckoning of its own, and reports each output that the specification forbids. It never asks
 * whether a stop was wise or a refusal deserved: only what is unsafe is a finding.
 */
#ifndef INTERLOCK_ORACLE_ORACLE_HPP
#define INTERLOCK_ORACLE_ORACLE_HPP

#include <cstdint>
#include <span>
#include <vector>

#include "oracle/axis_watch.hpp"
#include "oracle/finding.hpp"
#include "oracle/observation.hpp"
#include "oracle/rules.hpp"
#include "oracle/system_watch.hpp"

namespace interlock::oracle {

class Oracle {
 public:
  explicit Oracle(const SystemRules& rules);

  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;

  /** Judges one tick; the findings last until the next. Ticks follow each other from 0 without a gap. */
  std::span<const Finding> step(const Observation& seen) noexcept;

 private:
  void judge_frames(const Observation& seen) noexcept;
  void judge_stop(const Observation& seen) noexcept;
  void judge_damage(const Observation& seen) noexcept;
  void take_messages(const Observation& seen) noexcept;
  void take_accepted(const Observation& seen, const Message& message) noexcept;
  bool is_in_order(const Message& message) noexcept;
  std::uint32_t counter_of(const Observation& seen) const noexcept;
  bool starts_anew(const Observation& seen) const noexcept;
  void note_counter(const Observation& seen) noexcept;
  bool any_drive(const Observation& seen) const noexcept;

  SystemRules rules_;
  SystemWatch system_;
  std::vector<AxisWatch> axes_;
  Findings findings_;
  bool sequence_known_ = false;
  std::uint32_t sequence_ = 0;
  std::uint32_t kernel_ticks_ = 0;               /**< since the kernel counts from its start */
  std::array<std::uint32_t, 2> sent_counters_{}; /**< of the last tick and the one before */
};

}  // namespace interlock::oracle

#endif
