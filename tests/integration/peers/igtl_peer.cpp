/** @file A navigation program on Debian's OpenIGTLink library, for the tests: as a client, or as a server
 * that waits for the robot.
 *
 *     igtl_peer client PORT HEADER_VERSION
 *     igtl_peer server HEADER_VERSION
 *
 * Each line of its input is a JSON object and becomes one message; each message that comes becomes a line of
 * its output. A server first says where it listens: {"listening": 40123}. It ends with its input.
 *
 * The library packs, unpacks and checks every body. Header version 2 it does not know: what that adds is put
 * around its messages, and taken off those that come, here. It shares no code with the app.
 */
#include <igtlCapabilityMessage.h>
#include <igtlClientSocket.h>
#include <igtlNDArrayMessage.h>
#include <igtlPointMessage.h>
#include <igtlSensorMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlStringMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_util.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t header_bytes = 58;
constexpr std::size_t size_at = 42;
constexpr std::size_t crc_at = 50;
constexpr std::size_t extension_bytes = 12;
constexpr std::uint64_t timeout_bytes = 1u << 20u;

template <typename Number>
Number number_at(const Bytes& bytes, std::size_t at) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    number = static_cast<Number>(static_cast<std::uint64_t>(number) << 8u | bytes.at(at + i));
  }
  return number;
}

template <typename Number>
void put(Bytes& bytes, std::size_t at, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes.at(at + i) =
        static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> 8u * (sizeof(Number) - 1 - i));
  }
}

std::uint64_t crc_of(Bytes bytes) { return crc64(bytes.data(), bytes.size(), 0); }

/** The message of version 1 in version 2, with one pair of metadata as 3D Slicer sends it. */
Bytes with_extension(const Bytes& message) {
  constexpr std::array<std::uint8_t, 20> metadata{0,   1,   0,   5,   0,   3,   0,   0,   0,   5,
                                                  'd', 'u', 'm', 'm', 'y', 'd', 'u', 'm', 'm', 'y'};
  constexpr std::uint16_t index_bytes = 10;
  constexpr std::uint32_t text_bytes = 10;
  Bytes body(extension_bytes);
  put(body, 0, std::uint16_t{extension_bytes});
  put(body, 2, index_bytes);
  put(body, 4, text_bytes);
  body.insert(body.end(), message.begin() + header_bytes, message.end());
  body.insert(body.end(), metadata.begin(), metadata.begin() + index_bytes + text_bytes);
  Bytes extended(message.begin(), message.begin() + header_bytes);
  put(extended, 0, std::uint16_t{2});
  put(extended, size_at, static_cast<std::uint64_t>(body.size()));
  put(extended, crc_at, crc_of(body));
  extended.insert(extended.end(), body.begin(), body.end());
  return extended;
}

/** The message of version 2 as the library knows it; its CRC is held against the body first. */
Bytes without_extension(const Bytes& message) {
  const Bytes body(message.begin() + header_bytes, message.end());
  if (crc_of(body) != number_at<std::uint64_t>(message, crc_at)) {
    throw std::runtime_error("wrong CRC in version 2");
  }
  const std::size_t before = number_at<std::uint16_t>(body, 0);
  const std::size_t behind =
      number_at<std::uint16_t>(body, 2) + std::size_t{number_at<std::uint32_t>(body, 4)};
  if (before < extension_bytes || before + behind > body.size()) {
    throw std::runtime_error("wrong lengths in version 2");
  }
  const Bytes content(body.begin() + static_cast<std::ptrdiff_t>(before),
                      body.end() - static_cast<std::ptrdiff_t>(behind));
  Bytes plain(message.begin(), message.begin() + header_bytes);
  put(plain, 0, std::uint16_t{1});
  put(plain, size_at, static_cast<std::uint64_t>(content.size()));
  put(plain, crc_at, crc_of(content));
  plain.insert(plain.end(), content.begin(), content.end());
  return plain;
}

// What is sent.

