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

TEST_F(AuditRoutesTest, OnlyAdministratorsReadIt) { EXPECT_EQ(get("/api/audit").problem()["code"], "ROLE"); }

TEST_F(AuditRoutesTest, AWrongParameterIsNamedAndAnUnknownOneIgnored) {
  const std::pair<std::string, std::string> cases[] = {{"records=0", "records"},
                                                       {"records=1001", "records"},
                                                       {"records=all", "records"},
                                                       {"before=0", "before"},
                                                       {"before=-1", "before"}};
  for (const auto& [query, field] : cases) {
    const Answered answered = read_audit("?" + query);
    EXPECT_EQ(answered.status, 422u) << query;
    EXPECT_EQ(answered.problem()["field"], field) << query;
  }
  EXPECT_EQ(read_audit("?colour=red").status, 200u);
}

}  // namespace
}  // namespace interlock::web
