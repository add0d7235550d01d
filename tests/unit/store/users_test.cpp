#include "store/users.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "store_fixture.hpp"

namespace interlock {
namespace {

using Kind = StoreError::Kind;

class UsersTest : public StoreTest {
 protected:
  Stored<User> add(const std::string& name, Role role = Role::admin) {
    return store_.transact([&](Transaction& transaction) -> Stored<User> {
      return Users(transaction).add(name, role, some_hash, noon);
    });
  }

  Stored<User> change(const std::string& name, const UserChange& change) {
    return store_.transact(
        [&](Transaction& transaction) -> Stored<User> { return Users(transaction).change(name, change); });
  }

  std::vector<User> list() {
    return seen(store_, [](Transaction& transaction) { return Users(transaction).list(); });
  }

  Store store_ = open();
};

TEST_F(UsersTest, AddedUserIsThereAndEnabled) {
  const auto ann = add("ann");
  ASSERT_TRUE(ann);
  EXPECT_EQ(*ann, (User{"ann", Role::admin, true, noon, std::nullopt}));
  EXPECT_EQ(list(), std::vector<User>{*ann});
  EXPECT_EQ(to_json(*ann), nlohmann::json::parse(R"({"name": "ann", "role": "admin", "enabled": true,
      "created": "2024-05-01T12:00:00.000Z", "last_login": null})"));
}

TEST_F(UsersTest, NamesFollowTheRule) {
  ASSERT_TRUE(add("admin"));
  for (const std::string& name : {std::string("a"), std::string("a.b_c-9"), std::string(32, 'a')}) {
    EXPECT_TRUE(add(name)) << name;
  }
  const auto before = list();
  for (const std::string& name : {std::string(), std::string("Ann"), std::string("9a"), std::string(".a"),
                                  std::string("a b"), std::string(33, 'a'), std::string("a\n"),
                                  std::string("\xc3\xbc"), std::string("a;--"), std::string("a\0b", 3)}) {
    const auto refused = add(name);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().kind, Kind::invalid);
    EXPECT_EQ(refused.error().field, "name");
  }
  EXPECT_EQ(list(), before);
}

TEST_F(UsersTest, ActorsOfTheAuditAreNoNamesOfUsers) {
  ASSERT_TRUE(add("admin"));
  for (const char* const name :
       {audit_actor::kernel, audit_actor::app, audit_actor::nobody, audit_actor::command_line}) {
    EXPECT_EQ(add(name).error().kind, Kind::invalid) << name;
  }
}

TEST_F(UsersTest, NameIsTakenOnce) {
  ASSERT_TRUE(add("ann"));
  const auto again = add("ann", Role::viewer);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, Kind::exists);
  EXPECT_EQ(list().front().role, Role::admin);
}

TEST_F(UsersTest, FirstUserIsAnAdministrator) {
  const auto refused = add("ann", Role::engineer);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, Kind::last_admin);
  EXPECT_TRUE(list().empty());
}

TEST_F(UsersTest, ChangeLeavesWhatItLeavesOut) {
  ASSERT_TRUE(add("admin"));
  ASSERT_TRUE(add("ann", Role::viewer));
  ASSERT_TRUE(change("ann", {.role = Role::engineer, .password = {}, .enabled = {}}));
  const auto ann = change("ann", {.role = {}, .password = PasswordHash("new"), .enabled = false});
  EXPECT_EQ(*ann, (User{"ann", Role::engineer, false, noon, std::nullopt}));
  EXPECT_EQ(seen(store_, [](Transaction& transaction) { return Users(transaction).password_of("ann"); }),
            PasswordHash("new"));
  EXPECT_EQ(seen(store_, [](Transaction& transaction) { return Users(transaction).password_of("admin"); }),
            some_hash);
}

TEST_F(UsersTest, UnknownUserCannotBeChanged) {
  const auto refused = change("ann", {.role = Role::admin, .password = {}, .enabled = {}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, Kind::not_found);
}

TEST_F(UsersTest, LastEnabledAdministratorStays) {
  ASSERT_TRUE(add("ann"));
  ASSERT_TRUE(add("bob"));
  ASSERT_TRUE(change("bob", {.role = {}, .password = {}, .enabled = false}));
  const auto before = list();
  for (const UserChange& taking : {UserChange{.role = Role::engineer, .password = {}, .enabled = {}},
                                   UserChange{.role = {}, .password = {}, .enabled = false}}) {
    const auto refused = change("ann", taking);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, Kind::last_admin);
  }
  EXPECT_EQ(list(), before);
  ASSERT_TRUE(change("bob", {.role = {}, .password = {}, .enabled = true}));
  EXPECT_TRUE(change("ann", {.role = {}, .password = {}, .enabled = false}));
}

class Login : public UsersTest {
 protected:
  Login() {
    const auto hash = PasswordHash::of_new(Password("correct horse"), "ann").value();
    commit(store_, [&](Transaction& transaction) {
      static_cast<void>(Users(transaction).add("admin", Role::admin, some_hash, noon).value());
      static_cast<void>(Users(transaction).add("ann", Role::viewer, hash, noon).value());
    });
  }

  bool may_log_in(const std::string& name, std::string password) {
    return authenticate(store_, name, Password(std::move(password))).value().has_value();
  }
};

TEST_F(Login, NeedsNameAndPassword) {
  EXPECT_TRUE(may_log_in("ann", "correct horse"));
  EXPECT_FALSE(may_log_in("ann", "correct hors"));
  EXPECT_FALSE(may_log_in("bob", "correct horse"));
  EXPECT_FALSE(may_log_in("", ""));
}

TEST_F(Login, NeedsAnEnabledUser) {
  ASSERT_TRUE(change("ann", {.role = {}, .password = {}, .enabled = false}));
  EXPECT_FALSE(may_log_in("ann", "correct horse"));
}

TEST_F(Login, NameThatIsNobodysCostsAsMuchAsAWrongPassword) {
  const auto hash =
      seen(store_, [](Transaction& transaction) { return Users(transaction).password_of("bob"); });
  EXPECT_THAT(hash.text(), testing::StartsWith("$argon2id$v=19$m=65536,t=2,p=1$"));
}

TEST_F(Login, IsNotedOnTheUser) {
  const auto login = authenticate(store_, "ann", Password("correct horse")).value().value();
  commit(store_, [&](Transaction& transaction) {
    EXPECT_EQ(Users(transaction).note_login(login, noon + std::chrono::hours(1))->last_login,
              noon + std::chrono::hours(1));
  });
}

TEST_F(Login, PasswordThatChangedMeanwhileIsNoLogin) {
  const auto login = authenticate(store_, "ann", Password("correct horse")).value().value();
  ASSERT_TRUE(change("ann", {.role = {}, .password = some_hash, .enabled = {}}));
  const auto noted = store_.transact(
      [&](Transaction& transaction) -> Stored<User> { return Users(transaction).note_login(login, noon); });
  ASSERT_FALSE(noted);
  EXPECT_EQ(noted.error().kind, Kind::outdated);
}

}  // namespace
}  // namespace interlock
