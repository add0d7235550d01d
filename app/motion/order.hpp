/**
 * @file
 * Orders: what the control thread carries out of an approved proposal: a move of one axis, homing, or several
 * axes along a path.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "interlock/types.h"
#include "motion/held_lease.hpp"

namespace interlock {

/** A move of one axis. */
struct Order {
  std::uint32_t proposal = 0; /**< number of the proposal, from 1 */
  std::uint32_t slot = 0;
  std::int32_t target_counts = 0;
  std::uint32_t max_drive = 0; /**< 0: the axis' own bound */
  std::uint32_t stops = 0; /**< STOPs seen by the author; an order older than the newest STOP never starts */
  /** A jog, begun then: it goes on only for as long as `Renewal`s come. Nothing: it needs none. */
  std::optional<Moment> held = std::nullopt;
};

/** Whoever jogs still holds on. */
struct Renewal {
  std::uint32_t proposal = 0;
  Moment held;
};

/** For which a jog goes on without a renewal. */
constexpr std::chrono::milliseconds jog_patience{200};

/**
 * Homing: steps of the robot in the order of its file, or one axis alone.
 *
 * The control thread knows the steps by itself, so that an order is small and cannot name motion that the
 * robot file does not.
 */
struct HomeOrder {
  std::uint32_t proposal = 0;
  std::uint32_t first_step = 0; /**< index of the robot's home steps */
  std::uint32_t step_count = 0; /**< from 1; 0: no step but the axis in `slot`, at its switch */
  std::uint32_t slot = 0;
  std::uint32_t stops = 0; /**< as in `Order` */
};

struct PathProgram;

/** Several axes together, along the legs of a program. */
struct PathOrder {
  std::uint32_t proposal = 0;
  const PathProgram* program = nullptr; /**< outlives the order: see `PathStatus` */
  std::uint32_t stops = 0;              /**< as in `Order` */
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
struct SweepOrder {
  std::uint32_t proposal = 0;
  std::uint32_t slot = 0;
  FrequencySteps steps;
  std::uint32_t stops = 0; /**< as in `Order` */
};

/** Where an order stands. The last five are final. */
enum class OrderPhase : std::uint8_t { none, waiting, executing, paused, done, refused, aborted, expired };

/** Whether an order in this phase can still move something. */
constexpr bool is_open(OrderPhase phase) noexcept {
  return phase == OrderPhase::waiting || phase == OrderPhase::executing || phase == OrderPhase::paused;
}

/** Why an order stands where it does. */
enum class OrderReason : std::uint8_t {
  none,
  arrived,         /**< at rest within the deadband */
  pedal_released,  /**< waits for the pedal */
  kernel_refused,  /**< `code` is the verdict */
  stopped,         /**< STOP */
  let_go,          /**< a jog was not renewed in time */
  nobody_served,   /**< the threads that serve people stood still */
  cancelled,       /**< its author ended it */
  locked,          /**< `code` is the cause of LOCKED */
  axis_disabled,   /**< the axis was taken out of motion */
  axis_homing,     /**< homing took over the axis */
  axis_faulted,    /**< `code` is the fault */
  blocked,         /**< a limit held the axis back for too long; `code` is the gate */
  link_lost,       /**< the kernel went away */
  waited_too_long, /**< not executing for longer than a motion may wait */
  press_again,     /**< the travel that one press allows is used up: waits for a release and a press */
  not_homed,       /**< a step moves an axis to a position, and the axis is not homed */
  verdict_lost,    /**< the kernel's answer to a HOME got lost */
  authority_changed,
  position_declared, /**< SET_HOME or RESTORE gave the axis another position */
  superseded,        /**< another motion took over the axes */
  off_path,          /**< an axis strayed from its path */
  goal_late,         /**< an axis did not come to rest at its goal in time */
  force_stale,       /**< the newest force is too old to act upon */
  steering_failed,   /**< `code` is the KinematicsError::Code */
  swept,             /**< every frequency was held for its time */
  no_path            /**< no motion within the limits leads there from where the axes are */
};

/** Level, not edge: the newest view always tells the whole truth about the slot's newest order. */
struct OrderStatus {
  std::uint32_t proposal = 0;
  OrderPhase phase = OrderPhase::none;
  OrderReason reason = OrderReason::none;
  std::uint32_t code = 0;
  std::uint32_t tick = 0; /**< kernel tick of the last change */

  bool operator==(const OrderStatus&) const = default;
};

/** For each slot, its newest order. */
using OrderTable = std::array<OrderStatus, ILK_SLOTS>;

/** Where the newest homing order stands. */
struct HomeStatus {
  OrderStatus order;
  std::uint32_t step = 0;       /**< index of the home step that runs or is next; unused for one axis alone */
  std::uint32_t slot = 0;       /**< axis that the reason is about */
  std::int32_t left_counts = 0; /**< of the nudge of that axis, signed; 0 where nothing is left */

  bool operator==(const HomeStatus&) const = default;
};

/**
 * Where the newest path order stands. The program of an order is no longer read once this names a later
 * proposal, or its own as final.
 */
struct PathStatus {
  OrderStatus order;
  std::uint32_t leg = 0;  /**< index of the leg that runs or is next */
  std::uint32_t slot = 0; /**< axis that the reason is about */

  bool operator==(const PathStatus&) const = default;
};

/** Where the newest sweep stands, and what it has measured. */
struct SweepStatus {
  OrderStatus order;
  std::uint32_t step = 0; /**< index of the frequency that runs or is next; their number once done */
  /** Mean speed at each frequency that is over; 0 where the dwell was too short for a steady speed. */
  std::array<float, FrequencySteps::most> counts_per_s{};

  bool operator==(const SweepStatus&) const = default;
};

}  // namespace interlock
