#include "http/fields.hpp"

#include <algorithm>
#include <cmath>

namespace interlock::web {
namespace {

using nlohmann::json;

constexpr std::size_t longest_quote = 60;

std::string quoted(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > longest_quote) {
    text = text.substr(0, longest_quote) + "...";
  }
  return text;
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

}  // namespace

Fields::Fields(const json& body, std::initializer_list<const char*> known) : body_(body) {
  std::string names;
  for (const char* name : known) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  if (!body.is_object()) {
    problem_ = Problem{Status::unprocessable_entity,
                       "INVALID",
                       "The body is " + quoted(body) + ".",
                       "",
                       "an object with " + names,
                       "",
                       ""};
    return;
  }
  for (const auto& [name, value] : body.items()) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      reject(name, "is not known", "one of " + names);
    }
  }
}

bool Fields::has(const std::string& name) const { return body_.is_object() && body_.contains(name); }

std::optional<std::int64_t> Fields::integer(const std::string& name, std::int64_t lowest,
                                            std::int64_t highest) {
  if (!has(name)) {
    return std::nullopt;
  }
  const auto value = whole(body_[name]);
  if (!value || *value < lowest || *value > highest) {
    reject(name, "is " + quoted(body_[name]),
           "an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
    return std::nullopt;
  }
  return value;
}

std::optional<double> Fields::number(const std::string& name) {
  if (!has(name)) {
    return std::nullopt;
  }
  if (!body_[name].is_number()) {
    reject(name, "is " + quoted(body_[name]), "a number");
    return std::nullopt;
  }
  return body_[name].get<double>();
}

void Fields::reject(const std::string& name, const std::string& found, const std::string& expected) {
  if (!problem_) {
    problem_ =
        Problem{Status::unprocessable_entity, "INVALID", name + " " + found + ".", name, expected, "", ""};
  }
}

}  // namespace interlock::web
