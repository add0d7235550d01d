#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <vector>

#include "robot_fixture.hpp"
#include "service/status_json.hpp"

namespace interlock::web {
namespace {

std::vector<std::uint32_t> words_of(const StreamMessage& message) {
  std::vector<std::uint32_t> words;
  for (std::size_t i = 0; i < message.size(); i += 4) {
    words.push_back(message[i] | static_cast<std::uint32_t>(message[i + 1]) << 8 |
                    static_cast<std::uint32_t>(message[i + 2]) << 16 |
                    static_cast<std::uint32_t>(message[i + 3]) << 24);
  }
  return words;
}

TEST(StreamMessage, WithoutAKernelIsZeroButForMagicVersionAndSlots) {
  ControlView view = test::ready_view();
  view.attached = false;
  OpenTargets targets{};
  targets[0] = {true, 5};
  const auto words =
      words_of(encode_state(view, test::neuro_config(), targets, std::chrono::steady_clock::now()));
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t expected = i == 0 ? stream_magic : i == 1 ? stream_version : i == 19 ? ILK_SLOTS : 0;
    EXPECT_EQ(words[i], expected) << "word " << i;
  }
}

TEST(StreamMessage, ShowsTheOpenTargetOfAnAxis) {
  const ControlView view = test::ready_view();
  OpenTargets targets{};
  targets[test::insertion] = {true, -7};
  const auto words = words_of(encode_state(view, test::neuro_config(), targets, view.received));
  const std::size_t slot = stream_header_words + test::insertion * stream_slot_words;
  EXPECT_EQ(words[slot + 4] & 16u, 16u);
  EXPECT_EQ(std::bit_cast<std::int32_t>(words[slot + 7]), -7);
}

TEST(StreamMessage, EndsWithTheStateOfTheKernelWordForWord) {
  ControlView view = test::ready_view();
  view.snapshot.state.seal = 0x89ABCDEFu;
  const auto words = words_of(encode_state(view, test::neuro_config(), {}, view.received));
  const std::size_t state = stream_header_words + ILK_SLOTS * stream_slot_words;
  ASSERT_EQ(words.size(), state + sizeof(ilk_state_t) / 4);
  EXPECT_EQ(std::memcmp(&words[state], &view.snapshot.state, sizeof(ilk_state_t)), 0);
  EXPECT_EQ(words.back(), 0x89ABCDEFu);
}

TEST(StreamMessage, SaturatesItsAge) {
  const ControlView view = test::ready_view();
  const auto later = [&](auto age) {
    return words_of(encode_state(view, test::neuro_config(), {}, view.received + age))[15];
  };
  EXPECT_EQ(later(std::chrono::milliseconds(3)), 3000u);
  EXPECT_EQ(later(std::chrono::hours(2)), UINT32_MAX);
  EXPECT_EQ(later(std::chrono::milliseconds(-3)), 0u);
}

}  // namespace
}  // namespace interlock::web
