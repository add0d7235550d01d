/**
 * @file
 * A task: one motion that somebody wants, whole, and what becomes of it on the control thread.
 *
 * A task owns what it needs and never changes once it is made. Both threads hold it by a counted reference,
 * so that neither has to know when the other is done with it. Its progress comes back by value.
 */
#pragma once

#include <array>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeinfo>
#include <utility>
#include <vector>

#include "interlock/types.h"
#include "kinematics/pose.hpp"
#include "motion/deadman_timer.hpp"
#include "motion/path_program.hpp"
#include "robot/modes.hpp"
#include "targeting/error_budget.hpp"
#include "tuning/axis_measurement.hpp"

namespace interlock {

struct BiopsyRun;

/** A move of one axis. */
struct MoveTask {
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;
  std::optional<std::uint32_t> drive = std::nullopt; /**< upper bound; empty: the axis' own */
  bool jog = false;                                  /**< it goes on only for as long as `Renewal`s come */
};

/**
 * Homing: steps of the robot in the order of its file, or one axis alone.
 *
 * The control thread knows the steps by itself, so that a task cannot name motion that the robot file does
 * not.
 */
struct HomeTask {
  std::uint32_t first_step = 0; /**< index of the robot's home steps */
  std::uint32_t step_count = 0; /**< from 1; 0: no step but the one axis, at its switch */
  std::vector<std::uint32_t> slots =
      {}; /**< of all axes that move, each once, in the order in which they move */
};

/** Several axes together, along the legs of a program. */
struct PathTask {
  std::shared_ptr<const PathProgram> program; /**< never null */
};

/** Frequencies of a sweep, as words of the published map (control/frequency_map.hpp), one after the other. */
struct FrequencySteps {
  /** So many may a sweep have. */
  static constexpr std::uint32_t most = 200;

  std::uint32_t first_word = 0;
  std::int32_t step_words = 0;   /**< from each to the next; below 0: towards faster turning */
  std::uint32_t count = 0;       /**< 1 to `most` */
  std::uint32_t dwell_ticks = 0; /**< at each, of driven time */

  /** The frequency word of a step. */
  [[nodiscard]] constexpr std::uint32_t word(std::uint32_t step) const noexcept {
    return first_word + step * static_cast<std::uint32_t>(step_words);
  }
  bool operator==(const FrequencySteps&) const = default;
};

/** One high-frequency axis through a list of frequencies. */
struct SweepTask {
  std::uint32_t slot = 0;
  FrequencySteps steps;
};

/** One axis, measured (tuning/axis_measurement.hpp). */
struct IdentificationTask {
  std::uint32_t slot = 0;
  MeasuringRange range; /**< that its setpoints stay in */
};

/** The needle, pushed by the surgeon's hand and turned towards its target. */
struct BiopsyTask {
  /** Never null while the task is open. From its start on the control thread alone touches what it points to.
   */
  std::shared_ptr<BiopsyRun> run;
  std::array<double, 3> target_mm{}; /**< in the guide frame of motion/biopsy_run.hpp */
  std::uint32_t start_tick = 0;      /**< kernel tick of the run's time 0 */
  /** The guide frame in the scanner's, where the target was given in that. */
  std::optional<Pose> scanner_from_guide = std::nullopt;
};

/** What is to be done: the task of one kind of motion, whichever that is. Shared, and never changed. */
class Work {
 public:
  /** Of a task of any kind. */
  template <typename Kind>
    requires(!std::same_as<Kind, Work>)
  Work(Kind task) : type_(&typeid(Kind)), task_(std::make_shared<const Kind>(std::move(task))) {}

  /** The task, if it is of that kind, or null. */
  template <typename Kind>
  [[nodiscard]] const Kind* find() const noexcept {
    return *type_ == typeid(Kind) ? static_cast<const Kind*>(task_.get()) : nullptr;
  }

  /** The task, which is of that kind. */
  template <typename Kind>
  [[nodiscard]] const Kind& as() const noexcept {
    return *static_cast<const Kind*>(task_.get());
  }

