"""`interlock user`, `interlock store` and `interlock audit` on the real program."""

import hashlib
import json
import os
import pty
import re
import select
import signal
import sqlite3
import subprocess
import termios
from pathlib import Path

import pytest
from bare_kernel import BIN, DEADLINE_S
from conftest import StackFactory
from test_run import DONE, PRECONDITION, REFUSED, USAGE

PASSWORD = "correct horse"
OTHER_PASSWORD = "battery staple"


def interlock(*arguments: str | Path, stdin: str = "") -> subprocess.CompletedProcess:
    command = [str(part) for part in (BIN / "interlock", *arguments)]
    return subprocess.run(
        command, input=stdin, capture_output=True, text=True, timeout=DEADLINE_S, start_new_session=True
    )


class Store:
    """The store in one state directory, by the command line."""

    def __init__(self, state: Path) -> None:
        self.state = state
        self.file = state / "interlock.db"

    def __call__(self, *arguments: str | Path, stdin: str = "") -> subprocess.CompletedProcess:
        return interlock(*arguments, "--state", self.state, stdin=stdin)

    def add(self, name: str, role: str = "admin", password: str = PASSWORD) -> subprocess.CompletedProcess:
        return self("user", "add", name, "--role", role, "--password-stdin", stdin=password + "\n")

    def users(self) -> dict[str, dict]:
        return {user["name"]: user for user in json.loads(self("user", "list", "--json").stdout)}

    def audit(self) -> list[dict]:
        return json.loads(self("audit", "list", "--json", "-n", "1000").stdout)

    def head(self) -> str:
        return self("audit", "verify").stdout.split()[-1]

    def execute(self, sql: str) -> None:
        with sqlite3.connect(self.file) as database:
            database.executescript(sql)


@pytest.fixture
def store(tmp_path: Path) -> Store:
    made = Store(tmp_path / "state")
    assert made.add("ann").returncode == DONE
    return made


def test_user_add_adds_a_user_and_records_it(store: Store) -> None:
    added = store.add("bob", "engineer")
    assert (added.returncode, added.stdout) == (DONE, "added bob, engineer\n")
    assert {name: user["role"] for name, user in store.users().items()} == {"ann": "admin", "bob": "engineer"}
    record = store.audit()[-1]
    assert record["actor"] == "command line"
    assert record["kind"] == "user"
    assert record["detail"].pop("digest")
    assert record["detail"].pop("os_user").endswith(f"({os.getuid()})")
    assert record["detail"] == {"action": "add", "name": "bob", "role": "engineer"}


@pytest.mark.parametrize(
    ("name", "role", "password", "expected"),
    [
        ("Bob", "viewer", PASSWORD, "'Bob' is no name of a user; expected a lower-case letter"),
        ("ann", "viewer", PASSWORD, "there is a user 'ann' already"),
        ("bob", "viewer", "short", "expected 10 to 128 characters"),
        ("bob", "viewer", "x" * 129, "expected 10 to 128 characters"),
        ("maximiliane", "viewer", "maximiliane", "the password is easy to guess"),
        ("nobody", "viewer", PASSWORD, "means something else in the audit"),
    ],
)
def test_refused_user_changes_nothing(
    store: Store, name: str, role: str, password: str, expected: str
) -> None:
    before = store.audit(), store.users()
    added = store.add(name, role, password)
    assert added.returncode == REFUSED
    assert expected in added.stderr
    assert (store.audit(), store.users()) == before


def test_first_user_must_be_an_administrator(tmp_path: Path) -> None:
    store = Store(tmp_path / "state")
    added = store.add("ann", "viewer")
    assert added.returncode == REFUSED
    assert "expected admin" in added.stderr
    assert store.users() == {}


def test_role_that_is_none_is_a_usage_error(store: Store) -> None:
    assert store.add("bob", "king").returncode == USAGE


def test_missing_password_changes_nothing(store: Store) -> None:
    added = store("user", "add", "bob", "--role", "viewer", "--password-stdin")
    assert added.returncode == PRECONDITION
    assert "no password was given" in added.stderr
    assert list(store.users()) == ["ann"]


def test_without_terminal_the_way_to_give_a_password_is_named(store: Store) -> None:
    added = store("user", "add", "bob", "--role", "viewer")
    assert added.returncode == PRECONDITION
    assert "--password-stdin" in added.stderr


def test_passwd_of_nobody_is_refused(store: Store) -> None:
    changed = store("user", "passwd", "bob", "--password-stdin", stdin=PASSWORD)
    assert changed.returncode == REFUSED
    assert "there is no user 'bob'" in changed.stderr


