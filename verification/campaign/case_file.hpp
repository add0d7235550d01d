/**
 * @file
 * A case as a file, to be run again: seed, number, ticks, and the faults that are left of its plan.
 */
#ifndef INTERLOCK_CAMPAIGN_CASE_FILE_HPP
#define INTERLOCK_CAMPAIGN_CASE_FILE_HPP

#include <iosfwd>
#include <string>
#include <tl/expected.hpp>

#include "plan.hpp"

namespace interlock::campaign {

void write_case(std::ostream& out, const Case& plan);

/** The case in a text that `write_case` wrote; or what was expected, and in which line. */
tl::expected<Case, std::string> read_case(std::istream& in);

}  // namespace interlock::campaign

#endif
