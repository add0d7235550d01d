/**
 * @file
 * Which faults happen in a case, and when. A plan is made before the case runs, so that a failing case can be
 * run again with fewer of them.
 */
#ifndef INTERLOCK_CAMPAIGN_PLAN_HPP
#define INTERLOCK_CAMPAIGN_PLAN_HPP

#include <cstdint>
#include <string_view>
#include <vector>

#include "interlock/types.h"

namespace interlock::campaign {

enum class FaultKind : std::uint8_t {
  kPedalReleased,
  kPedalBounces,
  kPedalHalfPressed,
  kPedalStuck,
  kPedalUndefined,
  kEstopPulled,
  kEstopUndefined,
  kFrameCorrupt,
  kFrameDropped,
  kFrameLate,
  kFrameRepeated,
  kCardDeaf,
  kCardReset,
  kCardUnplugged,
  kTransactionFails,
  kEncoderStuck,
  kEncoderJumps,
  kEncoderSlips,
  kEncoderReversed,
  kAxisDrifts,
  kSwitchStuckOpen,
  kSwitchStuckClosed,
  kSwitchBounces,
  kAxisJammed,
  kAxisRunsAway,
  kAxisPushed,
  kAppSilent,
  kAppLies,
  kAppFloods,
  kAppAttachesAnew,
  kOtherHolder,
  kClockOverruns,
  kStateBitFlips,
  kConfigBitFlips,
};

inline constexpr std::size_t kFaultKinds = static_cast<std::size_t>(FaultKind::kConfigBitFlips) + 1;
/** Pairs of kinds that are drawn, a kind with itself among them. Bits of the configuration are not drawn. */
inline constexpr std::size_t kKindPairs = (kFaultKinds - 1) * kFaultKinds / 2;

inline constexpr std::size_t kStateBits = sizeof(ilk_state_t) * 8;
inline constexpr std::size_t kConfigBits = sizeof(ilk_config_t) * 8;

/** Driven ticks of a press over which E-stop and pedal are swept; no foot of the campaign holds longer. */
inline constexpr std::uint32_t kMoveTicks = 2500;

std::string_view name_of(FaultKind kind);

struct Fault {
  std::uint32_t tick = 0;
  FaultKind kind = FaultKind::kPedalReleased;
  std::uint32_t slot = 0;
  std::uint32_t ticks = 0;  /**< how long it lasts, or how many frames it spoils */
  std::uint32_t amount = 0; /**< a random word: size, sense or bit, as the kind needs it */
  /** After that many driven ticks of a press, from 1, but not before `tick`; 0: at `tick`. A bit of the
   * configuration waits from `tick` on for a driven axis, as long as `kFlipPatience`. */
  std::uint32_t driven_ticks = 0;
};

/** Ticks that a flip of the configuration waits for a driven axis. */
inline constexpr std::uint32_t kFlipPatience = 2000;

/** Everything that makes a case, besides the code. Equal cases run to equal bits. */
struct Case {
  std::uint64_t seed = 1;
  std::uint64_t number = 0;
  std::uint32_t ticks = 0;
  std::vector<Fault> faults; /**< by tick */
};

/**
 * Whether the case of that number sweeps: nothing happens in it but E-stop and pedal, each at one tick of a
 * press after the other, and the next sweeping case goes on where it ends.
 */
bool sweeps_stops(std::uint64_t number);

/**
 * Whether all axes of the case of that number are homed again and again by a patient foot, while a switch or
 * the axis itself fails for as long as the case lasts: in no other is a homing given up.
 */
bool homes_patiently(std::uint64_t number);

/**
 * The case of that number: one that sweeps, one that homes, or one with faults alone and in pairs, in which
 * the bits of the configuration flip one after the other from case to case.
 */
Case make_case(std::uint64_t seed, std::uint64_t number);

}  // namespace interlock::campaign

#endif
