/**
 * @file
 * What asks somebody to act: one list for consoles, log, audit, metrics and programs.
 *
 * A condition is an alarm for as long as it lasts. Conditions of one cause are one alarm: cards that are lost
 * together, and what a lock by the bus brings with it. Priorities are those of IEC 60601-1-8: by how bad the
 * harm is and how soon it comes. What asks for nobody is none: a lock after start, a refusal.
 */
#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "motion/realtime_channel.hpp"
#include "proposals/proposal.hpp"
#include "robot/robot.hpp"
#include "service/clocks.hpp"

namespace interlock {

/** high: act at once; medium: act soon; low: know of it. */
enum class AlarmPriority : std::uint8_t { low, medium, high };
inline constexpr std::size_t alarm_priorities = 3;

/** As the interface spells it. */
std::string_view alarm_priority_name(AlarmPriority priority) noexcept;

/** What is now, and asks somebody to act. */
struct AlarmCondition {
  std::string code; /**< "ESTOP", "STALL": of the catalog where it has one. One alarm has one code */
  AlarmPriority priority = AlarmPriority::low;
  std::string layer; /**< where to look: person, pedal, axis, card, bus, computer, simulator or kernel */
  std::string text;  /**< what is, a sentence or more */
  std::string next_step;
  std::vector<std::string> axes = {}; /**< names of those that it is about */

  bool operator==(const AlarmCondition&) const = default;
};

/** That somebody has seen an alarm and answers for it. */
struct Acknowledgement {
  std::string user;
  UtcTime time;

  bool operator==(const Acknowledgement&) const = default;
};

/** A condition from its begin on. */
struct Alarm {
  std::uint32_t id = 0; /**< from 1 on since the app was started */
  AlarmCondition condition;
  UtcTime begun;           /**< the first time */
  UtcTime last;            /**< the last time that it began */
  std::uint32_t count = 1; /**< how often it has begun */
  std::optional<UtcTime> ended;
  std::optional<Acknowledgement> acknowledged; /**< since it last began */

  bool operator==(const Alarm&) const = default;
};

/** Schema `Alarm` of spec/openapi.yaml. */
nlohmann::json to_json(const Alarm& alarm);

/** Belongs to the network thread. */
class Alarms {
 public:
  /** One that begins anew within this is the same alarm, and counts. */
  static constexpr std::chrono::seconds same_within{60};
  /** So many that are over are kept. */
  static constexpr std::size_t most_past = 100;

  /** Both must outlive it. */
  Alarms(const Robot& robot, const ilk_config_t& config) : robot_(robot), config_(config) {}

  /** Looks at the newest view. The alarms that have begun, ended or changed since the last look. */
  std::vector<Alarm> see(const ControlView& view, SteadyTime now, UtcTime time);

  /** Sees each change of a proposal: one that ended against everybody's will is an alarm until
   * somebody acknowledges it, or the next motion begins. */
  void follow(const Proposal& proposal);

  /** The same of a motion of which only its number is known. */
  void note_ended_motion(std::int64_t number, const std::string& why, std::vector<std::string> axes = {});

  /** Why the registration that was in force has expired; empty: one is in force, or none is needed. */
  void note_registration(std::string expired) { registration_expired_ = std::move(expired); }

  /** That alarm, if it is there or was lately. */
  [[nodiscard]] const Alarm* find(std::uint32_t id) const;

  /** Somebody answers for an alarm that is there, unless somebody did before. */
  void acknowledge(std::uint32_t id, const Acknowledgement& by);

  /** Those that are there, the worst first: by priority, then those that nobody has acknowledged, then the
   * oldest. */
  [[nodiscard]] const std::vector<Alarm>& present() const { return present_; }

  /** Those that are over, the newest first. */
  [[nodiscard]] const std::deque<Alarm>& past() const { return past_; }

  /** Schema `AlarmList`, of those that are there. */
  [[nodiscard]] nlohmann::json to_json() const;

 private:
  [[nodiscard]] std::vector<AlarmCondition> conditions(const ControlView& view, SteadyTime now);
  void add_lock(std::vector<AlarmCondition>& found, const ilk_system_t& system, SteadyTime now);
  void add_faults(std::vector<AlarmCondition>& found, const ilk_snapshot_t& snapshot) const;
  [[nodiscard]] bool was_lost_with_others(const std::string& axis) const;
  void add_computer(std::vector<AlarmCondition>& found, const ilk_snapshot_t& snapshot, SteadyTime now);

  const Robot& robot_;
  const ilk_config_t& config_;
  std::vector<Alarm> present_;
  std::deque<Alarm> past_;
  std::uint32_t last_id_ = 0;
  std::string registration_expired_;
  std::optional<AlarmCondition> ended_motion_;
  bool motion_just_ended_ = false;        /**< since the last look */
  std::optional<std::uint32_t> overruns_; /**< as last seen */
  std::optional<SteadyTime> late_;        /**< when this computer was last late */
  std::optional<SteadyTime> no_kernel_since_;
  std::optional<SteadyTime> disagree_since_; /**< the pedal's channels */
};

}  // namespace interlock
