#include "config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>

#include "config_error_text.h"
#include "fixtures.hpp"
#include "interlock/kernel.h"

namespace {

using interlock::host_test::one_axis_config;
using interlock::host_test::TemporaryDirectory;
using ::testing::HasSubstr;

class ConfigFile : public ::testing::Test {
 protected:
  void write(const ilk_config_t& config, size_t bytes = sizeof(ilk_config_t)) {
    std::string content(reinterpret_cast<const char*>(&config), sizeof config);
    content.resize(bytes);
    std::ofstream(path, std::ios::binary) << content;
  }
  std::string refusal() {
    ilk_error_t error{};
    EXPECT_FALSE(ilk_config_load(path.c_str(), &loaded, &error));
    EXPECT_THAT(error.text, HasSubstr(path));
    return error.text;
  }

  TemporaryDirectory directory;
  std::string path = directory.file("robot.ilkc");
  ilk_config_t loaded{};
};

TEST_F(ConfigFile, ValidOneIsTakenWordForWord) {
  const ilk_config_t config = one_axis_config();
  write(config);
  ilk_error_t error{};
  ASSERT_TRUE(ilk_config_load(path.c_str(), &loaded, &error)) << error.text;
  EXPECT_EQ(std::memcmp(&loaded, &config, sizeof config), 0);
}

TEST_F(ConfigFile, P13RuleThatIsBrokenIsNamedWithItsSlot) {
  ilk_config_t config = one_axis_config();
  config.axis[0].coast_counts = 0;
  config.crc = ilk_config_crc(&config);
  write(config);
  const std::string refused = refusal();
  EXPECT_THAT(refused, HasSubstr("slot 0: COAST: "));
  EXPECT_THAT(refused, HasSubstr(ilk_config_error_text(ILK_CONFIG_ERROR_COAST).meaning));
}

TEST_F(ConfigFile, P13DamageIsNamed) {
  ilk_config_t config = one_axis_config();
  config.axis[0].max_counts += 1;
  write(config);
  EXPECT_THAT(refusal(), HasSubstr("refused: CRC: "));
}

TEST_F(ConfigFile, WrongLengthsAreNamed) {
  write(one_axis_config(), sizeof(ilk_config_t) - 1);
  EXPECT_THAT(refusal(), HasSubstr("has " + std::to_string(sizeof(ilk_config_t) - 1) + " bytes; expected " +
                                   std::to_string(sizeof(ilk_config_t))));
  write(one_axis_config(), sizeof(ilk_config_t) + 100);
  EXPECT_THAT(refusal(), HasSubstr("has at least"));
  write(one_axis_config(), 0);
  EXPECT_THAT(refusal(), HasSubstr("has 0 bytes"));
}

TEST_F(ConfigFile, MissingFileAndDirectoryAreNamed) {
  EXPECT_THAT(refusal(), HasSubstr("cannot be opened"));
  path = directory.file("");
  EXPECT_THAT(refusal(), HasSubstr("cannot be read"));
}

TEST(ConfigErrorText, EveryErrorHasNameAndMeaning) {
  for (uint32_t error = 0; error < ILK_CONFIG_ERROR_COUNT; ++error) {
    EXPECT_STRNE(ilk_config_error_text(error).name, "UNKNOWN");
    EXPECT_STRNE(ilk_config_error_text(error).meaning, "");
  }
  EXPECT_STREQ(ilk_config_error_text(UINT32_MAX).name, "UNKNOWN");
}

}  // namespace
