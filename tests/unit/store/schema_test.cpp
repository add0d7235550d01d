#include "store/schema.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <array>
#include <fstream>
#include <functional>
#include <iterator>

#include "store/cases.hpp"
#include "store/settings.hpp"
#include "store/store_backup.hpp"
#include "store_fixture.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Kind = StoreError::Kind;

/** A store as the first release made it. This text is never changed. */
constexpr const char* store_of_version_1 = R"sql(
CREATE TABLE users (name TEXT PRIMARY KEY, role TEXT NOT NULL CHECK (role IN ('viewer', 'engineer', 'admin')),
  enabled INTEGER NOT NULL CHECK (enabled IN (0, 1)), password TEXT NOT NULL, created TEXT NOT NULL,
  last_login TEXT) STRICT;
CREATE TABLE sessions (number INTEGER PRIMARY KEY AUTOINCREMENT, user TEXT NOT NULL REFERENCES users (name),
  token_hash TEXT NOT NULL UNIQUE, created TEXT NOT NULL, last_seen TEXT NOT NULL) STRICT;
CREATE TABLE settings (key TEXT PRIMARY KEY, value TEXT NOT NULL, updated TEXT NOT NULL) STRICT;
CREATE TABLE audit (number INTEGER PRIMARY KEY, time TEXT NOT NULL, tick INTEGER, actor TEXT NOT NULL,
  session INTEGER, kind TEXT NOT NULL, detail TEXT NOT NULL, hash TEXT NOT NULL) STRICT;
CREATE TRIGGER audit_is_not_changed BEFORE UPDATE ON audit
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;
CREATE TRIGGER audit_is_not_removed BEFORE DELETE ON audit
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;
CREATE TRIGGER audit_has_no_gaps BEFORE INSERT ON audit
WHEN NEW.number IS NOT (SELECT coalesce(max(number), 0) + 1 FROM audit)
BEGIN SELECT RAISE(ABORT, 'the audit is only appended to'); END;
INSERT INTO users VALUES ('ann', 'admin', 1, 'hash', '2024-05-01T12:00:00.000Z', NULL);
INSERT INTO audit VALUES (1, '2024-05-01T12:00:00.000Z', NULL, 'app', NULL, 'start', '{}',
  'd5e6ac4ebbda58f52c928d420100fd3f106e5f2817b38360c230aa26e6d4d64e');
PRAGMA application_id = 0x494c4b53;
PRAGMA user_version = 1;
)sql";

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class SchemaTest : public StoreTest {
 protected:
  void migrate_to(std::span<const char* const> scripts) const {
    SQLite::Database database(file_.string(), SQLite::OPEN_READWRITE, 5000);
    database.exec("PRAGMA journal_mode = WAL");
    migrate(database, file_, scripts);
  }

  static int version_of(const fs::path& file) {
    return SQLite::Database(file.string()).execAndGet("PRAGMA user_version").getInt();
  }

  /** Opening is refused, and the file stays as it is, byte by byte. */
  void expect_refused(Kind kind, const std::string& problem) const {
    const std::string before = bytes_of(file_);
    const Stored<Store> store = Store::open(file_);
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().kind, kind);
    EXPECT_THAT(store.error().message(), HasSubstr(problem));
    EXPECT_THAT(store.error().message(), HasSubstr(file_.string()));
    EXPECT_TRUE(bytes_of(file_) == before);
    EXPECT_FALSE(fs::exists(file_.string() + ".schema-1"));
  }
};

TEST_F(SchemaTest, StoreOfTheFirstReleaseIsReadWithAllItHolds) {
  execute(store_of_version_1);
  Store store = open();
  EXPECT_EQ(seen(store, [](Transaction& transaction) { return Users(transaction).list(); }),
            (std::vector<User>{{"ann", Role::admin, true, noon, std::nullopt}}));
  EXPECT_EQ(seen(store, [](Transaction& transaction) { return Audit(transaction).verify(); })->number, 1);
}

