#include "service/fields.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "system/printable.hpp"

namespace interlock {
namespace {

using nlohmann::json;

constexpr std::size_t longest_quote = 60;

std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

bool ends_a_number(char letter) { return letter >= '0' && letter <= '9'; }

/** The number in a string, spelt as JSON spells it and nothing else; any other value as it is. */
json number_in(const json& value) {
  if (!value.is_string()) {
    return value;
  }
  const auto& text = value.get_ref<const std::string&>();
  const bool bare =
      !text.empty() && (text.front() == '-' || ends_a_number(text.front())) && ends_a_number(text.back());
  json number = bare ? json::parse(text, nullptr, false) : json();
  return number.is_number() ? number : value;
}

/** 5 and 5.0 are the same integer in JSON. */
std::optional<std::int64_t> whole(const json& value) {
  constexpr double exactly_held = 9007199254740992.0;
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX)) {
    return std::nullopt;
  }
  if (value.is_number_integer()) {
    return value.get<std::int64_t>();
  }
  if (value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>() &&
      std::abs(value.get<double>()) < exactly_held) {
    return static_cast<std::int64_t>(value.get<double>());
  }
  return std::nullopt;
}

template <typename Names>
std::string listed(const Names& names) {
  std::string list;
  for (const auto& name : names) {
    list += (list.empty() ? "" : ", ") + std::string(name);
  }
  return list;
}

}  // namespace

std::optional<double> number_of(const json& value) {
  const json number = number_in(value);
  return number.is_number() ? std::optional(number.get<double>()) : std::nullopt;
}

std::string quoted(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > longest_quote) {
    text = text.substr(0, longest_quote) + "...";
  }
  return text;
}

Problem invalid(const std::string& field, const std::string& detail, const std::string& expected) {
  return {.status = Status::unprocessable_entity,
          .code = "INVALID",
          .detail = detail,
          .field = field,
          .expected = expected,
          .next_step = "Correct it, and send it again."};
}

Fields::Fields(const nlohmann::json& object, std::initializer_list<const char*> known, std::string where)
    : object_(object), where_(std::move(where)) {
  const std::string names = listed(known);
  if (!object.is_object()) {
    problem_ = invalid(where_, (where_.empty() ? "The body" : where_) + " is " + quoted(object) + ".",
                       "an object with " + names);
    return;
  }
  for (const auto& [name, value] : object.items()) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      reject(name, "is not known", "one of " + names);
    }
  }
}

Fields Fields::some_of(const json& object) {
  Fields fields(object);
  if (!object.is_object()) {
    fields.problem_ = invalid("", "The body is " + quoted(object) + ".", "an object");
  }
  return fields;
}

bool Fields::has(const std::string& name) const { return object_.is_object() && object_.contains(name); }

const json* Fields::value(const std::string& name) const { return has(name) ? &object_[name] : nullptr; }

std::string Fields::place_of(const std::string& name) const {
  return where_.empty() ? name : where_ + "." + name;
}

std::optional<std::int64_t> Fields::integer(const std::string& name, std::int64_t lowest,
                                            std::int64_t highest) {
  if (!has(name)) {
    return std::nullopt;
  }
  const auto found = whole(number_in(object_[name]));
  if (!found || *found < lowest || *found > highest) {
    reject(name, "is " + quoted(object_[name]),
           "an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
    return std::nullopt;
  }
  return found;
}

std::optional<std::int64_t> Fields::integer_or_null(const std::string& name, std::int64_t lowest,
                                                    std::int64_t highest) {
  return has(name) && object_[name].is_null() ? std::nullopt : integer(name, lowest, highest);
}

std::optional<double> Fields::number(const std::string& name) {
  if (!has(name)) {
    return std::nullopt;
  }
  const auto found = number_of(object_[name]);
  if (!found) {
    reject(name, "is " + quoted(object_[name]), "a number");
  }
  return found;
}

std::optional<double> Fields::number(const std::string& name, double lowest, double highest) {
  const auto found = number(name);
  if (found && (*found < lowest || *found > highest)) {
    reject(name, "is " + quoted(object_[name]),
           "a number from " + shortest(lowest) + " to " + shortest(highest));
    return std::nullopt;
  }
  return found;
}

std::optional<std::vector<double>> Fields::numbers(const std::string& name, std::size_t count) {
  if (!has(name)) {
    return std::nullopt;
  }
  const json& list = object_[name];
  if (!list.is_array() || list.size() != count) {
    reject(name, list.is_array() ? "has " + std::to_string(list.size()) + " elements" : "is " + quoted(list),
           "a list of " + std::to_string(count) + " numbers");
    return std::nullopt;
  }
  std::vector<double> found;
  for (const json& each : list) {
    const auto element = number_of(each);
    if (!element) {
      reject(name + "[" + std::to_string(found.size()) + "]", "is " + quoted(each), "a number");
      return std::nullopt;
    }
    found.push_back(*element);
  }
  return found;
}

std::optional<bool> Fields::boolean(const std::string& name) {
  if (!has(name)) {
    return std::nullopt;
  }
  if (!object_[name].is_boolean()) {
    reject(name, "is " + quoted(object_[name]), "true or false");
    return std::nullopt;
  }
  return object_[name].get<bool>();
}

std::optional<std::string> Fields::text(const std::string& name) {
  if (!has(name)) {
    return std::nullopt;
  }
  if (!object_[name].is_string()) {
    reject(name, "is " + quoted(object_[name]), "a text");
    return std::nullopt;
  }
  return object_[name].get<std::string>();
}

std::optional<std::string> Fields::line(const std::string& name, std::size_t longest) {
  auto found = text(name);
  if (found && (printable(*found) != *found || visible(*found).empty())) {
    reject(name, "is empty, or has characters that do not show", "a text of one line");
  } else if (found && characters_in(*found) > longest) {
    reject(name, "is too long", "at most " + std::to_string(longest) + " characters");
  }
  return found;
}

std::optional<std::string> Fields::choice(const std::string& name,
                                          std::span<const std::string_view> choices) {
  if (!has(name)) {
    return std::nullopt;
  }
  const json& found = object_[name];
  if (!found.is_string() ||
      std::find(choices.begin(), choices.end(), found.get_ref<const std::string&>()) == choices.end()) {
    reject(name, "is " + quoted(found), "one of " + listed(choices));
    return std::nullopt;
  }
  return found.get<std::string>();
}

std::optional<std::vector<std::string>> Fields::texts(const std::string& name, std::size_t fewest,
                                                      std::size_t most) {
  if (!has(name)) {
    return std::nullopt;
  }
  const json& list = object_[name];
  const bool fits = list.is_array() && list.size() >= fewest && list.size() <= most;
  if (!fits || !std::all_of(list.begin(), list.end(), [](const json& each) { return each.is_string(); })) {
    reject(name, "is " + quoted(list),
           "a list of " + std::to_string(fewest) + " to " + std::to_string(most) + " texts");
    return std::nullopt;
  }
  return list.get<std::vector<std::string>>();
}

void Fields::require(std::initializer_list<std::pair<const char*, const char*>> names_and_expected) {
  for (const auto& [name, expected] : names_and_expected) {
    if (!has(name)) {
      reject(name, "is missing", expected);
    }
  }
}

void Fields::reject(const std::string& name, const std::string& found, const std::string& expected) {
  if (!problem_) {
    problem_ = invalid(place_of(name), place_of(name) + " " + found + ".", expected);
  }
}

}  // namespace interlock
