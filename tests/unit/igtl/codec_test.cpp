#include "igtl/codec.hpp"

#include <gmock/gmock.h>
#include <igtlPointMessage.h>
#include <igtlSensorMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTrackingDataMessage.h>

#include <random>

#include "bytes.hpp"

namespace interlock::igtl {
namespace {

/** What a peer reads of what another one sends. */
Message travelled(const Body& body, std::uint16_t version) {
  const auto read = test::arrivals(write_frame(version, type_of(body), "DEVICE", 77, encode(body)));
  EXPECT_EQ(read.size(), 1u);
  const auto message = decode(std::get<Frame>(read.at(0)));
  EXPECT_TRUE(message.has_value()) << (message ? "" : fault_text(message.error()));
  return message.value();
}

/** Values that a float32 holds exactly. */
Matrix matrix_from(std::mt19937& random) {
  std::uniform_int_distribution<int> number(-8000, 8000);
  Matrix matrix{};
  matrix[15] = 1.0;
  for (std::size_t i = 0; i < 12; ++i) {
    matrix[i] = number(random) / 16.0;
  }
  return matrix;
}

std::vector<Body> bodies() {
  std::mt19937 random(7);
  return {Transform{matrix_from(random)},
          Text{"manual"},
          Text{""},
          Status{StatusCode::not_ready, -5, "NOT_HOMED", "Home the axes first."},
          Status{StatusCode::ok, 0, "", ""},
          Points{},
          Points{{{"entry", "Fiducial", {1, 2, 3, 4}, {1.5, -2.25, 1e4}, 0.5, "robot"},
                  {"target", "", {255, 255, 255, 255}, {-0.125, 0, 3}, 0, ""}}},
          Position{{1, 2, 3}, std::nullopt},
          Position{{1, 2, 3}, std::array<double, 4>{0.5, -0.5, 0.5, 0.5}},
          TrackingData{},
          TrackingData{{{"measured_cp", 1, matrix_from(random)}, {"desired_cp", 3, matrix_from(random)}}},
          StartTracking{50, "scanner"},
          StopTracking{},
          TrackingReply{true},
          TrackingReply{false},
          Array{{2, 3}, {0, 1, 2.5, -3, 1e300, 5}},
          Array{{1}, {0.1}},
          Sensor{0, 0x0123456789ABCDEFu, {0.1, -2e-300}},
          Sensor{},
          Capability{},
          Capability{{"TRANSFORM", "STATUS", "GET_CAPABIL"}},
          Query{"TRANS"}};
}

TEST(Codec, EveryBodySurvivesTheWireInBothVersions) {
  for (const std::uint16_t version : {std::uint16_t{1}, std::uint16_t{2}}) {
    for (const Body& body : bodies()) {
      const Message message = travelled(body, version);
      EXPECT_EQ(message.body, body) << type_of(body);
      EXPECT_EQ(message.device, "DEVICE");
      EXPECT_EQ(message.timestamp, 77u);
      EXPECT_EQ(message.version, version);
    }
  }
}

TEST(Codec, TextsAreCutToTheirFields) {
  const std::string longer(200, 'x');
  const auto points = std::get<Points>(travelled(Points{{{longer, longer, {}, {}, 0, longer}}}, 1).body);
  EXPECT_EQ(points.points[0].name, longer.substr(0, 63));
  EXPECT_EQ(points.points[0].group, longer.substr(0, 31));
  EXPECT_EQ(points.points[0].owner, longer.substr(0, 19));
  const auto status =
      std::get<Status>(travelled(Status{StatusCode::ok, 0, longer, std::string(9000, 'y')}, 1).body);
  EXPECT_EQ(status.name, longer.substr(0, 19));
  EXPECT_EQ(status.text, std::string(4096, 'y'));
}

TEST(Codec, TextOfSlicersEncodingsIsRead) {
  for (const std::uint8_t encoding : std::initializer_list<std::uint8_t>{1, 3, 106}) {
    const ByteVector body{0, encoding, 0, 2, 'O', 'K'};
    const auto read = test::arrivals(test::message_of("STRING", body));
    const auto message = decode(std::get<Frame>(read.at(0)));
    ASSERT_TRUE(message.has_value());
    EXPECT_EQ(message->body, Body(Text{"OK"}));
  }
}

TEST(Codec, PositionWithThreeNumbersOfARotationGetsTheFourth) {
  ByteVector body;
  for (const double value : {1.0, 2.0, 3.0, 0.5, 0.5, 0.5}) {
    append_float32(body, value);
  }
  const auto read = test::arrivals(test::message_of("POSITION", body));
  const auto message = decode(std::get<Frame>(read.at(0)));
  ASSERT_TRUE(message.has_value());
  const auto& position = std::get<Position>(message->body);
  ASSERT_TRUE(position.rotation.has_value());
  EXPECT_NEAR((*position.rotation)[3], 0.5, 1e-6);
}

TEST(Codec, ArrayOfFloat32IsRead) {
  ByteVector body{10, 2, 0, 2, 0, 1};
  append_float32(body, 1.5);
  append_float32(body, -2.0);
  const auto read = test::arrivals(test::message_of("NDARRAY", body));
  const auto message = decode(std::get<Frame>(read.at(0)));
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->body, Body(Array{{2, 1}, {1.5, -2.0}}));
}

/** A whole message of version 1 as the library unpacks it. */
template <typename LibraryMessage>
typename LibraryMessage::Pointer in_library(const Body& body) {
  const ByteVector bytes = write_frame(1, type_of(body), "DEVICE", 1, encode(body));
  const auto header = ::igtl::MessageHeader::New();
  header->InitPack();
  std::copy_n(bytes.begin(), header_bytes, static_cast<std::uint8_t*>(header->GetPackPointer()));
  header->Unpack();
  typename LibraryMessage::Pointer message = LibraryMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  std::copy(bytes.begin() + header_bytes, bytes.end(),
            static_cast<std::uint8_t*>(message->GetPackBodyPointer()));
  EXPECT_NE(message->Unpack(1) & ::igtl::MessageHeader::UNPACK_BODY, 0) << "the CRC is another one for it";
  return message;
}

TEST(Codec, WhatIsPackedHereIsReadByTheLibrary) {
  const auto points = in_library<::igtl::PointMessage>(
      Points{{{"entry", "Fiducial", {1, 2, 3, 4}, {1.5, -2.25, 7}, 0.5, "robot"}}});
  ASSERT_EQ(points->GetNumberOfPointElement(), 1);
  ::igtl::PointElement::Pointer point;
  points->GetPointElement(0, point);
  float position[3];
  point->GetPosition(position);
  EXPECT_THAT(position, testing::ElementsAre(1.5f, -2.25f, 7.0f));
  EXPECT_STREQ(point->GetName(), "entry");
  EXPECT_STREQ(point->GetOwner(), "robot");

  const auto sensor = in_library<::igtl::SensorMessage>(Sensor{0, 0, {0.1, -2e-300}});
  ASSERT_EQ(sensor->GetLength(), 2u);
  EXPECT_EQ(sensor->GetValue(0), 0.1);
  EXPECT_EQ(sensor->GetValue(1), -2e-300);

  std::mt19937 random(3);
  const Matrix matrix = matrix_from(random);
  const auto tracking = in_library<::igtl::TrackingDataMessage>(TrackingData{{{"measured_cp", 1, matrix}}});
  ASSERT_EQ(tracking->GetNumberOfTrackingDataElements(), 1);
  ::igtl::TrackingDataElement::Pointer tool;
  tracking->GetTrackingDataElement(0, tool);
  ::igtl::Matrix4x4 read;
  tool->GetMatrix(read);
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    EXPECT_EQ(static_cast<double>(read[i / 4][i % 4]), matrix[i]) << i;
  }

  const auto status = in_library<::igtl::StatusMessage>(Status{StatusCode::busy, 4, "BUSY", "later"});
  EXPECT_EQ(status->GetCode(), 6);
  EXPECT_STREQ(status->GetErrorName(), "BUSY");
  EXPECT_STREQ(status->GetStatusString(), "later");
}

TEST(Codec, QueriesAreKnownHoweverTheirTypeWasCut) {
  for (const char* cut : {"TRANS", "TRANSFOR", "TRANSFORM"}) {
    EXPECT_TRUE(asks_for(Query{cut}, "TRANSFORM")) << cut;
  }
  EXPECT_TRUE(asks_for(Query{"CAPABIL"}, "CAPABILITY"));
  EXPECT_TRUE(asks_for(Query{"POINT"}, "POINT"));
  for (const char* other : {"", "T", "TRAN", "TRANSFORMS", "STATUS"}) {
    EXPECT_FALSE(asks_for(Query{other}, "TRANSFORM")) << other;
  }
}

}  // namespace
}  // namespace interlock::igtl
