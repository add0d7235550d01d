/**
 * @file
 * The kernel's binary configuration as the plant reads it: cards, wiring and ranges.
 */
#ifndef INTERLOCK_PLANT_ROBOT_FILE_HPP
#define INTERLOCK_PLANT_ROBOT_FILE_HPP

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "interlock/types.h"

namespace interlock::plant {

/**
 * Reads a compiled robot file (`interlock model compile`).
 *
 * Checks what the plant relies on: size, version, CRC, period, card types, ranges and drives. Whether a
 * configuration is safe is the kernel's business.
 *
 * @return the configuration, or what is wrong, where, and what was expected
 */
tl::expected<ilk_config_t, std::string> load_robot(const std::filesystem::path& path);

}  // namespace interlock::plant

#endif
