/**
 * @file
 * Which new passwords are too easy to guess.
 */
#pragma once

#include <string_view>

namespace interlock {

/**
 * Whether the password has fewer than 6 parts that a guesser does not get for free. As one part each count:
 * - the user's name and each word of a list of those that common passwords are made of, in any case;
 * - a run of equal characters, of neighbours in the alphabet or on a keyboard's row, in either direction;
 * - a repetition of what is before it.
 *
 * So refused are `aaaaaaaaaa`, `1234567890`, `qwertyuiop`, `password12` and the name repeated. The rule keeps
 * the commonest guesses out; it measures no strength.
 */
bool is_easy_to_guess(std::string_view password, std::string_view user);

}  // namespace interlock
