#include "plan.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "plant/random.hpp"

namespace interlock::campaign {
namespace {

constexpr std::uint64_t kPlanStream = 1;
constexpr std::uint32_t kCaseTicks = 20'000;
constexpr std::uint32_t kQuietTicks = 400;   /**< before the first fault */
constexpr std::uint64_t kCasesPerSteady = 5; /**< cases, of which one has a foot that stays down */
constexpr std::uint64_t kStopsPerSweep = 8;  /**< as many as a case has time for */
constexpr std::uint64_t kStopStride = 1013;  /**< prime to the ticks of a move: short and long presses mix */
constexpr std::uint64_t kFlipsPerCase = 4;
constexpr std::uint32_t kFlipInterval = (kCaseTicks - kQuietTicks) / kFlipsPerCase;
constexpr std::uint32_t kFlipTicks = 30; /**< until the bit is right again */
constexpr std::uint32_t kLongestStop = 60;
constexpr std::uint64_t kSteadyCasesPerHoming = 3; /**< of those in which the foot stays down */
constexpr std::uint32_t kHomingFaults = 3;
constexpr std::uint32_t kJamTicks = 20; /**< shorter than any axis takes to be seen stalled */
constexpr std::uint32_t kFreeTicks = 5;

static_assert(std::gcd(kStopStride, std::uint64_t{kMoveTicks}) == 1, "the sweep comes to every tick");
static_assert(kFlipPatience + kFlipTicks < kFlipInterval, "one flip is over before the next");

/** How often a kind is drawn, and how long it lasts. */
struct Habit {
  FaultKind kind;
  std::string_view name;
  std::uint32_t weight;
  std::uint32_t shortest;
  std::uint32_t longest;
};

// What is over in a tick or two is drawn often, what takes a recovery seldom: else nothing would ever move.
// Bits of the configuration are not drawn: they come in their order.
constexpr std::array<Habit, kFaultKinds> kHabits{{
    {FaultKind::kPedalReleased, "pedal released", 60, 1, 40},
    {FaultKind::kPedalBounces, "pedal bounces", 20, 2, 30},
    {FaultKind::kPedalHalfPressed, "pedal half pressed", 15, 1, 80},
    {FaultKind::kPedalStuck, "pedal stuck", 15, 20, 200},
    {FaultKind::kPedalUndefined, "pedal contact undefined", 10, 1, 4},
    {FaultKind::kEstopPulled, "E-stop pulled", 25, 1, 60},
    {FaultKind::kEstopUndefined, "E-stop undefined", 6, 1, 2},
    {FaultKind::kFrameCorrupt, "frame corrupt", 130, 1, 6},
    {FaultKind::kFrameDropped, "frame dropped", 110, 1, 6},
    {FaultKind::kFrameLate, "frame late", 110, 1, 6},
    {FaultKind::kFrameRepeated, "frame repeated", 110, 1, 6},
    {FaultKind::kCardDeaf, "card deaf", 60, 1, 8},
    {FaultKind::kCardReset, "card reset", 15, 1, 1},
    {FaultKind::kCardUnplugged, "card unplugged", 10, 2, 60},
    {FaultKind::kTransactionFails, "transaction fails", 20, 1, 6},
    {FaultKind::kEncoderStuck, "encoder stuck", 30, 20, 800},
    {FaultKind::kEncoderJumps, "encoder jumps", 40, 1, 1},
    {FaultKind::kEncoderSlips, "encoder slips", 30, 10, 200},
    {FaultKind::kEncoderReversed, "encoder reversed", 25, 50, 500},
    {FaultKind::kAxisDrifts, "axis drifts", 25, 100, 600},
    {FaultKind::kSwitchStuckOpen, "switch stuck open", 30, 50, 2000},
    {FaultKind::kSwitchStuckClosed, "switch stuck triggered", 40, 1, 400},
    {FaultKind::kSwitchBounces, "switch bounces", 30, 2, 60},
    {FaultKind::kAxisJammed, "axis jammed", 40, 20, 900},
    {FaultKind::kAxisRunsAway, "axis runs away", 25, 5, 100},
    {FaultKind::kAxisPushed, "axis pushed", 20, 100, 100},
    {FaultKind::kAppSilent, "app silent", 20, 20, 400},
    {FaultKind::kAppLies, "app lies", 60, 1, 60},
    {FaultKind::kAppFloods, "app floods", 40, 1, 20},
    {FaultKind::kAppAttachesAnew, "app attaches anew", 8, 1, 1},
    {FaultKind::kOtherHolder, "other holder", 8, 1, 1},
    {FaultKind::kClockOverruns, "clock overruns", 20, 1, 6},
    {FaultKind::kStateBitFlips, "bit of the state flips", 10, 1, 1},
    {FaultKind::kConfigBitFlips, "bit of the configuration flips", 0, kFlipTicks, kFlipTicks},
}};

constexpr bool habits_are_in_order() {
  for (std::size_t kind = 0; kind < kFaultKinds; kind++) {
    if (static_cast<std::size_t>(kHabits[kind].kind) != kind) {
      return false;
    }
  }
  return true;
}
static_assert(habits_are_in_order(), "a kind names its row");

std::uint32_t total_weight() {
  std::uint32_t total = 0;
  for (const Habit& habit : kHabits) {
    total += habit.weight;
  }
  return total;
}

/** Nothing but its own faults happens in such a case: it sweeps or homes. */
bool is_steady(std::uint64_t number) { return number % kCasesPerSteady == kCasesPerSteady - 1; }

Fault draw(plant::Random& random, std::uint32_t tick) {
  std::uint32_t left = random.below(total_weight());
  const Habit* habit = kHabits.data();
  while (left >= habit->weight) {
    left -= habit->weight;
    habit++;
  }
  return {tick,
          habit->kind,
          random.below(ILK_SLOTS),
          habit->shortest + random.below(habit->longest - habit->shortest + 1),
          random.below(0xFFFFFFFF),
          0};
}

void add_drawn_faults(Case& plan, plant::Random& random) {
  std::uint32_t tick = kQuietTicks;
  while (tick < kCaseTicks) {
    plan.faults.push_back(draw(random, tick));
    if (random.chance(0.35)) {
      plan.faults.push_back(draw(random, tick + random.below(4)));
    }
    // Bursts, with pauses in which the robot gets into motion again.
    tick += random.chance(0.8) ? 1 + random.below(90) : 100 + random.below(400);
  }
}

/** The next bits of the configuration, each somewhere in its share of the case. */
void add_config_flips(Case& plan, plant::Random& random) {
  const std::uint64_t cases_before = plan.number - plan.number / kCasesPerSteady;
  for (std::uint32_t flip = 0; flip < kFlipsPerCase; flip++) {
    const std::uint32_t begin = kQuietTicks + flip * kFlipInterval;
    const std::uint32_t tick = begin + random.below(kFlipInterval - kFlipPatience - kFlipTicks);
    const auto bit = static_cast<std::uint32_t>((cases_before * kFlipsPerCase + flip) % kConfigBits);
    plan.faults.push_back({tick, FaultKind::kConfigBitFlips, 0, kFlipTicks, bit, 0});
  }
}

/** An axis that sticks and slips: it gets on, but far too slowly. */
void add_stick_slip(Case& plan, std::uint32_t first, std::uint32_t slot) {
  for (std::uint32_t tick = first; tick < kCaseTicks; tick += kJamTicks + kFreeTicks) {
    plan.faults.push_back({tick, FaultKind::kAxisJammed, slot, kJamTicks, 0, 0});
  }
}

/** One thing that homings may meet, on some axes, for as long as the case lasts. */
void add_homing_faults(Case& plan, plant::Random& random) {
  constexpr FaultKind kinds[] = {FaultKind::kSwitchStuckOpen, FaultKind::kSwitchStuckClosed,
                                 FaultKind::kAxisJammed};
  const FaultKind kind = kinds[random.below(std::size(kinds))];
  for (std::uint32_t n = random.below(kHomingFaults) + 1; n > 0; n--) {
    const std::uint32_t slot = random.below(ILK_SLOTS);
    if (kind == FaultKind::kAxisJammed) {
      add_stick_slip(plan, kQuietTicks, slot);
    } else {
      const std::uint32_t tick = random.below(kCaseTicks / 4);
      plan.faults.push_back({tick, kind, slot, kCaseTicks - tick, random.below(0xFFFFFFFF), 0});
    }
  }
}

/** E-stop and pedal in turn, each at the next tick of a press. */
void add_stops(Case& plan, plant::Random& random) {
  const std::uint64_t steady_before = plan.number / kCasesPerSteady;
  const std::uint64_t first = (steady_before - steady_before / kSteadyCasesPerHoming) * kStopsPerSweep;
  for (std::uint64_t stop = first; stop < first + kStopsPerSweep; stop++) {
    const FaultKind kind = stop % 2 == 0 ? FaultKind::kEstopPulled : FaultKind::kPedalReleased;
    const auto driven_ticks = static_cast<std::uint32_t>(1 + stop / 2 * kStopStride % kMoveTicks);
    plan.faults.push_back({kQuietTicks, kind, 0, 1 + random.below(kLongestStop), 0, driven_ticks});
  }
}

}  // namespace

std::string_view name_of(FaultKind kind) { return kHabits[static_cast<std::size_t>(kind)].name; }

bool homes_patiently(std::uint64_t number) {
  return is_steady(number) && number / kCasesPerSteady % kSteadyCasesPerHoming == kSteadyCasesPerHoming - 1;
}

bool sweeps_stops(std::uint64_t number) { return is_steady(number) && !homes_patiently(number); }

Case make_case(std::uint64_t seed, std::uint64_t number) {
  plant::Random random(seed ^ (number * 0x9e3779b97f4a7c15u), kPlanStream);
  Case plan{seed, number, kCaseTicks, {}};
  if (sweeps_stops(number)) {
    add_stops(plan, random);
  } else if (homes_patiently(number)) {
    add_homing_faults(plan, random);
  } else {
    add_drawn_faults(plan, random);
    add_config_flips(plan, random);
  }
  std::ranges::stable_sort(plan.faults, {}, &Fault::tick);
  return plan;
}

}  // namespace interlock::campaign
