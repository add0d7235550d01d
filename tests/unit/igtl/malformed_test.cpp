/** Every message that makes the usual receiving loop crash, hang, read beyond its memory or believe what was
 * never sent. Each is refused, or the connection given up, and nothing else is touched. */
#include <gmock/gmock.h>

#include <limits>
#include <optional>
#include <string>

#include "bytes.hpp"
#include "igtl/codec.hpp"

namespace interlock::igtl {
namespace {

using test::header_of;
using test::message_of;
using test::operator+;

enum class Fate { refused, broken };

struct Malformed {
  const char* name;
  Fate fate;
  Fault fault;
  ByteVector bytes;
};

void PrintTo(const Malformed& message, std::ostream* output) { *output << message.name; }

constexpr std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();

ByteVector changed(ByteVector bytes, std::size_t at, std::uint8_t value) {
  bytes[at] = value;
  return bytes;
}

/** A TRANSFORM with that bit pattern as its x. */
ByteVector transform_with(std::uint32_t bits) {
  ByteVector body = test::transform_body(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    body[36 + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
  }
  return body;
}

ByteVector status_body(std::string_view name, std::string_view text) {
  ByteVector body{0, 1, 0, 0, 0, 0, 0, 0, 0, 0};
  append_field(body, name, 20);
  body.insert(body.end(), text.begin(), text.end());
  return body;
}

ByteVector array_body(std::uint8_t element, std::vector<std::uint16_t> sizes, std::size_t bytes) {
  ByteVector body{element, static_cast<std::uint8_t>(sizes.size())};
  for (const std::uint16_t size : sizes) {
    append_number(body, size);
  }
  body.resize(body.size() + bytes);
  return body;
}

/** Version 2: extended header of those lengths, and that much behind it. */
ByteVector extended(std::uint16_t header, std::uint16_t index, std::uint32_t texts, const ByteVector& rest) {
  ByteVector body;
  append_number(body, header);
  append_number(body, index);
  append_number(body, texts);
  append_number(body, std::uint32_t{0});
  return body + rest;
}

/** Content of a STRING, then an index of one entry with those lengths. */
ByteVector indexed(std::uint16_t count, std::uint16_t key, std::uint32_t value, const ByteVector& texts) {
  ByteVector rest = test::text_body("x");
  append_number(rest, count);
  append_number(rest, key);
  append_number(rest, std::uint16_t{3});
  append_number(rest, value);
  return rest + texts;
}

ByteVector point_body() { return ByteVector(136); }

const std::vector<Malformed>& table() {
  static const std::vector<Malformed> all{
      // What was measured with the library's own loop.
      {"unknown_type_of_64_KiB", Fate::refused, Fault::unknown_type,
       message_of("VIDEO", ByteVector(longest_skipped))},
      {"unknown_type_of_64_KiB_and_a_byte", Fate::broken, Fault::too_large,
       header_of("VIDEO", longest_skipped + 1, 0)},
      {"unknown_type_of_4_GiB", Fate::broken, Fault::too_large, header_of("VIDEO", 0xFFFFFFFFu, 0)},
      {"string_of_4_GiB", Fate::broken, Fault::too_large, header_of("STRING", 0xFFFFFFFFu, 0)},
      {"transform_of_4_GiB", Fate::broken, Fault::too_large, header_of("TRANSFORM", 0xFFFFFFFFu, 0)},
      {"string_of_all_sizes", Fate::broken, Fault::too_large, header_of("STRING", huge, 0)},
      {"transform_of_all_sizes", Fate::broken, Fault::too_large, header_of("TRANSFORM", huge, 0)},
      {"body_of_2_GiB", Fate::broken, Fault::too_large, header_of("TRANSFORM", 0x7FFFFFFFu, 0)},
      {"size_that_is_48_in_32_bits", Fate::broken, Fault::too_large,
       header_of("TRANSFORM", (std::uint64_t{1} << 32u) + 48, 0)},
      {"size_that_is_0_in_32_bits", Fate::broken, Fault::too_large,
       header_of("TRANSFORM", std::uint64_t{1} << 62u, 0)},
      {"transform_without_body", Fate::refused, Fault::wrong_size, header_of("TRANSFORM", 0, 0)},
      {"transform_of_4_bytes", Fate::refused, Fault::wrong_size, message_of("TRANSFORM", ByteVector(4))},
      {"transform_of_47_bytes", Fate::refused, Fault::wrong_size, message_of("TRANSFORM", ByteVector(47))},
      {"transform_of_49_bytes", Fate::refused, Fault::wrong_size, message_of("TRANSFORM", ByteVector(49))},
      {"string_longer_than_its_body", Fate::refused, Fault::inner_length,
       message_of("STRING", {0, 3, 0xFF, 0xFF})},
      {"version_2_size_beyond_ceiling", Fate::broken, Fault::too_large, header_of("STRING", huge, 0, 2)},
      // Header.
      {"version_0", Fate::broken, Fault::version, header_of("STRING", 4, 0, 0)},
      {"version_3", Fate::broken, Fault::version, header_of("STRING", 4, 0, 3)},
      {"no_type", Fate::broken, Fault::type_name, header_of("", 0, 0)},
      {"type_with_control_character", Fate::broken, Fault::type_name, header_of("STR\x01NG", 0, 0)},
      {"type_with_rubbish_behind", Fate::broken, Fault::type_name,
       changed(header_of("STRING", 0, 0), 2 + 11, 'X')},
      {"device_not_ascii", Fate::broken, Fault::device_name, header_of("STRING", 4, 0, 1, "\xC3\xA4")},
      {"device_with_rubbish_behind", Fate::broken, Fault::device_name,
       changed(header_of("STRING", 4, 0), 14 + 19, 'X')},
      {"wrong_crc", Fate::refused, Fault::checksum, header_of("STRING", 5, 1) + test::text_body("x")},
      {"query_with_body", Fate::refused, Fault::wrong_size, message_of("GET_STATUS", {1})},
      {"stop_tracking_with_body", Fate::refused, Fault::wrong_size, message_of("STP_TDATA", {1})},
      // Extended header and metadata.
      {"version_2_without_extended_header", Fate::refused, Fault::extended_header,
       message_of("STRING", ByteVector(11), 2)},
      {"extended_header_too_short", Fate::refused, Fault::extended_header,
       message_of("STRING", extended(11, 0, 0, test::text_body("x")), 2)},
      {"extended_header_beyond_body", Fate::refused, Fault::extended_header,
       message_of("STRING", extended(500, 0, 0, test::text_body("x")), 2)},
      {"metadata_index_beyond_body", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 6, 0, test::text_body("x")), 2)},
      {"metadata_beyond_body", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 0, 0xFFFFFFFFu, test::text_body("x")), 2)},
      {"metadata_without_index", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 0, 3, test::text_body("x") + ByteVector(3)), 2)},
      {"metadata_count_too_large", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 10, 1, indexed(2, 1, 0, {'k'})), 2)},
      {"metadata_key_beyond_texts", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 10, 1, indexed(1, 2, 0, {'k'})), 2)},
      {"metadata_value_beyond_texts", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 10, 1, indexed(1, 1, 0xFFFFFFFFu, {'k'})), 2)},
      {"metadata_with_texts_left", Fate::refused, Fault::metadata,
       message_of("STRING", extended(12, 10, 2, indexed(1, 1, 0, {'k', 'l'})), 2)},
      {"version_2_transform_of_47_bytes", Fate::refused, Fault::wrong_size,
       message_of("TRANSFORM", extended(12, 0, 0, ByteVector(47)), 2)},
      // Bodies.
      {"transform_of_infinity", Fate::refused, Fault::not_finite,
       message_of("TRANSFORM", transform_with(0x7F800000u))},
      {"transform_of_no_number", Fate::refused, Fault::not_finite,
       message_of("TRANSFORM", transform_with(0x7FC00000u))},
      {"string_of_3_bytes", Fate::refused, Fault::wrong_size, message_of("STRING", ByteVector(3))},
      {"string_shorter_than_its_body", Fate::refused, Fault::inner_length,
       message_of("STRING", {0, 3, 0, 0, 'x'})},
      {"string_of_utf_16", Fate::refused, Fault::text, message_of("STRING", {0x03, 0xF7, 0, 1, 'x'})},
      {"string_with_control_character", Fate::refused, Fault::text,
       message_of("STRING", test::text_body("a\x1B[2J"))},
      {"string_with_a_zero_inside", Fate::refused, Fault::text,
       message_of("STRING", test::text_body(std::string_view("a\0b", 3)))},
      {"status_of_30_bytes", Fate::refused, Fault::wrong_size, message_of("STATUS", ByteVector(30))},
      {"status_of_2_bytes", Fate::refused, Fault::wrong_size, message_of("STATUS", ByteVector(2))},
      {"status_name_unterminated", Fate::refused, Fault::text,
       message_of("STATUS", status_body("12345678901234567890", std::string_view("\0", 1)))},
      {"status_text_unterminated", Fate::refused, Fault::text, message_of("STATUS", status_body("OK", "x"))},
      {"status_text_with_control_character", Fate::refused, Fault::text,
       message_of("STATUS", status_body("OK", std::string_view("a\x1B[2J\0", 6)))},
      {"point_of_135_bytes", Fate::refused, Fault::wrong_size, message_of("POINT", ByteVector(135))},
      {"point_name_unterminated", Fate::refused, Fault::text, message_of("POINT", ByteVector(136, 'x'))},
      {"point_of_infinity", Fate::refused, Fault::not_finite,
       message_of("POINT", changed(changed(point_body(), 100, 0x7F), 101, 0x80))},
      {"too_many_points", Fate::broken, Fault::too_large, message_of("POINT", ByteVector(1001 * 136))},
      {"tracking_of_69_bytes", Fate::refused, Fault::wrong_size, message_of("TDATA", ByteVector(69))},
      {"tracking_name_unterminated", Fate::refused, Fault::text, message_of("TDATA", ByteVector(70, 'x'))},
      {"tracking_of_infinity", Fate::refused, Fault::not_finite,
       message_of("TDATA", changed(changed(ByteVector(70), 22, 0x7F), 23, 0x80))},
      {"tracking_reply_without_body", Fate::refused, Fault::wrong_size, message_of("RTS_TDATA", {})},
      {"tracking_start_of_35_bytes", Fate::refused, Fault::wrong_size,
       message_of("STT_TDATA", ByteVector(35))},
      {"tracking_start_name_unterminated", Fate::refused, Fault::text,
       message_of("STT_TDATA", ByteVector(36, 'x'))},
      {"position_of_infinity", Fate::refused, Fault::not_finite,
       message_of("POSITION", changed(changed(ByteVector(12), 0, 0x7F), 1, 0x80))},
      {"position_of_16_bytes", Fate::refused, Fault::wrong_size, message_of("POSITION", ByteVector(16))},
      {"array_of_1_byte", Fate::refused, Fault::wrong_size, message_of("NDARRAY", ByteVector(1))},
      {"array_of_integers", Fate::refused, Fault::element_type, message_of("NDARRAY", array_body(6, {1}, 4))},
      {"array_without_dimension", Fate::refused, Fault::inner_length,
       message_of("NDARRAY", array_body(11, {}, 8))},
      {"array_whose_dimensions_end_early", Fate::refused, Fault::inner_length,
       message_of("NDARRAY", {11, 200, 0, 1})},
      {"array_larger_than_its_body", Fate::refused, Fault::inner_length,
       message_of("NDARRAY", array_body(11, {65535, 65535}, 8))},
      {"array_of_2_to_the_64", Fate::refused, Fault::inner_length,
       message_of("NDARRAY", array_body(11, {32768, 32768, 32768, 32768, 2}, 0))},
      {"array_smaller_than_its_body", Fate::refused, Fault::inner_length,
       message_of("NDARRAY", array_body(11, {1}, 9))},
      {"array_with_an_empty_dimension", Fate::refused, Fault::inner_length,
       message_of("NDARRAY", array_body(11, {0, 5}, 0))},
      {"array_of_no_number", Fate::refused, Fault::not_finite,
       message_of("NDARRAY", array_body(10, {1}, 0) + ByteVector{0x7F, 0xC0, 0, 0})},
      {"sensor_of_9_bytes", Fate::refused, Fault::wrong_size, message_of("SENSOR", ByteVector(9))},
      {"sensor_with_more_numbers_than_body", Fate::refused, Fault::inner_length,
       message_of("SENSOR", changed(ByteVector(18), 0, 255))},
      {"sensor_with_fewer_numbers_than_body", Fate::refused, Fault::inner_length,
       message_of("SENSOR", ByteVector(18))},
      {"sensor_of_infinity", Fate::refused, Fault::not_finite,
       message_of("SENSOR", changed(changed(changed(ByteVector(18), 0, 1), 10, 0x7F), 11, 0xF0))},
      {"capability_of_11_bytes", Fate::refused, Fault::wrong_size, message_of("CAPABILITY", ByteVector(11))},
      {"capability_not_ascii", Fate::refused, Fault::text, message_of("CAPABILITY", ByteVector(12, 0xFF))},
  };
  return all;
}

