#include "interlock/recorded_fields.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>

#include "recorded_run.hpp"

namespace {

std::string name_at(std::size_t offset) {
  return ilk_word_name(ilk_picture_fields(), static_cast<std::uint32_t>(offset)).text;
}

TEST(RecordedFields, EveryWordOfEveryStructureHasANameOfItsOwn) {
  for (const ilk_field_table_t* table : {ilk_picture_fields(), ilk_request_fields(), ilk_config_fields()}) {
    std::set<std::string> names;
    for (std::uint32_t offset = 0; offset < table->bytes; offset += sizeof(std::uint32_t)) {
      const std::string name = ilk_word_name(table, offset).text;
      EXPECT_FALSE(name.empty()) << offset;
      EXPECT_TRUE(names.insert(name).second) << name;
    }
    EXPECT_STREQ(ilk_word_name(table, table->bytes).text, "");
  }
}

TEST(RecordedFields, NamesReadAsInTheHeaders) {
  EXPECT_EQ(name_at(offsetof(ilk_picture_t, state.system.mode)), "state.system.mode");
  EXPECT_EQ(name_at(offsetof(ilk_picture_t, state.axis[3].lease_ticks)), "state.axis[3].lease_ticks");
  EXPECT_EQ(name_at(offsetof(ilk_picture_t, inputs.frame[9][31])), "inputs.frame[9][31]");
  EXPECT_EQ(name_at(offsetof(ilk_picture_t, out.verdict[15].sequence)), "out.verdict[15].sequence");
  EXPECT_EQ(name_at(offsetof(ilk_picture_t, out.lamp[2])), "out.lamp[2]");
}

TEST(RecordedFields, IntegersAreKnownAsSuch) {
  const auto integer = [](std::size_t offset) {
    return ilk_word_name(ilk_picture_fields(), static_cast<std::uint32_t>(offset)).integer;
  };
  EXPECT_TRUE(integer(offsetof(ilk_picture_t, state.axis[1].position_counts)));
  EXPECT_FALSE(integer(offsetof(ilk_picture_t, state.axis[1].raw)));
}

template <typename Words, typename Digest>
void expect_each_bit_to_show(Words& words, Digest digest_of) {
  const auto digest = digest_of(&words);
  auto* const bytes = reinterpret_cast<unsigned char*>(&words);
  for (std::size_t bit = 0; bit < sizeof words * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<unsigned char>(1U << (bit % 8));
    EXPECT_NE(digest_of(&words), digest) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<unsigned char>(1U << (bit % 8));
  }
  EXPECT_EQ(digest_of(&words), digest);
}

TEST(Digest, AnyFlippedBitOfStateOrOutputsShows) {
  ilk_config_t config{};
  ilk_state_t state{};
  ilk_inputs_t in{};
  ilk_outputs_t out{};
  world_config(&config);
  ilk_init(&config, &state);
  ilk_step(&config, &state, &in, nullptr, 0, &out);
  expect_each_bit_to_show(state, ilk_state_digest);
  expect_each_bit_to_show(out, ilk_out_digest);
}

}  // namespace
