/**
 * @file
 * Reads plant parameters from TOML; README.md lists the keys.
 */
#ifndef INTERLOCK_PLANT_PARAMETERS_FILE_HPP
#define INTERLOCK_PLANT_PARAMETERS_FILE_HPP

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "plant/parameters.hpp"

namespace interlock::plant {

/**
 * Reads a plant file for a robot: each motor card of the robot needs an axis, and no other slot has one.
 *
 * @return the parameters, or the first fault as "file:line: key: what was expected"
 */
tl::expected<Parameters, std::string> load_parameters(const std::filesystem::path& path,
                                                      const ilk_config_t& robot);

}  // namespace interlock::plant

#endif