TEST_F(SchemaTest, OlderStoreIsCopiedThenMigratedWithAllItHolds) {
  execute(store_of_version_1);
  const std::array newer{migrations()[0], "ALTER TABLE users ADD COLUMN note TEXT NOT NULL DEFAULT 'none'",
                         "UPDATE users SET note = 'migrated'"};
  migrate_to(newer);
  EXPECT_EQ(version_of(file_), 3);
  SQLite::Database migrated(file_.string());
  EXPECT_EQ(migrated.execAndGet("SELECT note FROM users WHERE name = 'ann'").getString(), "migrated");
  const fs::path copy = file_.string() + ".schema-1";
  EXPECT_EQ(version_of(copy), 1);
  SQLite::Database old(copy.string());
  EXPECT_EQ(old.execAndGet("SELECT count(*) FROM users").getInt(), 1);
  EXPECT_TRUE(check_contents(old, PageCheck::full));
  EXPECT_EQ(fs::status(copy).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(SchemaTest, WhatWasSetBeforeThereWereCasesIsInAClosedOne) {
  execute(store_of_version_1);
  execute(R"sql(INSERT INTO settings VALUES ('log_level', '"info"', '2024-05-01T12:00:00.000Z'),
    ('targeting', '{"target_point":[1.0,2.0,3.0]}', '2024-05-01T12:00:00.000Z'))sql");
  Store store = open();
  const auto cases = seen(store, [](Transaction& transaction) { return Cases(transaction).list(9); });
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].state, CaseState::closed);
  EXPECT_EQ(cases[0].value["targeting"]["target_point"], nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_TRUE(seen(store, [](Transaction& transaction) { return Settings(transaction).find("log_level"); }));
  EXPECT_FALSE(seen(store, [](Transaction& transaction) { return Settings(transaction).find("targeting"); }));
}

TEST_F(SchemaTest, RegistrationsOfBeforeStayKnown) {
  const auto pose = [](double x) { return nlohmann::json{1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; };
  {
    SQLite::Database database(file_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    migrate(database, file_, migrations().first(3));
    const nlohmann::json targeting{{"registration", pose(3)},
                                   {"registration_epoch", 7},
                                   {"registrations_before", nlohmann::json::array({pose(2)})}};
    SQLite::Statement insert(database, "INSERT INTO cases (state, value) VALUES ('closed', ?)");
    insert.bind(1, nlohmann::json{{"targeting", targeting}}.dump());
    insert.exec();
    SQLite::Statement set(database, "INSERT INTO settings VALUES ('registrations_before', ?, '')");
    set.bind(1, nlohmann::json::array({pose(1)}).dump());
    set.exec();
  }
  Store store = open();
  const auto known =
      seen(store, [](Transaction& transaction) { return Registrations(transaction).newest_first(); });
  ASSERT_EQ(known.size(), 3u);
  EXPECT_EQ(known[0].pose[3], 3.0);
  EXPECT_EQ(known[0].epoch, 7);
  EXPECT_EQ(known[0].case_number, 1);
  EXPECT_EQ(known[1].pose[3], 2.0);
  EXPECT_EQ(known[2].pose[3], 1.0);
  const auto cases = seen(store, [](Transaction& transaction) { return Cases(transaction).list(9); });
  EXPECT_FALSE(cases.at(0).value["targeting"].contains("registrations_before"));
}

TEST_F(SchemaTest, NoMoreThanOneCaseIsInHand) {
  Store store = open();
  commit(store, [](Transaction& transaction) { Cases(transaction).add(nlohmann::json::object()); });
  const auto second = store.transact([](Transaction& transaction) -> Stored<std::int64_t> {
    return Cases(transaction).add(nlohmann::json::object());
  });
  EXPECT_FALSE(second);
}

TEST_F(SchemaTest, CopyOfAnEarlierMigrationIsKept) {
  execute(store_of_version_1);
  std::ofstream(file_.string() + ".schema-1") << "earlier";
  const std::array newer{migrations()[0], "CREATE TABLE more (x) "};
  migrate_to(newer);
  EXPECT_EQ(bytes_of(file_.string() + ".schema-1"), "earlier");
  EXPECT_EQ(version_of(file_.string() + ".schema-1.2"), 1);
}

TEST_F(SchemaTest, MigrationThatFailsLeavesTheStoreAsItWas) {
  execute(store_of_version_1);
  const std::array broken{migrations()[0], "DROP TABLE sessions; UPDATE nothing SET x = 1"};
  EXPECT_THROW(migrate_to(broken), SQLite::Exception);
  EXPECT_EQ(version_of(file_), 1);
  Store store = open();
  EXPECT_EQ(seen(store, [](Transaction& transaction) { return Users(transaction).list().size(); }), 1u);
}

TEST_F(SchemaTest, CurrentStoreIsNotMigratedNorCopied) {
  {
    Store made = open();
  }
  {
    Store again = open();
  }
  EXPECT_EQ(version_of(file_), static_cast<int>(migrations().size()));
  EXPECT_FALSE(fs::exists(file_.string() + ".schema-1"));
}

TEST_F(SchemaTest, NewerStoreIsRefused) {
  execute(store_of_version_1);
  execute("PRAGMA user_version = 99");
  expect_refused(Kind::newer, "schema 99");
}

TEST_F(SchemaTest, DatabaseOfAnotherProgramIsRefused) {
  execute("CREATE TABLE bookmarks (url)");
  expect_refused(Kind::damaged, "no store of Interlock");
}

TEST_F(SchemaTest, FileThatIsNoDatabaseIsRefused) {
  std::ofstream(file_) << std::string(4096, 'x');
  expect_refused(Kind::damaged, "not a database");
}

/** The way out is the same as for other damage, and works. */
TEST_F(SchemaTest, WhatIsNoFileInPlaceOfTheStoreIsDamaged) {
  const fs::path nothing = folder_ / "nothing";
  const std::array<std::function<void()>, 3> cases{[&] { fs::create_directory(file_); },
                                                   [&] { ::mkfifo(file_.c_str(), 0600); },
                                                   [&] { fs::create_symlink(nothing, file_); }};
  UtcTime now = noon;
  for (const auto& make : cases) {
    make();
    const Stored<Store> store = Store::open(file_);
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().kind, Kind::damaged);
    EXPECT_THAT(store.error().message(),
                testing::AllOf(HasSubstr("store restore"), HasSubstr("--new-store")));
    const Stored<Store> anew = begin_new_store(file_, store.error(), now += std::chrono::seconds(1));
    ASSERT_TRUE(anew) << anew.error().message();
    fs::remove(file_);
  }
  EXPECT_FALSE(fs::exists(nothing));
}

TEST_F(SchemaTest, TablesThatAreNotThoseOfTheVersionAreRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"DROP TABLE sessions", "table sessions is missing"},
      {"DROP TABLE settings", "table settings is missing"},
      {"DROP TABLE audit_anchor", "table audit_anchor is missing"},
      {"CREATE TABLE more (x)", "table more does not belong there"},
      {"ALTER TABLE users ADD COLUMN note TEXT", "table users was changed"},
      {"PRAGMA user_version = 1", "table audit_anchor does not belong there"},
      {"PRAGMA user_version = 0", "schema 0: table audit does not belong there"},
      {"PRAGMA user_version = -1", "schema -1"}};
  for (const auto& [sql, problem] : cases) {
    {
      const Store made = open();
    }
    execute(std::string("PRAGMA journal_mode = DELETE; ") + sql);
    expect_refused(Kind::damaged, problem);
    expect_refused(Kind::damaged, "--new-store");
    fs::remove(file_);
  }
}

