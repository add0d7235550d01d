/**
 * @file
 * Configurations that have to be refused: a kernel that starts with one must stay in INIT and drive nothing.
 */
#ifndef INTERLOCK_CAMPAIGN_REFUSAL_HPP
#define INTERLOCK_CAMPAIGN_REFUSAL_HPP

#include <cstdint>
#include <optional>
#include <string_view>

#include "interlock/types.h"
#include "plant/random.hpp"

namespace interlock::campaign {

/** Ways in which a configuration is spoilt, each a rule of the specification that it then breaks. */
std::size_t spoilings();

/**
 * A valid configuration with one rule broken; its checksum is right, unless that is the rule.
 *
 * @param way below `spoilings()`
 * @param random chooses the axis and the bit
 */
ilk_config_t spoilt(const ilk_config_t& config, std::size_t way, plant::Random& random);

/** Whether a kernel that starts with the configuration stays in INIT and drives nothing, whatever is asked.
 */
bool stays_inert(const ilk_config_t& config, std::uint32_t slot);

/**
 * Starts the kernel with each spoilt configuration and asks it for everything.
 *
 * @return what went wrong with the first that left INIT or drove something, if one did
 */
std::optional<std::string_view> judge_refusals(const ilk_config_t& config, plant::Random& random);

}  // namespace interlock::campaign

#endif