template <typename Pointer>
Bytes packed(const Pointer& message, const json& line) {
  message->SetDeviceName(line.at("name").get<std::string>().c_str());
  message->Pack();
  const auto* bytes = static_cast<const std::uint8_t*>(message->GetPackPointer());
  return {bytes, bytes + message->GetPackSize()};
}

void set_matrix(igtl::Matrix4x4& matrix, const json& numbers) {
  for (std::size_t i = 0; i < 16; ++i) {
    matrix[i / 4][i % 4] = numbers.at(i).get<float>();
  }
}

Bytes transform(const json& line) {
  const auto message = igtl::TransformMessage::New();
  igtl::Matrix4x4 matrix;
  set_matrix(matrix, line.at("matrix"));
  message->SetMatrix(matrix);
  return packed(message, line);
}

Bytes text(const json& line) {
  const auto message = igtl::StringMessage::New();
  std::string content = line.at("text").get<std::string>();
  message->SetString(content);
  return packed(message, line);
}

Bytes status(const json& line) {
  const auto message = igtl::StatusMessage::New();
  message->SetCode(line.at("code").get<int>());
  message->SetStatusString(line.at("text").get<std::string>().c_str());
  return packed(message, line);
}

Bytes points(const json& line) {
  const auto message = igtl::PointMessage::New();
  for (const json& position : line.at("positions")) {
    igtl::PointElement::Pointer point = igtl::PointElement::New();
    point->SetPosition(position.at(0).get<float>(), position.at(1).get<float>(), position.at(2).get<float>());
    message->AddPointElement(point);
  }
  return packed(message, line);
}

Bytes array(const json& line) {
  const json& rows = line.at("rows");
  igtl::Array<igtl_float64> values;
  values.SetSize({static_cast<igtlUint16>(rows.size()), static_cast<igtlUint16>(rows.at(0).size())});
  auto* value = static_cast<igtl_float64*>(values.GetRawArray());
  for (const json& row : rows) {
    value =
        std::transform(row.begin(), row.end(), value, [](const json& each) { return each.get<double>(); });
  }
  const auto message = igtl::NDArrayMessage::New();
  message->SetArray(igtl::NDArrayMessage::TYPE_FLOAT64, &values);
  return packed(message, line);
}

Bytes poses(const json& line) {
  const auto message = igtl::TrackingDataMessage::New();
  for (const json& pose : line.at("poses")) {
    igtl::TrackingDataElement::Pointer element = igtl::TrackingDataElement::New();
    element->SetName(pose.at("name").get<std::string>().c_str());
    element->SetType(igtl::TrackingDataElement::TYPE_6D);
    igtl::Matrix4x4 matrix;
    set_matrix(matrix, pose.at("matrix"));
    element->SetMatrix(matrix);
    message->AddTrackingDataElement(element);
  }
  return packed(message, line);
}

Bytes start_of_tracking(const json& line) {
  const auto message = igtl::StartTrackingDataMessage::New();
  message->SetResolution(line.at("interval_ms").get<int>());
  message->SetCoordinateName("");
  return packed(message, line);
}

template <typename LibraryMessage>
Bytes empty(const json& line) {
  return packed(LibraryMessage::New(), line);
}

using Packer = std::function<Bytes(const json&)>;

const std::map<std::string, Packer>& packers() {
  static const std::map<std::string, Packer> all{{"TRANSFORM", transform},
                                                 {"STRING", text},
                                                 {"STATUS", status},
                                                 {"POINT", points},
                                                 {"NDARRAY", array},
                                                 {"TDATA", poses},
                                                 {"STT_TDATA", start_of_tracking},
                                                 {"STP_TDATA", empty<igtl::StopTrackingDataMessage>},
                                                 {"GET_TRANS", empty<igtl::GetTransformMessage>},
                                                 {"GET_STATUS", empty<igtl::GetStatusMessage>},
                                                 {"GET_POINT", empty<igtl::GetPointMessage>},
                                                 {"GET_CAPABIL", empty<igtl::GetCapabilityMessage>}};
  return all;
}