/** What becomes of a message: its fault, and whether it ends the connection. */
struct Judged {
  Fate fate;
  Fault fault;
};

std::optional<Judged> judge(const Arrival& arrival) {
  if (const auto* broken = std::get_if<Broken>(&arrival)) {
    return Judged{Fate::broken, broken->fault};
  }
  if (const auto* refused = std::get_if<Refused>(&arrival)) {
    return Judged{Fate::refused, refused->fault};
  }
  const auto message = decode(std::get<Frame>(arrival));
  return message ? std::nullopt : std::optional(Judged{Fate::refused, message.error()});
}

class MalformedMessage : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedMessage, IsRefusedAndTheNextOneIsRead) {
  const ByteVector next = write_frame(1, "STRING", "AFTER", 0, test::text_body("still here"));
  const auto read = test::arrivals(GetParam().bytes + next);
  ASSERT_FALSE(read.empty());
  const auto judged = judge(read[0]);
  ASSERT_TRUE(judged.has_value()) << "was accepted";
  EXPECT_EQ(judged->fault, GetParam().fault) << fault_text(judged->fault);
  EXPECT_EQ(judged->fate, GetParam().fate);
  if (GetParam().fate == Fate::refused) {
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(std::get<Frame>(read[1]).header.device, "AFTER");
  } else {
    EXPECT_EQ(read.size(), 1u) << "nobody knows where a next message begins";
  }
}

INSTANTIATE_TEST_SUITE_P(All, MalformedMessage, testing::ValuesIn(table()),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(Malformed, NothingIsKeptOfABodyThatWillBeRefused) {
  FrameReader reader;
  const ByteVector header = header_of("TRANSFORM", longest_skipped, 0);
  ASSERT_EQ(test::arrivals(reader, header).size(), 1u);
  EXPECT_TRUE(reader.is_within_message());
  EXPECT_TRUE(test::arrivals(reader, ByteVector(longest_skipped)).empty());
  EXPECT_FALSE(reader.is_within_message());
}

}  // namespace
}  // namespace interlock::igtl