  /** Of the task. */
  [[nodiscard]] const std::type_info& type() const noexcept { return *type_; }

 private:
  const std::type_info* type_;
  std::shared_ptr<const void> task_;
};

/** Who thought of a motion. */
enum class TaskSource : std::uint8_t {
  console,    /**< a person: proposing a motion of one axis approves it */
  file,       /**< a loaded trajectory */
  openigtlink /**< a navigation program */
};

/** As the interface spells it. */
constexpr std::string_view source_name(TaskSource source) noexcept {
  constexpr std::string_view names[] = {"console", "file", "openigtlink"};
  return names[static_cast<std::size_t>(source)];
}

/** What was asked of the treatment point, and what the motion reaches of it; in the scanner's frame (RAS),
 * mm. */
struct ReachedAim {
  Pose desired;
  Pose reachable;
  KinematicsResult<ErrorBudget> error_budget; /**< of the reachable pose, or why there is none */
};

/** One motion that somebody wants. */
struct Task {
  Work work;
  std::string author; /**< name of the user */
  RobotMode mode = RobotMode::manual;
  TaskSource source = TaskSource::console;
  /** It follows from registration, probe and target of that revision: stale once these change. */
  std::optional<std::uint32_t> targeting_revision = std::nullopt;
  std::optional<ReachedAim> aim = std::nullopt; /**< of a motion to a pose */
  /** Where axes stood when it was made, from which it followed: it is right only while they stand there, but
   * for those that it moves itself. */
  std::vector<AxisCounts> rests_on = {};
  std::uint32_t id = 0;         /**< from 1; 0: nobody has proposed it yet */
  std::int64_t case_number = 0; /**< of the case that was open when it was proposed; 0: none was */
};

/** By which both threads hold a task. */
using TaskReference = std::shared_ptr<const Task>;

/** Consent to a task, on its way to the control thread. */
struct Approval {
  TaskReference task; /**< never null */
  std::uint32_t stops =
      0; /**< STOPs seen by whoever approved; one older than the newest STOP starts nothing */
  /** Later than this it starts nothing: what was looked at may have changed. */
  std::chrono::steady_clock::time_point deadline;
  Moment held; /**< when a jog began */
};

/** Somebody has looked at what a task has reached, and it may go on to what needs that. */
struct Confirmation {
  std::uint32_t task = 0;
  std::uint32_t stops = 0;                        /**< as of an `Approval` */
  std::chrono::steady_clock::time_point deadline; /**< as of an `Approval` */
};

/** For which an approval may be on its way, from when somebody gave it. */
constexpr std::chrono::milliseconds approval_timeout{1000};

/** Whoever jogs still holds on. */
struct Renewal {
  std::uint32_t task = 0;
  Moment held;
};

/** For which a jog goes on without a renewal. */
constexpr std::chrono::milliseconds jog_timeout{200};

/** Where a task stands on the control thread. The last five are final. */
enum class TaskPhase : std::uint8_t { none, waiting, executing, paused, done, refused, aborted, expired };

/** Whether a task in this phase can still move something. */
constexpr bool is_open(TaskPhase phase) noexcept {
  return phase == TaskPhase::waiting || phase == TaskPhase::executing || phase == TaskPhase::paused;
}

/** Why a task stands where it does. */
enum class TaskReason : std::uint8_t {
  none,
  arrived,         /**< at rest within the deadband */
  pedal_released,  /**< waits for the pedal */
  kernel_refused,  /**< `code` is the verdict */
  stopped,         /**< STOP */
  let_go,          /**< a jog was not renewed in time */
  nobody_served,   /**< the threads that serve people stood still */
  approved_late,   /**< the approval came after its deadline */
  cancelled,       /**< its author ended it */
  locked,          /**< `code` is the cause of LOCKED */
  axis_disabled,   /**< the axis was taken out of motion */
  axis_homing,     /**< homing took over the axis */
  axis_faulted,    /**< `code` is the fault */
  blocked,         /**< a limit held the axis back for too long; `code` is the gate */
  link_lost,       /**< the kernel went away */
  waited_too_long, /**< not executing for longer than a motion may wait */
  press_again,     /**< waits for a release and a press: the travel that one press allows is used up, or the
                      pedal was held when the motion was approved */
  unconfirmed,     /**< waits for a `Confirmation` */
  breathing,       /**< the insertion waits for the breathing gate to open */
  gate_turned_off, /**< the gate was turned off while the insertion waited for it: waits for a release and a
                      press */
  scanning,        /**< waits for the end of a scan */
  not_homed,       /**< a step moves an axis to a position, and the axis is not homed */
  verdict_lost,    /**< the kernel's answer to a HOME got lost */
  control_changed,
  position_declared, /**< SET_HOME or RESTORE gave the axis another position */
  superseded,        /**< another motion took over the axes */
  off_path,          /**< an axis strayed from its path */
  goal_late,         /**< an axis did not come to rest at its goal in time */
  force_stale,       /**< the newest force is too old to act upon */
  steering_failed,   /**< `code` is the KinematicsError::Code */
  swept,             /**< every frequency was held for its time */
  measured,          /**< the axis was measured at every drive at which it moves */
  axis_stands,       /**< an axis that is measured does not move where it has to */
  moved_away,        /**< an axis was moved that has to stand still */
  linkage_strained,  /**< the linked slider came too near, or too far away */
  no_path            /**< no motion within the limits leads there from where the axes are */
};

/** Level, not edge: the newest view always shows the whole truth about the newest task of each place. */
struct TaskStatus {
  std::uint32_t task = 0;
  TaskPhase phase = TaskPhase::none;
  TaskReason reason = TaskReason::none;
  std::uint32_t code = 0;
  std::uint32_t tick = 0; /**< kernel tick of the last change of the phase */
  std::uint32_t slot = 0; /**< axis or card that the reason is about */
  std::uint32_t step = 0; /**< home step, leg or frequency that runs or is next; their number once done */
  std::int32_t left_counts = 0; /**< of the nudge of that axis, signed; 0 where nothing is left */

