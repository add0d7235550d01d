#include <igtlStringMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>

#include <algorithm>

#include "igtl/codec.hpp"
#include "igtl/library.hpp"

namespace interlock::igtl {
namespace {

constexpr std::uint16_t ascii_encoding = 3;
constexpr std::size_t longest_text = 65535;
constexpr std::size_t longest_status_text = 4096;

/** What a field of that width holds, its end included. */
std::string fitted(const std::string& text, std::size_t width) { return text.substr(0, width - 1); }

void append_matrix(ByteVector& bytes, const Matrix& matrix) {
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t row = 0; row < 3; ++row) {
      append_float32(bytes, matrix[4 * row + column]);
    }
  }
}

struct Encoder {
  ByteVector operator()(const Transform& transform) const {
    ::igtl::Matrix4x4 matrix;
    for (std::size_t i = 0; i < transform.matrix.size(); ++i) {
      matrix[i / 4][i % 4] = static_cast<float>(transform.matrix[i]);
    }
    const auto message = ::igtl::TransformMessage::New();
    message->SetMatrix(matrix);
    return packed(message);
  }

  ByteVector operator()(const Text& text) const {
    const auto message = ::igtl::StringMessage::New();
    message->SetEncoding(ascii_encoding);
    message->SetString(text.text.substr(0, longest_text).c_str());
    return packed(message);
  }

  ByteVector operator()(const Status& status) const {
    ByteVector bytes;
    append_number(bytes, static_cast<std::uint16_t>(status.code));
    append_number(bytes, static_cast<std::uint64_t>(status.sub_code));
    append_field(bytes, fitted(status.name, status_name_width), status_name_width);
    const std::string text = status.text.substr(0, longest_status_text);
    append_field(bytes, text, text.size() + 1);
    return bytes;
  }

  ByteVector operator()(const Points& points) const {
    ByteVector bytes;
    for (const LabeledPoint& point : points.points) {
      append_field(bytes, fitted(point.name, 64), 64);
      append_field(bytes, fitted(point.group, 32), 32);
      bytes.insert(bytes.end(), point.colour.begin(), point.colour.end());
      for (const double coordinate : point.position) {
        append_float32(bytes, coordinate);
      }
      append_float32(bytes, point.radius);
      append_field(bytes, fitted(point.owner, 20), 20);
    }
    return bytes;
  }

  ByteVector operator()(const Position& position) const {
    ByteVector bytes;
    for (const double coordinate : position.position) {
      append_float32(bytes, coordinate);
    }
    if (position.rotation) {
      for (const double component : *position.rotation) {
        append_float32(bytes, component);
      }
    }
    return bytes;
  }

  ByteVector operator()(const TrackingData& data) const {
    ByteVector bytes;
    for (const Tool& tool : data.tools) {
      append_field(bytes, fitted(tool.name, 20), 20);
      bytes.push_back(tool.kind);
      bytes.push_back(0);
      append_matrix(bytes, tool.matrix);
    }
    return bytes;
  }

  ByteVector operator()(const StartTracking& start) const {
    const auto message = ::igtl::StartTrackingDataMessage::New();
    message->SetResolution(start.interval_ms);
    message->SetCoordinateName(fitted(start.frame, 32).c_str());
    return packed(message);
  }

  ByteVector operator()(const StopTracking&) const { return {}; }

  ByteVector operator()(const TrackingReply& reply) const {
    const auto message = ::igtl::RTSTrackingDataMessage::New();
    message->SetStatus(reply.accepted ? 0 : 1);
    return packed(message);
  }

  ByteVector operator()(const Array& array) const {
    ByteVector bytes{float64_elements, static_cast<std::uint8_t>(array.size.size())};
    for (const std::uint16_t size : array.size) {
      append_number(bytes, size);
    }
    for (const double value : array.values) {
      append_float64(bytes, value);
    }
    return bytes;
  }

  ByteVector operator()(const Sensor& sensor) const {
    ByteVector bytes{static_cast<std::uint8_t>(sensor.values.size()), sensor.status};
    append_number(bytes, sensor.unit);
    for (const double value : sensor.values) {
      append_float64(bytes, value);
    }
    return bytes;
  }

  ByteVector operator()(const Capability& capability) const {
    ByteVector bytes;
    for (const std::string& type : capability.types) {
      append_field(bytes, type, type_width);
    }
    return bytes;
  }

  ByteVector operator()(const Query&) const { return {}; }
};

}  // namespace

ByteVector encode(const Body& body) { return std::visit(Encoder{}, body); }

}  // namespace interlock::igtl
