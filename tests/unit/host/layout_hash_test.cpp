#include <gtest/gtest.h>

#include <vector>

#include "layout_table.h"

namespace {

std::vector<ilk_layout_field_t> shared_fields() { return {ILK_LAYOUT_FIELDS(ILK_LAYOUT_ENTRY)}; }

TEST(LayoutHash, FieldsTileEverySharedStructure) {
  const auto fields = shared_fields();
  ASSERT_GT(fields.size(), 100u);
  for (size_t i = 0; i < fields.size(); ++i) {
    const uint32_t end = fields[i].offset + fields[i].bytes;
    const bool last = i + 1 == fields.size() || fields[i + 1].offset == 0;
    EXPECT_EQ(end, last ? fields[i].struct_bytes : fields[i + 1].offset) << "entry " << i;
    EXPECT_EQ(fields[i].bytes % sizeof(uint32_t), 0u) << "entry " << i;
  }
  EXPECT_EQ(fields.front().offset, 0u);
}

TEST(LayoutHash, IsTheSameForCAndCxx) {
  const auto fields = shared_fields();
  EXPECT_EQ(ilk_link_layout_hash(), ilk_layout_crc(fields.data(), fields.size()));
}

TEST(LayoutHash, IsTheCrc32OfTheStandards) {
  const ilk_layout_field_t words{0x34333231u, 0x38373635u, 0x32313039u};  // "123456789012"
  EXPECT_EQ(ilk_layout_crc(&words, 1), 0x5D34EB96u);
}

TEST(LayoutHash, ChangesWithEveryOffsetAndSize) {
  const uint32_t sound = ilk_link_layout_hash();
  auto fields = shared_fields();
  for (auto& field : fields) {
    for (uint32_t* word : {&field.struct_bytes, &field.offset, &field.bytes}) {
      *word += 4;
      EXPECT_NE(ilk_layout_crc(fields.data(), fields.size()), sound);
      *word -= 4;
    }
  }
  fields.pop_back();
  EXPECT_NE(ilk_layout_crc(fields.data(), fields.size()), sound);
}

}  // namespace