// What comes.

/** Header, then body, as the library's examples read them; it checks the CRC. */
template <typename LibraryMessage>
typename LibraryMessage::Pointer unpacked(const Bytes& bytes) {
  const auto header = igtl::MessageHeader::New();
  header->InitPack();
  std::copy_n(bytes.begin(), header_bytes, static_cast<std::uint8_t*>(header->GetPackPointer()));
  header->Unpack();
  typename LibraryMessage::Pointer message = LibraryMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  std::copy(bytes.begin() + header_bytes, bytes.end(),
            static_cast<std::uint8_t*>(message->GetPackBodyPointer()));
  if (bytes.size() > header_bytes && (message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) == 0) {
    throw std::runtime_error("the library cannot unpack it");
  }
  return message;
}

json numbers_of(const igtl::Matrix4x4& matrix) {
  json numbers = json::array();
  for (std::size_t i = 0; i < 16; ++i) {
    numbers.push_back(static_cast<double>(matrix[i / 4][i % 4]));
  }
  return numbers;
}

void read_transform(const Bytes& bytes, json& line) {
  igtl::Matrix4x4 matrix;
  unpacked<igtl::TransformMessage>(bytes)->GetMatrix(matrix);
  line["matrix"] = numbers_of(matrix);
}

void read_text(const Bytes& bytes, json& line) {
  line["text"] = unpacked<igtl::StringMessage>(bytes)->GetString();
}

void read_status(const Bytes& bytes, json& line) {
  const auto message = unpacked<igtl::StatusMessage>(bytes);
  line["code"] = message->GetCode();
  line["sub_code"] = message->GetSubCode();
  line["error"] = message->GetErrorName();
  line["text"] = message->GetStatusString();
}

void read_points(const Bytes& bytes, json& line) {
  const auto message = unpacked<igtl::PointMessage>(bytes);
  line["positions"] = json::array();
  for (int i = 0; i < message->GetNumberOfPointElement(); ++i) {
    igtl::PointElement::Pointer point;
    message->GetPointElement(i, point);
    std::array<igtlFloat32, 3> position{};
    point->GetPosition(position.data());
    line["positions"].push_back(position);
  }
}

void read_array(const Bytes& bytes, json& line) {
  const auto message = unpacked<igtl::NDArrayMessage>(bytes);
  igtl::ArrayBase* values = message->GetArray();
  const auto size = values->GetSize();
  const auto* value = static_cast<const igtl_float64*>(values->GetRawArray());
  line["rows"] = json::array();
  for (std::size_t row = 0; row < size.at(0); ++row, value += size.at(1)) {
    line["rows"].push_back(std::vector<double>(value, value + size.at(1)));
  }
}

void read_sensor(const Bytes& bytes, json& line) {
  const auto message = unpacked<igtl::SensorMessage>(bytes);
  line["values"] = json::array();
  for (unsigned int i = 0; i < message->GetLength(); ++i) {
    line["values"].push_back(message->GetValue(i));
  }
}

void read_poses(const Bytes& bytes, json& line) {
  const auto message = unpacked<igtl::TrackingDataMessage>(bytes);
  line["poses"] = json::array();
  for (int i = 0; i < message->GetNumberOfTrackingDataElements(); ++i) {
    igtl::TrackingDataElement::Pointer element;
    message->GetTrackingDataElement(i, element);
    igtl::Matrix4x4 matrix;
    element->GetMatrix(matrix);
    line["poses"].push_back({{"name", element->GetName()}, {"matrix", numbers_of(matrix)}});
  }
}

void read_tracking_reply(const Bytes& bytes, json& line) {
  line["accepted"] = unpacked<igtl::RTSTrackingDataMessage>(bytes)->GetStatus() == 0;
}

void read_capability(const Bytes& bytes, json& line) {
  line["types"] = unpacked<igtl::CapabilityMessage>(bytes)->GetTypes();
}

