#include "igtl/message.hpp"

#include <algorithm>
#include <cmath>

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

bool is_rigid(const Matrix& matrix) noexcept {
  constexpr double tolerance = 1e-4;
  const auto at = [&](std::size_t row, std::size_t column) { return matrix[4 * row + column]; };
  double worst = 0.0;
  for (std::size_t one = 0; one < 3; ++one) {
    for (std::size_t other = one; other < 3; ++other) {
      const double product =
          at(0, one) * at(0, other) + at(1, one) * at(1, other) + at(2, one) * at(2, other);
      worst = std::max(worst, std::abs(product - (one == other ? 1.0 : 0.0)));
    }
  }
  const double determinant = at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
                             at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
                             at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
  return worst <= tolerance && determinant > 0.0;
}

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
