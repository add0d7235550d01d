#include "cli/igtl_words.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include "igtl/header.hpp"

namespace interlock::cli {
namespace {

using nlohmann::json;

std::optional<double> number_of(const std::string& word) {
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [stopped, error] = std::from_chars(word.data(), end, value);
  return error == std::errc() && stopped == end && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

Result<std::vector<double>> numbers_of(const std::vector<std::string>& words) {
  std::vector<double> numbers;
  for (const std::string& word : words) {
    const auto number = number_of(word);
    if (!number) {
      return failed(ExitCode::usage, "\"" + word + "\" is no number; expected one such as -12.5");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

Result<igtl::Body> wrong_count(const std::string& type, const std::string& expected) {
  return failed(ExitCode::usage, "a " + type + " takes " + expected);
}

Result<igtl::Body> transform_of(const std::vector<std::string>& words) {
  const auto numbers = numbers_of(words);
  if (!numbers) {
    return tl::unexpected(numbers.error());
  }
  igtl::Transform transform;
  if (numbers->size() == 3) {
    for (std::size_t row = 0; row < 3; ++row) {
      transform.matrix[4 * row + 3] = (*numbers)[row];
    }
  } else if (numbers->size() == 12 || numbers->size() == 16) {
    std::copy(numbers->begin(), numbers->end(), transform.matrix.begin());
  } else {
    return wrong_count("transform", "3 numbers (a shift, mm), or 12 or 16 (a matrix, row by row)");
  }
  return transform;
}

Result<igtl::Body> point_of(const std::vector<std::string>& words) {
  const auto numbers = numbers_of(words);
  if (!numbers) {
    return tl::unexpected(numbers.error());
  }
  if (numbers->size() != 3) {
    return wrong_count("point", "3 numbers, mm");
  }
  return igtl::Points{
      {{"point", "", {255, 0, 0, 255}, {(*numbers)[0], (*numbers)[1], (*numbers)[2]}, 0.0, ""}}};
}

Result<igtl::Body> status_of(const std::vector<std::string>& words) {
  const auto code = words.empty() ? std::nullopt : number_of(words[0]);
  if (!code || *code != std::floor(*code) || *code < 0 || *code > 65535 || words.size() > 2) {
    return wrong_count("status", "a code from 0 to 65535 and a text");
  }
  return igtl::Status{static_cast<igtl::StatusCode>(*code), 0, "", words.size() == 2 ? words[1] : ""};
}

json content_of(const igtl::Body& body) {
  if (const auto* transform = std::get_if<igtl::Transform>(&body)) {
    return {{"matrix", transform->matrix}};
  }
  if (const auto* text = std::get_if<igtl::Text>(&body)) {
    return {{"text", text->text}};
  }
  if (const auto* status = std::get_if<igtl::Status>(&body)) {
    return {{"code", static_cast<int>(status->code)},
            {"sub_code", status->sub_code},
            {"error", status->name},
            {"text", status->text}};
  }
  if (const auto* points = std::get_if<igtl::Points>(&body)) {
    json list = json::array();
    for (const igtl::LabeledPoint& point : points->points) {
      list.push_back({{"name", point.name}, {"position", point.position}});
    }
    return {{"points", std::move(list)}};
  }
  if (const auto* array = std::get_if<igtl::Array>(&body)) {
    return {{"size", array->size}, {"values", array->values}};
  }
  if (const auto* data = std::get_if<igtl::TrackingData>(&body)) {
    json list = json::array();
    for (const igtl::Tool& tool : data->tools) {
      list.push_back({{"name", tool.name}, {"matrix", tool.matrix}});
    }
    return {{"tools", std::move(list)}};
  }
  if (const auto* capability = std::get_if<igtl::Capability>(&body)) {
    return {{"types", capability->types}};
  }
  return json::object();
}

}  // namespace

Result<igtl::Body> igtl_body(const std::string& type, const std::vector<std::string>& values) {
  if (type == "transform") {
    return transform_of(values);
  }
  if (type == "point") {
    return point_of(values);
  }
  if (type == "status") {
    return status_of(values);
  }
  if (values.size() != 1) {
    return wrong_count(type, type == "get" ? "the type that is asked for, such as TRANSFORM" : "one text");
  }
  if (type == "string") {
    return igtl::Text{values[0]};
  }
  const std::size_t room = igtl::type_width - std::string_view("GET_").size();
  return igtl::Query{values[0].substr(0, room)};
}

json igtl_json(const igtl::Message& message) {
  json whole{{"name", message.device}, {"type", igtl::type_of(message.body)}};
  whole.update(content_of(message.body));
  return whole;
}

std::string igtl_line(const igtl::Message& message) {
  std::string line = message.device + " " + igtl::type_of(message.body);
  if (const auto* status = std::get_if<igtl::Status>(&message.body)) {
    line += " " + std::to_string(static_cast<int>(status->code)) + " " + status->name;
    return line + (status->text.empty() ? "" : ": " + status->text);
  }
  if (const auto* text = std::get_if<igtl::Text>(&message.body)) {
    return line + " " + text->text;
  }
  const json content = content_of(message.body);
  return content.empty() ? line : line + " " + content.begin()->dump();
}

}  // namespace interlock::cli
