#include "igtl/message.hpp"

#include <algorithm>

namespace interlock::igtl {
namespace {

/** In the order of the alternatives of `Body`, a query, which has its own, excepted. */
constexpr std::array<std::string_view, 12> type_names{"TRANSFORM", "STRING",  "STATUS",    "POINT",
                                                      "POSITION",  "TDATA",   "STT_TDATA", "STP_TDATA",
                                                      "RTS_TDATA", "NDARRAY", "SENSOR",    "CAPABILITY"};

static_assert(std::variant_size_v<Body> == type_names.size() + 1);

/** Of a query's type name, what stands after "GET_"; libraries send as few as these of a longer one. */
constexpr std::size_t shortest_query = 5;

}  // namespace

bool asks_for(const Query& query, std::string_view type) noexcept {
  return type.starts_with(query.type) && query.type.size() >= std::min(shortest_query, type.size());
}

std::string type_of(const Body& body) {
  if (const auto* query = std::get_if<Query>(&body)) {
    return "GET_" + query->type;
  }
  return std::string(type_names[body.index()]);
}

}  // namespace interlock::igtl
