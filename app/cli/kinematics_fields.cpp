#include "cli/kinematics_lines.hpp"

namespace interlock::cli {

using Eigen::Vector3d;
using nlohmann::json;

namespace {

template <std::size_t count>
Solved<std::array<double, count>> numbers(const json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != count) {
    return refused("BAD_FIELD", key + ": expected an array of " + std::to_string(count) + " numbers");
  }
  std::array<double, count> read{};
  for (std::size_t index = 0; index < count; ++index) {
    const Solved<double> entry = number((*found)[index], key + '[' + std::to_string(index) + ']');
    if (!entry) {
      return tl::unexpected(entry.error());
    }
    read[index] = *entry;
  }
  return read;
}

}  // namespace

tl::unexpected<json> refused(std::string_view code, const std::string& text) {
  return tl::unexpected(json{{"code", code}, {"text", text}});
}

Solved<json> parse_line(std::string_view line) {
  try {
    json request = json::parse(line);
    if (request.is_object()) {
      return request;
    }
    return refused("BAD_JSON", "expected one JSON object in the line");
  } catch (const json::parse_error& error) {
    return refused("BAD_JSON", "expected one JSON object in the line; not JSON from byte " +
                                   std::to_string(error.byte) + " on");
  } catch (const json::exception&) {
    return refused("BAD_JSON", "expected one JSON object in the line; a number is too large");
  }
}

bool has(const json& object, std::initializer_list<std::string_view> keys) {
  return std::ranges::all_of(keys, [&](std::string_view key) { return object.contains(key); });
}

Solved<double> number(const json& value, const std::string& name) {
  if (!value.is_number()) {
    return refused("BAD_FIELD", name + ": expected a number");
  }
  return value.get<double>();
}

Solved<double> number_or_zero(const json& object, const std::string& key) {
  return object.contains(key) ? number(object[key], key) : Solved<double>(0.0);
}

Solved<bool> flag_or_false(const json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found != object.end() && !found->is_boolean()) {
    return refused("BAD_FIELD", key + ": expected true or false");
  }
  return found != object.end() && found->get<bool>();
}

Solved<Vector3d> point(const json& object, const std::string& key) {
  return numbers<3>(object, key).map([](const std::array<double, 3>& read) {
    return Vector3d(read[0], read[1], read[2]);
  });
}

Solved<RowMajor> matrix(const json& object, const std::string& key) { return numbers<16>(object, key); }

Solved<Pose> pose(const json& object) {
  return matrix(object, "pose").and_then([](const RowMajor& read) { return solved(pose_from(read)); });
}

}  // namespace interlock::cli