using Unpacker = void (*)(const Bytes&, json&);

const std::map<std::string, Unpacker>& unpackers() {
  static const std::map<std::string, Unpacker> all{
      {"TRANSFORM", read_transform},  {"STRING", read_text},
      {"STATUS", read_status},        {"POINT", read_points},
      {"NDARRAY", read_array},        {"SENSOR", read_sensor},
      {"TDATA", read_poses},          {"RTS_TDATA", read_tracking_reply},
      {"CAPABILITY", read_capability}};
  return all;
}

bool receive(igtl::Socket& socket, Bytes& bytes, std::size_t from) {
  const int count = static_cast<int>(bytes.size() - from);
  return count == 0 || socket.Receive(bytes.data() + from, count) == count;
}

json line_of(const Bytes& message, std::uint16_t version) {
  const auto field = [&](std::size_t at, std::size_t width) {
    const auto begin = message.begin() + static_cast<std::ptrdiff_t>(at);
    return std::string(begin, std::find(begin, begin + static_cast<std::ptrdiff_t>(width), 0));
  };
  json line{{"type", field(2, 12)}, {"name", field(14, 20)}, {"version", version}};
  const auto unpacker = unpackers().find(line.at("type"));
  if (unpacker == unpackers().end()) {
    throw std::runtime_error("unexpected type " + line.at("type").get<std::string>());
  }
  unpacker->second(version == 2 ? without_extension(message) : message, line);
  return line;
}

/** Until the connection ends. What cannot be read ends the program: the test misses its answer and sees why.
 */
void listen(igtl::Socket& socket) {
  Bytes message(header_bytes);
  while (receive(socket, message, 0)) {
    const auto version = number_at<std::uint16_t>(message, 0);
    const auto size = number_at<std::uint64_t>(message, size_at);
    if ((version != 1 && version != 2) || size > timeout_bytes) {
      throw std::runtime_error("no header");
    }
    message.resize(header_bytes + size);
    if (!receive(socket, message, header_bytes)) {
      return;
    }
    std::cout << line_of(message, version).dump() << std::endl;
    message.resize(header_bytes);
  }
}

void talk(igtl::Socket& socket, int version) {
  for (std::string input; std::getline(std::cin, input);) {
    const json line = json::parse(input);
    const Bytes plain = packers().at(line.at("type"))(line);
    const Bytes message = version == 2 ? with_extension(plain) : plain;
    if (socket.Send(message.data(), static_cast<int>(message.size())) == 0) {
      throw std::runtime_error("the robot is gone");
    }
  }
}

igtl::Socket::Pointer connected(const std::vector<std::string>& arguments) {
  if (arguments.size() == 3 && arguments[0] == "client") {
    const auto client = igtl::ClientSocket::New();
    if (client->ConnectToServer("127.0.0.1", std::stoi(arguments[1])) != 0) {
      throw std::runtime_error("no robot listens on port " + arguments[1]);
    }
    return client.GetPointer();
  }
  if (arguments.size() == 2 && arguments[0] == "server") {
    const auto server = igtl::ServerSocket::New();
    if (server->CreateServer(0) != 0) {
      throw std::runtime_error("cannot listen");
    }
    std::cout << json{{"listening", server->GetServerPort()}}.dump() << std::endl;
    return server->WaitForConnection().GetPointer();
  }
  throw std::runtime_error("usage: igtl_peer client PORT HEADER_VERSION | igtl_peer server HEADER_VERSION");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const igtl::Socket::Pointer socket = connected(arguments);
    std::thread listener([&] {
      try {
        listen(*socket);
      } catch (const std::exception& exception) {
        std::cerr << "igtl_peer: " << exception.what() << std::endl;
        std::_Exit(1);
      }
    });
    talk(*socket, std::stoi(arguments.back()));
    socket->CloseSocket();
    listener.join();
    return 0;
  } catch (const std::exception& exception) {
    std::cerr << "igtl_peer: " << exception.what() << "\n";
    return 1;
  }
}