  bool operator==(const TaskStatus&) const = default;
};

/** The newest task of each place: a place for the move of each slot, and one for each other kind. */
class TaskTable {
 public:
  /** So many other kinds may a robot have. */
  static constexpr std::size_t most_kinds = 16;

  /** Of the move of a slot. */
  [[nodiscard]] const TaskStatus& move(std::uint32_t slot) const noexcept { return all_[slot]; }
  /** As above, to be written. */
  [[nodiscard]] TaskStatus& move(std::uint32_t slot) noexcept { return all_[slot]; }

  /** Of the kind whose tasks are of that type, to be written. */
  [[nodiscard]] TaskStatus& of(const std::type_info& type) noexcept {
    std::size_t kind = 0;
    while (kind + 1 < most_kinds && kinds_[kind] != nullptr && *kinds_[kind] != type) {
      ++kind;
    }
    kinds_[kind] = &type;
    return all_[ILK_SLOTS + kind];
  }
  /** As above, of a kind that is not `MoveTask`. */
  template <typename Kind>
  [[nodiscard]] TaskStatus& of() noexcept {
    return of(typeid(Kind));
  }
  /** As above, to be read. */
  template <typename Kind>
  [[nodiscard]] TaskStatus of() const noexcept {
    return TaskTable(*this).of(typeid(Kind));
  }

  /** The statuses of all places, each once. */
  [[nodiscard]] auto begin() noexcept { return all_.begin(); }
  /** Behind the last one. */
  [[nodiscard]] auto end() noexcept { return all_.end(); }
  [[nodiscard]] auto begin() const noexcept { return all_.begin(); }
  [[nodiscard]] auto end() const noexcept { return all_.end(); }
  bool operator==(const TaskTable&) const = default;

 private:
  std::array<const std::type_info*, most_kinds> kinds_{};
  std::array<TaskStatus, ILK_SLOTS + most_kinds> all_{};
};

/** Mean speed at each frequency of the newest sweep that is over; 0 where the dwell was too short. */
using SweepSpeeds = std::array<float, FrequencySteps::most>;

}  // namespace interlock
