/**
 * @file
 * What a client understands and what it has already: Accept-Encoding and If-None-Match of RFC 9110.
 */
#pragma once

#include <array>
#include <string_view>

#include "http/message.hpp"

namespace interlock::web {

/** In which form a file is sent. */
enum class Coding { identity, gzip, brotli };

/** Each form, the one that we like best first. */
inline constexpr std::array codings{Coding::brotli, Coding::gzip, Coding::identity};

/** As it stands in Content-Encoding. */
std::string_view name_of(Coding coding);

/**
 * How much the client likes that form, in thousandths, by its Accept-Encoding; 0: not at all. A client that
 * does not say takes the file as it is.
 */
int liking(const Request& request, Coding coding);

/** Whether the client has what bears that entity tag, `"..."`, by its If-None-Match and weak comparison. */
bool has_already(const Request& request, std::string_view tag);

}  // namespace interlock::web
