/**
 * @file
 * The query of a request, as far as a route knows it.
 */
#pragma once

#include <initializer_list>

#include "http/message.hpp"

namespace interlock::web {

/** The known parameters of the query as an object of texts; unknown ones are ignored. 400 MALFORMED as of
 * `parse_query`. */
tl::expected<nlohmann::json, Problem> known_query(const Request& request,
                                                  std::initializer_list<const char*> known);

}  // namespace interlock::web
