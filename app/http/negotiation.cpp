#include "http/negotiation.hpp"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <optional>
#include <string>

namespace interlock::web {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

/** The lines of that name as the one list that they are. */
std::string list_of(const Request& request, http::field name) {
  std::string list;
  const auto [first, last] = request.equal_range(name);
  for (auto line = first; line != last; ++line) {
    list += (list.empty() ? "" : ", ") + std::string(line->value());
  }
  return list;
}

/** `0.25` in thousandths. What is no weight is none: 0. */
int thousandths(std::string_view weight) {
  const std::string_view fraction = weight.size() > 2 ? weight.substr(2) : std::string_view();
  if (weight.empty() || (weight[0] != '0' && weight[0] != '1') || (weight.size() > 1 && weight[1] != '.') ||
      fraction.size() > 3 || fraction.find_first_not_of("0123456789") != std::string_view::npos) {
    return 0;
  }
  const int value = (weight[0] - '0') * 1000 + std::stoi((std::string(fraction) + "000").substr(0, 3));
  return value <= 1000 ? value : 0;
}

/** What stands before the separator, without blanks around it; `rest` begins behind it. */
std::string_view take_until(char separator, std::string_view& rest) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view part = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  const std::size_t begin = std::min(part.find_first_not_of(" \t"), part.size());
  return part.substr(begin, part.find_last_not_of(" \t") + 1 - begin);
}

int weight_of(std::string_view parameters) {
  while (!parameters.empty()) {
    std::string_view value = take_until(';', parameters);
    if (beast::iequals(take_until('=', value), "q")) {
      return thousandths(value);
    }
  }
  return 1000;
}

bool names(std::string_view listed, Coding coding) {
  return beast::iequals(listed, name_of(coding)) ||
         (coding == Coding::gzip && beast::iequals(listed, "x-gzip"));
}

}  // namespace

std::string_view name_of(Coding coding) {
  switch (coding) {
    case Coding::brotli:
      return "br";
    case Coding::gzip:
      return "gzip";
    case Coding::identity:
      break;
  }
  return "identity";
}

int liking(const Request& request, Coding coding) {
  // Whoever names other forms only takes the file as it is where it comes in none of them.
  const int unnamed = coding == Coding::identity ? 1 : 0;
  const std::string accepted = list_of(request, http::field::accept_encoding);
  std::optional<int> any;
  for (std::string_view rest = accepted; !rest.empty();) {
    std::string_view parameters = take_until(',', rest);
    const std::string_view listed = take_until(';', parameters);
    if (names(listed, coding)) {
      return weight_of(parameters);
    }
    if (listed == "*") {
      any = weight_of(parameters);
    }
  }
  return any.value_or(unnamed);
}

bool has_already(const Request& request, std::string_view tag) {
  const std::string list = list_of(request, http::field::if_none_match);
  if (list == "*") {
    return true;
  }
  // Tags may have commas in them, but no quotes.
  for (std::string_view rest = list;;) {
    const std::size_t begin = rest.find('"');
    const std::size_t end = begin == std::string_view::npos ? begin : rest.find('"', begin + 1);
    if (end == std::string_view::npos) {
      return false;
    }
    if (rest.substr(begin, end + 1 - begin) == tag.substr(tag.find('"'))) {
      return true;
    }
    rest.remove_prefix(end + 1);
  }
}

}  // namespace interlock::web