TEST_F(SchemaTest, TriggersAndIndexesThatAreNotThoseOfTheVersionAreFoundByTheCheck) {
  const std::pair<const char*, const char*> cases[] = {
      {"DROP TRIGGER audit_is_not_removed", "trigger audit_is_not_removed is missing"},
      {"DROP TRIGGER audit_is_not_changed; CREATE TRIGGER audit_is_not_changed BEFORE UPDATE ON audit "
       "BEGIN SELECT 1; END",
       "trigger audit_is_not_changed was changed"},
      {"CREATE TRIGGER \"evil\x1b[2J\" AFTER INSERT ON audit BEGIN SELECT 1; END",
       "trigger evil\\x1b[2J does not belong there"},
      {"CREATE INDEX more ON users (role)", "index more does not belong there"}};
  for (const auto& [sql, problem] : cases) {
    Store store = open();
    execute("ANALYZE");
    ASSERT_TRUE(store.check({}));
    execute(sql);
    const Stored<void> checked = store.check({});
    ASSERT_FALSE(checked) << sql;
    EXPECT_EQ(checked.error().kind, Kind::damaged);
    EXPECT_THAT(checked.error().message(), testing::AllOf(HasSubstr(problem), HasSubstr("--new-store")));
    fs::remove(file_);
    fs::remove(file_.string() + "-wal");
    fs::remove(file_.string() + "-shm");
  }
}

TEST_F(SchemaTest, ControlCharactersFromADamagedAuditAreEscaped) {
  Store store = open();
  commit(store, [](Transaction& transaction) { Audit(transaction).append({}); });
  execute("DROP TRIGGER audit_is_not_changed; UPDATE audit SET hash = char(27) || ']0;title' || char(7)");
  const Stored<void> checked = store.check({});
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message(), HasSubstr("its hash is \\x1b]0;title\\x07"));
}

}  // namespace
}  // namespace interlock
