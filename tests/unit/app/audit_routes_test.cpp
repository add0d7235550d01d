#include <SQLiteCpp/SQLiteCpp.h>

#include "http_fixture.hpp"

namespace interlock::web {
namespace {

class AuditRoutesTest : public HttpTest {
 protected:
  AuditRoutesTest() : admin_(token_of("ada")) {}

  Answered read_audit(const std::string& query) {
    return as(admin_, [&] { return get("/api/audit" + query); });
  }

  json records(const std::string& query) { return json::parse(read_audit(query).body); }

  json verify(const std::string& query = "") { return json::parse(read_audit("/verify" + query).body); }

  void change_target(int x) {
    ASSERT_EQ(put("/api/targeting/target", json{{"target_point", {x, 0, 0}}}.dump()).status, 200u);
  }

  std::string admin_;
};

TEST_F(AuditRoutesTest, TheNewestRecordsComeOldestFirst) {
  for (int x = 1; x <= 3; ++x) {
    change_target(x);
  }
  const json two = records("?records=2");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0]["detail"]["new"]["target_point"][0], 2.0);
  EXPECT_EQ(two[1]["detail"]["new"]["target_point"][0], 3.0);
  EXPECT_EQ(two[1]["number"], two[0]["number"].get<int>() + 1);
  EXPECT_EQ(two[1]["hash"].get<std::string>().size(), 64u);
  const json before = records("?records=1&before=" + std::to_string(two[0]["number"].get<int>()));
  ASSERT_EQ(before.size(), 1u);
  EXPECT_EQ(before[0]["number"], two[0]["number"].get<int>() - 1);
}

TEST_F(AuditRoutesTest, RecordsAreFoundByKindActorAndText) {
  change_target(1);
  for (const char* const query : {"?kind=setting", "?actor=edna", "?text=Target_Point"}) {
    const json found = records(query);
    ASSERT_FALSE(found.empty()) << query;
    EXPECT_EQ(found.back()["detail"]["new"]["target_point"][0], 1.0) << query;
  }
  EXPECT_TRUE(records("?kind=setting&actor=nobody").empty());
}

TEST_F(AuditRoutesTest, OnlyAdministratorsReadIt) { EXPECT_EQ(get("/api/audit").problem()["code"], "ROLE"); }

TEST_F(AuditRoutesTest, AWrongParameterIsNamedAndAnUnknownOneIgnored) {
  const std::pair<std::string, std::string> cases[] = {
      {"records=0", "records"}, {"records=1001", "records"}, {"records=all", "records"},
      {"before=0", "before"},   {"before=-1", "before"},     {"since=noon", "since"}};
  for (const auto& [query, field] : cases) {
    const Answered answered = read_audit("?" + query);
    EXPECT_EQ(answered.status, 422u) << query;
    EXPECT_EQ(answered.problem()["field"], field) << query;
  }
  EXPECT_EQ(read_audit("?colour=red").status, 200u);
}

TEST_F(AuditRoutesTest, TheCheckNamesTheHeadOfASoundChain) {
  for (int x = 1; x <= 3; ++x) {
    change_target(x);
  }
  const json check = verify();
  const AuditRecord last = audit().back();
  EXPECT_EQ(check["sound"], true) << check;
  EXPECT_EQ(check["head"], (json{{"number", last.number}, {"hash", last.hash}}));
  EXPECT_TRUE(check["broken"].is_null());
  EXPECT_EQ(check["checked"], iso_8601(now()));
  EXPECT_EQ(verify("?noted=" + last.hash)["sound"], true);
}

TEST_F(AuditRoutesTest, TheCheckSaysThatThisMachineNotesNoHeads) {
  const json check = verify();
  EXPECT_EQ(check["proven"], true);
  EXPECT_TRUE(check["noted_heads"]["file"].is_null());
  EXPECT_EQ(check["noted_heads"]["noted"], 0);
  EXPECT_THAT(
      check["noted_heads"]["summary"].get<std::string>(),
      testing::HasSubstr("of which this machine keeps none: records cut off or written anew do not show"));
}

TEST_F(AuditRoutesTest, TheCheckNamesTheFirstTriggerThatIsMissing) {
  SQLite::Database forger((folder_.path() / "state" / "interlock.db").string(), SQLite::OPEN_READWRITE, 5000);
  forger.exec("DROP TRIGGER audit_is_not_changed");
  const Answered answered = read_audit("/verify");
  EXPECT_EQ(answered.status, 503U);
  EXPECT_THAT(answered.problem()["detail"].get<std::string>(),
              testing::HasSubstr("trigger audit_is_not_changed is missing"));
}

TEST_F(AuditRoutesTest, TheCheckNamesTheFirstRecordThatWasForged) {
  change_target(1);
  change_target(2);
  const std::int64_t number = audit().back().number - 1;
  SQLite::Database forger((folder_.path() / "state" / "interlock.db").string(), SQLite::OPEN_READWRITE, 5000);
  forger.exec("DROP TRIGGER audit_is_not_changed");
  forger.exec("UPDATE audit SET actor = 'eve' WHERE number = " + std::to_string(number));
  const json check = verify();
  EXPECT_EQ(check["sound"], false) << check;
  EXPECT_TRUE(check["head"].is_null());
  EXPECT_EQ(check["broken"]["number"], number);
  EXPECT_THAT(check["broken"]["problem"].get<std::string>(), testing::HasSubstr("was changed"));
}

TEST_F(AuditRoutesTest, TheCheckMissesANotedHashAndRefusesWhatIsNone) {
  change_target(1);
  const json check = verify("?noted=" + std::string(64, 'a'));
  EXPECT_EQ(check["sound"], false);
  EXPECT_EQ(check["broken"]["number"], audit().back().number + 1);
  for (const std::string& wrong : {std::string(63, 'a'), std::string(64, 'A'), std::string(64, 'g')}) {
    EXPECT_EQ(read_audit("/verify?noted=" + wrong).problem()["field"], "noted") << wrong;
  }
  EXPECT_EQ(get("/api/audit/verify").problem()["code"], "ROLE");
}

}  // namespace
}  // namespace interlock::web