def test_passwd_ends_the_users_sessions(store: Store) -> None:
    store.add("bob", "viewer")
    time = "2024-05-01T12:00:00.000Z"
    store.execute(
        "INSERT INTO sessions (user, token_hash, created, last_seen) VALUES "
        f"('ann', 'a', '{time}', '{time}'), ('ann', 'b', '{time}', '{time}'),"
        f"('bob', 'c', '{time}', '{time}')"
    )
    changed = store("user", "passwd", "ann", "--password-stdin", stdin=OTHER_PASSWORD)
    assert (changed.returncode, changed.stdout) == (
        DONE,
        "changed the password of ann; sessions ended: 2\n",
    )
    with sqlite3.connect(store.file) as database:
        assert database.execute("SELECT user FROM sessions").fetchall() == [("bob",)]
    assert [record["kind"] for record in store.audit()[-3:]] == ["user", "session_ended", "session_ended"]


def test_no_password_is_in_the_state_directory(store: Store) -> None:
    store("user", "passwd", "ann", "--password-stdin", stdin=OTHER_PASSWORD)
    for file in store.state.iterdir():
        contents = file.read_bytes()
        assert PASSWORD.encode() not in contents
        assert OTHER_PASSWORD.encode() not in contents


def test_state_is_private(store: Store) -> None:
    assert store.state.stat().st_mode & 0o777 == 0o700
    assert {file.stat().st_mode & 0o777 for file in store.state.iterdir()} == {0o600}


def test_looking_at_a_store_does_not_make_one(tmp_path: Path) -> None:
    for command in (
        ("user", "list"),
        ("audit", "verify"),
        ("audit", "list"),
        ("store", "backup", tmp_path / "b"),
    ):
        looked = Store(tmp_path / "state")(*command)
        assert looked.returncode != DONE
        assert "there is no store" in looked.stderr
    assert list(tmp_path.iterdir()) == []


def test_robot_chooses_the_same_state_as_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    added = interlock(
        "user", "add", "ann", "--role", "admin", "--robot", "neuro", "--password-stdin", stdin=PASSWORD
    )
    assert added.returncode == DONE
    assert (tmp_path / "interlock/neuro/interlock.db").exists()


class Terminal:
    """A command at a terminal of its own."""

    def __init__(self, *arguments: str | Path) -> None:
        self.pid, self.file = pty.fork()
        if self.pid == 0:
            os.execv(BIN / "interlock", [str(part) for part in (BIN / "interlock", *arguments)])
        self.text = ""

    def wait_for(self, text: str) -> None:
        while text not in self.text:
            assert select.select([self.file], [], [], DEADLINE_S)[0], self.text
            self.text += os.read(self.file, 4096).decode()

    def echoes(self) -> bool:
        return bool(termios.tcgetattr(self.file)[3] & termios.ECHO)

    def answer(self, prompt: str, line: str) -> None:
        self.wait_for(prompt)
        assert not self.echoes()
        os.write(self.file, line.encode() + b"\n")

    def end(self) -> int:
        while True:
            try:
                chunk = os.read(self.file, 4096)
            except OSError:
                break
            if not chunk:
                break
            self.text += chunk.decode()
        _, status = os.waitpid(self.pid, 0)
        os.close(self.file)
        return os.waitstatus_to_exitcode(status)


@pytest.fixture
def at_terminal(store: Store) -> Terminal:
    return Terminal("user", "add", "bob", "--role", "viewer", "--state", store.state)


def test_terminal_asks_twice_and_shows_no_password(store: Store, at_terminal: Terminal) -> None:
    at_terminal.answer("New password of bob: ", PASSWORD)
    at_terminal.answer("Once more: ", PASSWORD)
    assert at_terminal.end() == DONE
    assert PASSWORD not in at_terminal.text
    assert "bob" in store.users()


def test_two_different_answers_change_nothing(store: Store, at_terminal: Terminal) -> None:
    at_terminal.answer("New password of bob: ", PASSWORD)
    at_terminal.answer("Once more: ", OTHER_PASSWORD)
    assert at_terminal.end() == REFUSED
    assert "the two passwords differ" in at_terminal.text
    assert "bob" not in store.users()


def test_interrupted_question_changes_nothing_and_leaves_the_echo_on(
    store: Store, at_terminal: Terminal
) -> None:
    at_terminal.wait_for("New password of bob: ")
    assert not at_terminal.echoes()
    os.kill(at_terminal.pid, signal.SIGINT)
    at_terminal.wait_for("interrupted; nothing was changed")
    assert at_terminal.echoes()
    assert at_terminal.end() == PRECONDITION
    assert "bob" not in store.users()


def test_an_interruption_before_the_question_is_not_lost(store: Store, at_terminal: Terminal) -> None:
    while at_terminal.echoes():
        assert os.waitpid(at_terminal.pid, os.WNOHANG) == (0, 0)
    os.kill(at_terminal.pid, signal.SIGINT)
    at_terminal.wait_for("interrupted; nothing was changed")
    assert at_terminal.end() == PRECONDITION
    assert "bob" not in store.users()


