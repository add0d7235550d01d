#include <igtlStringMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "igtl/codec.hpp"
#include "igtl/library.hpp"

namespace interlock::igtl {
namespace {

using Decoded = tl::expected<Body, FaultAt>;

constexpr std::size_t status_name_at = 10;
constexpr std::size_t position_only_bytes = 12;
constexpr std::size_t point_bytes = 136;
constexpr std::size_t tool_bytes = 70;
constexpr std::size_t sensor_head_bytes = 10;
constexpr std::uint8_t float32_elements = 10;

tl::unexpected<Fault> refused(Fault fault) { return tl::unexpected(fault); }

bool is_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/** Of a text that somebody will read: a line may end, and UTF-8 may be in it. */
bool is_legible(const std::string& text) {
  return std::ranges::all_of(text, [](char each) {
    const auto byte = static_cast<unsigned char>(each);
    return (byte >= 0x20 && byte != 0x7F) || each == '\n' || each == '\r' || each == '\t';
  });
}

/** A field that is filled with zeros but may hold rubbish behind the end of its text, as some senders do. */
tl::expected<std::string, Fault> text_in(Bytes field) {
  std::string text(field.begin(), std::ranges::find(field, std::uint8_t{0}));
  if (text.size() == field.size() || !is_legible(text)) {
    return tl::unexpected(Fault::text);
  }
  return text;
}

/** Three columns of a rotation, then the translation, as TRANSFORM and TDATA have them. */
Matrix matrix_at(Bytes bytes, std::size_t at) {
  Matrix matrix = Transform{}.matrix;
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 3; ++row) {
      matrix[4 * row + column] = read_float32(bytes, at + 4 * (3 * column + row));
    }
  }
  return matrix;
}

Decoded decode_transform(Bytes content) {
  const auto message = unpacked<::igtl::TransformMessage>("TRANSFORM", content);
  if (!message) {
    return refused(Fault::wrong_size);
  }
  ::igtl::Matrix4x4 read;
  message->GetMatrix(read);
  Transform transform;
  for (std::size_t i = 0; i < transform.matrix.size(); ++i) {
    transform.matrix[i] = static_cast<double>(read[i / 4][i % 4]);
  }
  return is_finite(transform.matrix) ? Decoded(transform) : refused(Fault::not_finite);
}

/** Encodings are numbers of IANA: 3 is ASCII, 106 is UTF-8; 3D Slicer counts otherwise and sends 1 for
 * ASCII. */
Decoded decode_text(Bytes content) {
  const auto encoding = read_number<std::uint16_t>(content, 0);
  if (read_number<std::uint16_t>(content, 2) != content.size() - 4) {
    return refused(Fault::inner_length);
  }
  if (encoding != 1 && encoding != 3 && encoding != 106) {
    return refused(Fault::text);
  }
  const Bytes characters = content.subspan(4);
  if (!is_legible(std::string{characters.begin(), characters.end()})) {
    return refused(Fault::text);
  }
  if (characters.empty()) {
    return Text{};
  }
  const auto message = unpacked<::igtl::StringMessage>("STRING", content);
  if (!message) {
    return refused(Fault::wrong_size);
  }
  return Text{message->GetString()};
}

/** Name and text must be terminated. */
Decoded decode_status(Bytes content) {
  const auto name = text_in(content.subspan(status_name_at, status_name_width));
  if (!name || content.back() != 0) {
    return refused(Fault::text);
  }
  const Bytes text = content.subspan(status_name_at + status_name_width);
  Status status{static_cast<StatusCode>(read_number<std::uint16_t>(content, 0)),
                static_cast<std::int64_t>(read_number<std::uint64_t>(content, 2)), *name,
                std::string(text.begin(), std::ranges::find(text, std::uint8_t{0}))};
  return is_legible(status.text) ? Decoded(std::move(status)) : refused(Fault::text);
}

Decoded decode_position(Bytes content) {
  Position position;
  for (std::size_t axis = 0; axis < position.position.size(); ++axis) {
    position.position[axis] = read_float32(content, 4 * axis);
  }
  bool finite = is_finite(position.position);
  if (content.size() > position_only_bytes) {
    std::array<double, 4> rotation{};
    const std::size_t parts = (content.size() - position_only_bytes) / 4;
    for (std::size_t part = 0; part < parts; ++part) {
      rotation[part] = read_float32(content, position_only_bytes + 4 * part);
    }
    if (parts < rotation.size()) {
      const double rest = rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2];
      rotation[3] = static_cast<float>(std::sqrt(std::max(0.0, 1.0 - rest)));
    }
    finite = finite && is_finite(rotation);
    position.rotation = rotation;
  }
  return finite ? Decoded(position) : refused(Fault::not_finite);
}

tl::expected<LabeledPoint, Fault> point_at(Bytes bytes) {
  LabeledPoint point;
  auto name = text_in(bytes.first(64));
  auto group = text_in(bytes.subspan(64, 32));
  auto owner = text_in(bytes.subspan(116, 20));
  if (!name || !group || !owner) {
    return refused(Fault::text);
  }
  point.name = std::move(*name);
  point.group = std::move(*group);
  point.owner = std::move(*owner);
  std::ranges::copy(bytes.subspan(96, 4), point.colour.begin());
  for (std::size_t i = 0; i < 3; ++i) {
    point.position[i] = read_float32(bytes, 100 + 4 * i);
  }
  point.radius = read_float32(bytes, 112);
  if (!is_finite(point.position) || !std::isfinite(point.radius)) {
    return refused(Fault::not_finite);
  }
  return point;
}

