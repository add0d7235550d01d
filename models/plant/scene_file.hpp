/**
 * @file
 * The tables of a plant file that say what a needle robot works on.
 */
#ifndef INTERLOCK_PLANT_SCENE_FILE_HPP
#define INTERLOCK_PLANT_SCENE_FILE_HPP

#include <optional>

#include "plant/toml_reader.hpp"

namespace interlock::plant {

inline constexpr std::array<std::string_view, 5> kSceneKeys = {"needle", "layer", "membrane", "target",
                                                               "image"};

/**
 * Nothing without a table `needle`; the other tables are refused then.
 *
 * @param parameters whose sensors were read already
 */
std::optional<SceneParameters> read_scene(Reader& reader, const toml::table& document,
                                          const ilk_config_t& robot, const Parameters& parameters);

}  // namespace interlock::plant

#endif
