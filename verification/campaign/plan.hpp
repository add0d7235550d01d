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

std::string_view name_of(FaultKind kind);

struct Fault {
  std::uint32_t tick = 0;
  FaultKind kind = FaultKind::kPedalReleased;
  std::uint32_t slot = 0;
  std::uint32_t ticks = 0;  /**< how long it lasts, or how many frames it spoils */
  std::uint32_t amount = 0; /**< a random word: size, sense or bit, as the kind needs it */
};

/** Everything that makes a case, besides the code. Equal cases run to equal bits. */
struct Case {
  std::uint64_t seed = 1;
  std::uint64_t number = 0;
  std::uint32_t ticks = 0;
  std::vector<Fault> faults; /**< by tick */
};

/** The case of that number, with faults alone and in pairs. */
Case make_case(std::uint64_t seed, std::uint64_t number);

}  // namespace interlock::campaign

#endif
