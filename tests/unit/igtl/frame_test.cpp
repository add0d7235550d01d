#include "igtl/frame.hpp"

#include <gmock/gmock.h>

#include <random>

#include "bytes.hpp"

namespace interlock::igtl {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr std::string_view check_text = "123456789";

ByteVector bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Crc64, IsThatOfEcma182) { EXPECT_EQ(crc64(bytes_of(check_text)), 0x6c40df5f0b497347u); }

TEST(Crc64, SaysNothingAboutZeros) {
  EXPECT_EQ(crc64({}), 0u);
  EXPECT_EQ(crc64(ByteVector(48)), 0u);
}

TEST(Header, SurvivesTheWire) {
  const Header header{2, "TRANSFORM", "REGISTRATION", 0x0123456789ABCDEFu, 48, 0xFEDCBA9876543210u};
  ByteVector bytes;
  append_header(bytes, header);
  ASSERT_EQ(bytes.size(), header_bytes);
  EXPECT_EQ(read_header(bytes), header);
}

/** Of both versions, whole. */
ByteVector conversation() {
  using test::operator+;
  return write_frame(1, "STRING", "MODE", 7, test::text_body("manual")) +
         write_frame(2, "TRANSFORM", "REGISTRATION", 8, test::transform_body(1, 2, 3)) +
         write_frame(1, "GET_STATUS", "", 9, {}) + write_frame(2, "GET_TRANS", "measured_cp", 10, {});
}

TEST(FrameReader, ReadsTheSameHoweverTheBytesAreSplit) {
  const ByteVector all = conversation();
  const auto whole = test::arrivals(all);
  ASSERT_EQ(whole.size(), 4u);
  std::mt19937 random(41);
  for (int run = 0; run < 200; ++run) {
    FrameReader reader;
    std::vector<Frame> frames;
    for (Bytes left = all; !left.empty();) {
      // The first run sends byte by byte.
      std::uniform_int_distribution<std::size_t> length(1, run == 0 ? 1 : 80);
      const std::size_t count = std::min(length(random), left.size());
      for (Arrival& each : test::arrivals(reader, left.first(count))) {
        frames.push_back(std::get<Frame>(std::move(each)));
      }
      left = left.subspan(count);
    }
    ASSERT_EQ(frames.size(), whole.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].header, std::get<Frame>(whole[i]).header);
      EXPECT_EQ(frames[i].content, std::get<Frame>(whole[i]).content);
    }
    EXPECT_FALSE(reader.is_within_message());
  }
}

TEST(FrameReader, SaysWhetherAMessageHasBegun) {
  const ByteVector message = write_frame(1, "STRING", "MODE", 0, test::text_body("manual"));
  for (std::size_t count = 1; count < message.size(); ++count) {
    FrameReader reader;
    EXPECT_TRUE(test::arrivals(reader, Bytes(message).first(count)).empty());
    EXPECT_TRUE(reader.is_within_message()) << count;
  }
}

TEST(FrameReader, TakesMetadataOffVersion2) {
  const ByteVector content = test::text_body("x");
  ByteVector body{0, 14, 0, 18, 0, 0, 0, 11, 0, 0, 0, 5, 0xAA, 0xBB};  // a longer header than today's
  body.insert(body.end(), content.begin(), content.end());
  for (const int byte : {0, 2, 0, 5, 0, 3, 0, 0, 0, 5, 0, 1, 0, 3, 0, 0, 0, 0}) {
    body.push_back(static_cast<std::uint8_t>(byte));
  }
  for (const char each : std::string_view("dummydummyk")) {
    body.push_back(static_cast<std::uint8_t>(each));
  }
  const auto read = test::arrivals(test::message_of("STRING", body, 2));
  ASSERT_EQ(read.size(), 1u);
  const Frame& frame = std::get<Frame>(read[0]);
  EXPECT_EQ(frame.content, content);
  EXPECT_EQ(frame.message_id, 5u);
  EXPECT_THAT(frame.metadata, ElementsAre(Pair("dummy", "dummy"), Pair("k", "")));
}

TEST(FrameReader, SkipsUnknownTypesAndGoesOn) {
  using test::operator+;
  const auto read = test::arrivals(test::message_of("VIDEO", ByteVector(longest_skipped, 1)) +
                                   write_frame(1, "STRING", "MODE", 0, test::text_body("manual")));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(std::get<Refused>(read[0]).fault, Fault::unknown_type);
  EXPECT_EQ(std::get<Refused>(read[0]).header.type, "VIDEO");
  EXPECT_EQ(std::get<Frame>(read[1]).header.device, "MODE");
}

}  // namespace
}  // namespace interlock::igtl
