/**
 * @file
 * What a hand or a fault does to the plant; README.md lists the same as control commands.
 */
#ifndef INTERLOCK_PLANT_COMMAND_HPP
#define INTERLOCK_PLANT_COMMAND_HPP

#include <array>
#include <optional>
#include <variant>

#include "plant/card.hpp"

namespace interlock::plant::command {

/** A number that a bench may ask for without the plant leaving the range of its counters. */
inline constexpr std::int32_t kMostCounts = 1'000'000;
inline constexpr double kMostCountsPerTick = 1000;
inline constexpr std::int32_t kMostForceCounts = 65535;
inline constexpr std::uint32_t kMostFrames = 1'000'000;
inline constexpr double kMostHandForce = 100;
inline constexpr double kMostShift = 100;

struct PressPedal {
  bool pressed;
};

struct StickPedalContact {
  bool normally_open;         /**< which contact */
  std::optional<bool> closed; /**< nothing frees it */
};

struct PullEstop {
  bool pulled;
};

struct JamAxis {
  std::size_t slot;
  bool jammed;
};

/** Moves the axis by hand, over 100 ticks. */
struct PushAxis {
  std::size_t slot;
  std::int32_t counts;
};

struct JumpCounter {
  std::size_t slot;
  std::int32_t counts;
};

struct RunAway {
  std::size_t slot;
  double counts_per_tick; /**< 0 ends it */
};

struct ReverseMotor {
  std::size_t slot;
  bool reversed;
};

struct StickEncoder {
  std::size_t slot;
  bool stuck;
};

struct StickSwitch {
  std::size_t slot;
  std::optional<bool> triggered; /**< nothing frees it */
};

/** Changes parameters of the axis; in the order of `kAxisKnobs`, nothing where one stays. */
struct ChangeParameters {
  std::size_t slot;
  std::array<std::optional<double>, kAxisKnobCount> value;
};

/** The axis has the parameters of the plant file again. */
struct RestoreParameters {
  std::size_t slot;
};

/** Presses on a force sensor. */
struct PressSensor {
  std::size_t slot;
  std::size_t input;   /**< 0 is ADC 1 */
  std::int32_t counts; /**< by which the input reads more; 0 releases it */
};

struct SpoilFrames {
  std::optional<std::size_t> slot; /**< nothing means all cards */
  FrameFault fault;
  std::uint32_t count;
};

struct ResetCard {
  std::size_t slot;
};

struct PowerCard {
  std::size_t slot;
  bool on;
};

/** In a failed transaction no card hears or answers; pedal and E-stop are still read. */
struct FailTransactions {
  std::uint32_t count;
};

/** The surgeon presses on the hand's force sensor. */
struct PressHand {
  double force_n; /**< 0 lets go */
};

/** The target of the needle moves. */
struct ShiftTarget {
  std::array<double, 3> by_mm; /**< in the guide frame */
};

/** Ends every fault; pedal, E-stop and parameters stay as they are, and so do commands for later ticks. */
struct Clear {};

using Command =
    std::variant<PressPedal, StickPedalContact, PullEstop, JamAxis, PushAxis, JumpCounter, RunAway,
                 ReverseMotor, StickEncoder, StickSwitch, ChangeParameters, RestoreParameters, PressSensor,
                 SpoilFrames, ResetCard, PowerCard, FailTransactions, PressHand, ShiftTarget, Clear>;

}  // namespace interlock::plant::command

#endif
