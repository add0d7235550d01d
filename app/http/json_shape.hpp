/**
 * @file
 * What JSON must not be, besides malformed, before anything is made of it.
 */
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace interlock::web {

/** Objects and arrays in one another. */
constexpr std::size_t deepest_json = 64;

/**
 * What is wrong with the shape of a JSON text: deeper than `deepest_json`, or a key twice in one object, of
 * which one reader would take the first and another the last. Nothing for a text that is no JSON at all.
 */
std::optional<std::string> flaw_of_json(std::string_view text);

}  // namespace interlock::web