def canonical(record: dict, previous: str, detail: str) -> bytes:
    """The encoding as docs/store.md describes it, written anew."""
    fields = [
        "interlock-audit-1",
        previous,
        str(record["number"]),
        record["time"],
        "" if record["tick"] is None else str(record["tick"]),
        record["actor"],
        "" if record["session"] is None else str(record["session"]),
        record["kind"],
        detail,
    ]
    return b"".join(b"%d:%s," % (len(field.encode()), field.encode()) for field in fields)


def test_chain_is_as_documented(store: Store) -> None:
    store.add("bob", "viewer")
    previous = "0" * 64
    with sqlite3.connect(store.file) as database:
        details = dict(database.execute("SELECT number, detail FROM audit"))
    for record in store.audit():
        encoded = canonical(record, previous, details[record["number"]])
        assert record["hash"] == hashlib.sha256(encoded).hexdigest()
        previous = record["hash"]
    assert store.head() == previous


def test_audit_list_shows_as_many_as_asked_for(store: Store) -> None:
    store.add("bob", "viewer")
    store.add("eve", "viewer")
    listed = store("audit", "list", "-n", "2").stdout.splitlines()
    assert [line.split()[0] for line in listed] == ["2", "3"]


@pytest.mark.parametrize(
    ("forgery", "number"),
    [
        ("""UPDATE audit SET detail = replace(detail, 'viewer', 'admin') WHERE number = 2""", 2),
        ("DELETE FROM audit WHERE number = 2", 2),
        (
            "UPDATE audit SET number = 9 WHERE number = 2; UPDATE audit SET number = 2 WHERE number = 3;"
            "UPDATE audit SET number = 3 WHERE number = 9",
            2,
        ),
    ],
    ids=["changed", "removed", "swapped"],
)
def test_forged_record_is_found(store: Store, forgery: str, number: int) -> None:
    store.add("bob", "viewer")
    store.add("eve", "viewer")
    store.execute(
        "DROP TRIGGER audit_is_not_changed; DROP TRIGGER audit_is_not_removed;"
        f"DROP TRIGGER audit_has_no_gaps; {forgery}"
    )
    verified = store("audit", "verify")
    assert verified.returncode == REFUSED
    assert f"the audit is not sound: record {number} " in verified.stderr
    assert verified.stdout == ""


def test_records_cut_off_show_against_a_noted_head(store: Store) -> None:
    store.add("bob", "viewer")
    noted = store.head()
    store.add("eve", "viewer")
    assert store("audit", "verify", "--expect", noted).returncode == DONE
    with sqlite3.connect(store.file) as database:
        (trigger,) = database.execute(
            "SELECT sql FROM sqlite_schema WHERE name = 'audit_is_not_removed'"
        ).fetchone()
    store.execute(
        "DROP TRIGGER audit_is_not_removed; DELETE FROM audit WHERE number >= 2;"
        f"DELETE FROM users WHERE name != 'ann'; {trigger}"
    )
    assert store("audit", "verify").returncode == DONE
    verified = store("audit", "verify", "--expect", noted)
    assert verified.returncode == REFUSED
    assert noted in verified.stderr
    for no_hash in ("beef", 64 * "0"):
        assert store("audit", "verify", "--expect", no_hash).returncode == USAGE


def test_backup_and_restore_bring_back_what_was(store: Store, tmp_path: Path) -> None:
    head = store.head()
    backup = tmp_path / "backup.db"
    saved = store("store", "backup", backup)
    assert (saved.returncode, saved.stdout) == (
        DONE,
        f"{backup}: 1 users, 1 audit records, head {head}\n",
    )
    assert store("store", "backup", backup).returncode == REFUSED
    store.add("bob", "viewer")
    lost = store.head()
    restored = store("store", "restore", backup)
    assert restored.returncode == DONE
    assert list(store.users()) == ["ann"]
    record = store.audit()[-1]
    assert record["kind"] == "restore"
    assert record["detail"]["backup_head"]["hash"] == head
    assert record["detail"]["replaced_head"]["hash"] == lost
    kept = re.search(r"what was there before is (.*)\n", restored.stdout)
    assert kept
    assert sqlite3.connect(kept[1]).execute("SELECT count(*) FROM users").fetchone() == (2,)
    assert store("audit", "verify", "--expect", lost).returncode == REFUSED


