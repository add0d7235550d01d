/**
 * @file
 * Messages as values. Matrices are row-major, 4x4, mm; a matrix that came in is finite, yet not checked to be
 * rigid.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "igtl/frame.hpp"

namespace interlock::igtl {

/** A matrix of 4 by 4, row by row. */
using Matrix = std::array<double, 16>;
/** x, y and z in mm. */
using Position3 = std::array<double, 3>;

/** TRANSFORM. */
struct Transform {
  Matrix matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  bool operator==(const Transform&) const = default;
};

/** STRING. */
struct Text {
  std::string text;

  bool operator==(const Text&) const = default;
};

/** STATUS. */
struct Status {
  StatusCode code = StatusCode::ok;
  std::int64_t sub_code = 0;
  std::string name; /**< at most 19 characters travel */
  std::string text;

  bool operator==(const Status&) const = default;
};

/** One point of a list. */
struct LabeledPoint {
  std::string name;  /**< at most 63 characters travel */
  std::string group; /**< at most 31 */
  std::array<std::uint8_t, 4> colour{255, 255, 255, 255};
  Position3 position{};
  double radius = 0.0;
  std::string owner; /**< at most 19 */

  bool operator==(const LabeledPoint&) const = default;
};

/** POINT. */
struct Points {
  std::vector<LabeledPoint> points;

  bool operator==(const Points&) const = default;
};

/** POSITION, by some called QTRANS. */
struct Position {
  Position3 position{};
  std::optional<std::array<double, 4>> rotation; /**< quaternion x, y, z, w; of three numbers w follows */

  bool operator==(const Position&) const = default;
};

/** One tool that is tracked. */
struct Tool {
  std::string name; /**< at most 19 characters travel */
  std::uint8_t kind = 1;
  Matrix matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

  bool operator==(const Tool&) const = default;
};

/** TDATA. */
struct TrackingData {
  std::vector<Tool> tools;

  bool operator==(const TrackingData&) const = default;
};

/** STT_TDATA. */
struct StartTracking {
  std::int32_t interval_ms = 0; /**< least time between two messages */
  std::string frame;            /**< coordinates that are requested */

  bool operator==(const StartTracking&) const = default;
};

/** STP_TDATA. */
struct StopTracking {
  bool operator==(const StopTracking&) const = default;
};

/** RTS_TDATA. */
struct TrackingReply {
  bool accepted = true;

  bool operator==(const TrackingReply&) const = default;
};

/** NDARRAY of float32 or float64; the last index runs fastest. */
struct Array {
  std::vector<std::uint16_t> size;
  std::vector<double> values; /**< as many as the product of the sizes */

  bool operator==(const Array&) const = default;
};

/** SENSOR. */
struct Sensor {
  std::uint8_t status = 0;
  std::uint64_t unit = 0; /**< packed as the protocol has it */
  std::vector<double> values;

  bool operator==(const Sensor&) const = default;
};

/** CAPABILITY. */
struct Capability {
  std::vector<std::string> types;

  bool operator==(const Capability&) const = default;
};

/** GET_ and the type that is asked for, which 12 characters may have cut short: "TRANS". */
struct Query {
  std::string type;

  bool operator==(const Query&) const = default;
};

/** What a message says. */
using Body = std::variant<Transform, Text, Status, Points, Position, TrackingData, StartTracking,
                          StopTracking, TrackingReply, Array, Sensor, Capability, Query>;

/** A message as programs send it. */
struct Message {
  std::string device;
  Body body;
  std::uint64_t timestamp = 0;
  std::uint16_t version = 1;
  Metadata metadata;
};

/** Whether the matrix is a rotation and a shift: R^T R = 1 within 0.0001, which float32 leaves room for a
 * hundred times; no mirror. */
bool is_rigid(const Matrix& matrix) noexcept;

/** Whether a query, cut short or not, asks for that type. */
bool asks_for(const Query& query, std::string_view type) noexcept;

/** Name of the body's type: "TRANSFORM". */
std::string type_of(const Body& body);

}  // namespace interlock::igtl
