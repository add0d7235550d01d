#include "store/settings.hpp"

#include "store_fixture.hpp"

namespace interlock {
namespace {

class SettingsTest : public StoreTest {};

TEST_F(SettingsTest, IsThereAfterReopening) {
  {
    Store store = open();
    commit(store,
           [](Transaction& transaction) { Settings(transaction).set("level", {{"now", "debug"}}, noon); });
  }
  Store store = open();
  const auto setting =
      seen(store, [](Transaction& transaction) { return Settings(transaction).find("level"); });
  ASSERT_TRUE(setting);
  EXPECT_EQ(setting->value, (nlohmann::json{{"now", "debug"}}));
  EXPECT_EQ(setting->updated, noon);
}

TEST_F(SettingsTest, LastValueCounts) {
  Store store = open();
  commit(store, [](Transaction& transaction) {
    Settings(transaction).set("number", 1, noon);
    Settings(transaction).set("number", 2, noon + std::chrono::seconds(1));
  });
  const auto setting =
      seen(store, [](Transaction& transaction) { return Settings(transaction).find("number"); });
  EXPECT_EQ(setting->value, 2);
  EXPECT_EQ(setting->updated, noon + std::chrono::seconds(1));
}

TEST_F(SettingsTest, UnknownKeyHasNoValue) {
  Store store = open();
  EXPECT_FALSE(seen(store, [](Transaction& transaction) { return Settings(transaction).find("none"); }));
}

TEST_F(SettingsTest, ForgedValueIsDamageNotACrash) {
  Store store = open();
  commit(store, [](Transaction& transaction) { Settings(transaction).set("key", 1, noon); });
  execute("UPDATE settings SET value = '{'");
  const auto found = store.read(
      [](Transaction& transaction) -> Stored<bool> { return Settings(transaction).find("key").has_value(); });
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, StoreError::Kind::damaged);
}

}  // namespace
}  // namespace interlock
