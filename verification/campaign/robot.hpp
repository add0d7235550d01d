/**
 * @file
 * A robot for one case: ten axes of all card types with seeded numbers, as the kernel's configuration and
 * as the plant's parameters.
 */
#ifndef INTERLOCK_CAMPAIGN_ROBOT_HPP
#define INTERLOCK_CAMPAIGN_ROBOT_HPP

#include <cstddef>
#include <cstdint>
#include <optional>

#include "interlock/types.h"
#include "plant/parameters.hpp"
#include "plant/random.hpp"

namespace interlock::campaign {

/** Ticks within which damage to the configuration has to be met: it is checked a slot a tick, so two passes
 * see all. */
inline constexpr std::uint32_t kConfigPassTicks = 2 * ILK_SLOTS;

/** Ticks within which a flipped bit of the configuration has to be met: none for the words that P1 to P3 rest
 * on. */
std::uint32_t met_within(std::size_t config_bit);

struct Robot {
  ilk_config_t config;
  plant::Parameters plant;
  std::optional<std::size_t> far_coaster; /**< axis that coasts farther than its configuration says */
};

/**
 * The configuration is valid by construction.
 *
 * @param keeps_word no axis coasts farther than its configuration says
 */
Robot make_robot(plant::Random& random, bool keeps_word = false);

/** Lets some axes begin beyond the soft limit that is farthest from their switch: the longest ways home. */
void push_to_far_ends(Robot& robot, plant::Random& random);

/** Lets each axis begin where SET_HOME says the truth. */
void stand_at_zero(Robot& robot);

}  // namespace interlock::campaign

#endif