@pytest.mark.parametrize("contents", [b"", b"x" * 8192, b"SQLite format 3\0" + b"x" * 8192])
def test_restore_of_something_else_changes_nothing(store: Store, tmp_path: Path, contents: bytes) -> None:
    other = tmp_path / "other.db"
    other.write_bytes(contents)
    before = store.file.read_bytes()
    restored = store("store", "restore", other)
    assert restored.returncode == REFUSED
    assert "choose another backup" in restored.stderr
    assert store.file.read_bytes() == before
    assert {file.name for file in store.state.iterdir()} == {"interlock.db", "interlock.db.lock", "lock"}


def test_newer_store_is_refused_by_every_command(store: Store, tmp_path: Path) -> None:
    store.execute("PRAGMA user_version = 99")
    for command in (("user", "list"), ("audit", "verify"), ("store", "backup", tmp_path / "b")):
        refused = store(*command)
        assert refused.returncode == PRECONDITION
        assert "has schema 99" in refused.stderr
        assert "install the release that wrote it" in refused.stderr


def test_restore_is_refused_while_the_robot_runs(stack: StackFactory, store: Store, tmp_path: Path) -> None:
    backup = tmp_path / "backup.db"
    assert store("store", "backup", backup).returncode == DONE
    running = stack()
    restored = Store(running.state)("store", "restore", backup)
    assert restored.returncode == PRECONDITION
    assert "another instance uses the state directory" in restored.stderr


def test_users_and_backups_are_made_while_the_robot_runs(stack: StackFactory, tmp_path: Path) -> None:
    running = Store(stack().state)
    assert running.add("ann").returncode == DONE
    assert running("store", "backup", tmp_path / "backup.db").returncode == DONE
    assert running("audit", "verify").returncode == DONE


def test_export_of_the_audit_verifies_without_the_store(store: Store, tmp_path: Path) -> None:
    store.add("ann")
    file = tmp_path / "audit.jsonl"
    assert store("audit", "export", file).returncode == 0
    verified = interlock("audit", "verify", "--file", file, "--expect", store.head())
    assert verified.returncode == 0, verified.stderr
    assert verified.stdout.split()[-1] == store.head()
    file.write_text(file.read_text().replace("ann", "eve"))
    broken = interlock("audit", "verify", "--file", file)
    assert broken.returncode == 1
    assert "the audit is not sound: record 1" in broken.stderr


def test_a_listing_of_the_audit_shows_what_could_mislead_a_reader_as_escapes(store: Store) -> None:
    misleading = "\u202e\u2066\u200f\u2028\u009b31m\x7f"
    detail = '{"name": "' + misleading + ' ü"}'
    store.execute(
        "INSERT INTO audit (number, time, actor, kind, detail, hash) "
        f"SELECT max(number) + 1, '2026-01-01T00:00:00.000Z', 'a\n9 forged', 'user', '{detail}', '' "
        "FROM audit"
    )
    line = store("audit", "list", "-n", "1").stdout
    shown = '{"name": "\\u202e\\u2066\\u200f\\u2028\\u009b31m\\x7f ü"}'
    assert line.endswith(f" 2026-01-01T00:00:00.000Z a\\x0a9 forged user {shown}\n"), line
    as_json = store("audit", "list", "--json", "-n", "1").stdout
    assert not set(misleading) & set(as_json) - set("31m")
    assert json.loads(as_json)[-1]["detail"]["name"] == f"{misleading} ü"


@pytest.mark.parametrize("easy", ["aaaaaaaaaa", "1234567890", "qwertyuiop", "password12", "bobbobbobbob"])
def test_a_password_that_is_easy_to_guess_is_refused_in_words(store: Store, easy: str) -> None:
    added = store.add("bob", "viewer", easy)
    assert added.returncode == REFUSED
    assert "the password is easy to guess" in added.stderr
    assert set(store.users()) == {"ann"}


def test_retired_records_and_the_rest_make_one_chain(store: Store, tmp_path: Path) -> None:
    store.add("ann")
    store.add("bob", role="viewer")
    before, noted = store.audit(), store.head()
    file = tmp_path / "old.jsonl"
    assert "no record is older" in store("audit", "retire", "--keep-days", "1", file).stdout
    done = store("audit", "retire", "--keep-days", "0", file)
    assert done.returncode == 0, done.stderr
    (left,) = store.audit()
    assert left["kind"] == "retention"
    assert set(left["detail"].pop("users")) == {"ann", "bob"}
    assert left["detail"].pop("os_user")
    assert left["detail"] == {"file": "old.jsonl", "hash": noted, "removed_to": before[-1]["number"]}
    assert store("audit", "verify", "--expect", noted).returncode == 0
    assert interlock("audit", "verify", "--file", file).stdout.split()[-1] == noted
    assert store("audit", "retire", "--keep-days", "0", file).returncode == 1
    store.execute("DROP TRIGGER audit_anchor_is_not_removed; DELETE FROM audit_anchor")
    assert store("audit", "verify").returncode == 1