Decoded decode_points(Bytes content) {
  Points points;
  for (std::size_t at = 0; at < content.size(); at += point_bytes) {
    auto point = point_at(content.subspan(at, point_bytes));
    if (!point) {
      return refused(point.error());
    }
    points.points.push_back(std::move(*point));
  }
  return points;
}

/** Counted from 1, as people do. */
std::string row_text(std::size_t row) { return "row " + std::to_string(row + 1); }

Decoded decode_tracking(Bytes content) {
  TrackingData data;
  for (std::size_t at = 0; at < content.size(); at += tool_bytes) {
    const Bytes bytes = content.subspan(at, tool_bytes);
    auto name = text_in(bytes.first(20));
    if (!name) {
      return refused(Fault::text);
    }
    Tool tool{std::move(*name), bytes[20], matrix_at(bytes, 22)};
    if (!is_finite(tool.matrix)) {
      return tl::unexpected(FaultAt(Fault::not_finite, row_text(data.tools.size()) + ", matrix"));
    }
    data.tools.push_back(std::move(tool));
  }
  return data;
}

Decoded decode_start_tracking(Bytes content) {
  if (const auto frame = text_in(content.subspan(4, 32)); !frame) {
    return refused(Fault::text);
  }
  const auto message = unpacked<::igtl::StartTrackingDataMessage>("STT_TDATA", content);
  if (!message) {
    return refused(Fault::wrong_size);
  }
  return StartTracking{message->GetResolution(), message->GetCoordinateName()};
}

Decoded decode_tracking_reply(Bytes content) {
  const auto message = unpacked<::igtl::RTSTrackingDataMessage>("RTS_TDATA", content);
  if (!message) {
    return refused(Fault::wrong_size);
  }
  return TrackingReply{message->GetStatus() == 0};
}

/** Where an element of an array is. */
std::string place_in(const std::vector<std::uint16_t>& size, std::size_t element) {
  if (size.size() != 2) {
    return "element " + std::to_string(element + 1);
  }
  return row_text(element / size[1]) + ", column " + std::to_string(element % size[1] + 1);
}

/** Element type, number of dimensions, each dimension, elements: they must make up the whole body. */
Decoded decode_array(Bytes content) {
  const std::uint8_t elements = content[0];
  const std::size_t dimensions = content[1];
  if (elements != float32_elements && elements != float64_elements) {
    return refused(Fault::element_type);
  }
  const std::size_t head = 2 + 2 * dimensions;
  if (dimensions == 0 || head > content.size()) {
    return refused(Fault::inner_length);
  }
  Array array;
  std::uint64_t bytes = elements == float32_elements ? 4 : 8;
  for (std::size_t i = 0; i < dimensions && bytes <= content.size(); ++i) {
    array.size.push_back(read_number<std::uint16_t>(content, 2 + 2 * i));
    bytes *= array.size.back();
  }
  if (bytes == 0 || bytes != content.size() - head) {
    return refused(Fault::inner_length);
  }
  for (std::size_t at = head; at < content.size(); at += elements == float32_elements ? 4 : 8) {
    array.values.push_back(elements == float32_elements ? read_float32(content, at)
                                                        : read_float64(content, at));
  }
  const auto bad = std::ranges::find_if_not(array.values, [](double value) { return std::isfinite(value); });
  if (bad != array.values.end()) {
    return tl::unexpected(FaultAt(
        Fault::not_finite, place_in(array.size, static_cast<std::size_t>(bad - array.values.begin()))));
  }
  return array;
}

Decoded decode_sensor(Bytes content) {
  const std::size_t count = content[0];
  if (content.size() != sensor_head_bytes + 8 * count) {
    return refused(Fault::inner_length);
  }
  Sensor sensor{content[1], read_number<std::uint64_t>(content, 2), {}};
  for (std::size_t i = 0; i < count; ++i) {
    sensor.values.push_back(read_float64(content, sensor_head_bytes + 8 * i));
  }
  return is_finite(sensor.values) ? Decoded(std::move(sensor)) : refused(Fault::not_finite);
}

Decoded decode_capability(Bytes content) {
  Capability capability;
  for (std::size_t at = 0; at < content.size(); at += type_width) {
    auto type = read_field(content.subspan(at, type_width), Fault::text);
    if (!type) {
      return refused(type.error());
    }
    capability.types.push_back(std::move(*type));
  }
  return capability;
}

struct Decoder {
  std::string_view type;
  Decoded (*decode)(Bytes);
};

constexpr std::array<Decoder, 12> decoders{{
    {"TRANSFORM", decode_transform},
    {"STRING", decode_text},
    {"STATUS", decode_status},
    {"POINT", decode_points},
    {"POSITION", decode_position},
    {"TDATA", decode_tracking},
    {"STT_TDATA", decode_start_tracking},
    {"STP_TDATA", [](Bytes) -> Decoded { return StopTracking{}; }},
    {"RTS_TDATA", decode_tracking_reply},
    {"NDARRAY", decode_array},
    {"SENSOR", decode_sensor},
    {"CAPABILITY", decode_capability},
}};

Decoded decode_body(const std::string& type, Bytes content) {
  constexpr std::string_view query = "GET_";
  if (type.starts_with(query)) {
    return Query{type.substr(query.size())};
  }
  const auto decoder = std::ranges::find(decoders, type, &Decoder::type);
  return decoder == decoders.end() ? refused(Fault::unknown_type) : decoder->decode(content);
}

}  // namespace

tl::expected<Message, FaultAt> decode(Frame frame) {
  return decode_body(frame.header.type, frame.content).map([&](Body&& body) {
    return Message{std::move(frame.header.device), std::move(body), frame.header.timestamp,
                   frame.header.version, std::move(frame.metadata)};
  });
}

}  // namespace interlock::igtl
