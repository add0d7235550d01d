"""A store that is lost, damaged or changed past Interlock: no start takes it for a first one, and the heads
that the recorder noted show what is missing."""

import contextlib
import hashlib
import json
import os
import re
import shutil
import sqlite3
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bare_kernel import BIN
from stack import Output, Stack, start_interlock
from test_run import DONE, PRECONDITION, PROCESS_ENDED, REFUSED
from test_store_cli import Store

UNGUARDED = (
    "DROP TRIGGER audit_is_not_changed; DROP TRIGGER audit_is_not_removed; DROP TRIGGER audit_has_no_gaps;"
)


class Installation:
    """One robot that is started again and again."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.store = Store(directory / "state")
        self.heads = directory / "state/recordings/audit-heads"

    @contextlib.contextmanager
    def run(self, *arguments: str) -> Iterator[Stack]:
        robot = Stack(self.directory, "--robot", "neuro", "--clock", "sim", *arguments)
        try:
            yield robot
        finally:
            robot.close()

    def refused_start(self) -> str:
        """What a start says that is refused."""
        run = start_interlock(
            self.directory / "run", "run", "--robot", "neuro", "--port", "0", "--state", self.store.state
        )
        output = Output(run)
        output.wait_for_end()
        assert run.wait() == PROCESS_ENDED
        assert "store restore" in output.text
        assert "--new-store" in output.text
        assert "first login" not in output.text
        return output.text

    def delete(self) -> None:
        for file in self.store.state.glob("interlock.db*"):
            file.unlink()

    def verify(self) -> subprocess.CompletedProcess:
        return self.store("audit", "verify")


@pytest.fixture
def installation(short_tmp_path: Path) -> Installation:
    """It has run once, with a user besides the administrator."""
    made = Installation(short_tmp_path)
    with made.run() as robot:
        robot.client_of_new("bob", "engineer")
    return made


def test_a_missing_or_emptied_store_stops_the_start_until_somebody_chooses(
    installation: Installation,
) -> None:
    backup = installation.directory / "backup.db"
    assert installation.store("store", "backup", backup).returncode == DONE
    installation.delete()
    assert "interlock.db is missing" in installation.refused_start()
    assert not installation.store.file.exists()
    added = installation.store.add("eve")
    assert added.returncode == REFUSED
    assert "--new-store" in added.stderr
    installation.store.file.touch(0o600)
    assert "interlock.db is empty" in installation.refused_start()
    assert installation.store("store", "restore", backup).returncode == DONE
    with installation.run() as robot:
        assert {user["name"] for user in robot.api.get("/api/users").json()} == {"admin", "bob"}
    assert installation.verify().returncode == DONE, (
        "the restore accounts for the heads that were noted before"
    )


def test_a_damaged_store_stops_the_start_and_a_new_one_keeps_it(installation: Installation) -> None:
    contents = b"x" * 16384
    installation.delete()
    installation.store.file.write_bytes(contents)
    assert "file is not a database" in installation.refused_start()
    assert installation.store.file.read_bytes() == contents
    (installation.directory / "password").unlink()
    with installation.run("--new-store") as robot:
        assert [user["name"] for user in robot.api.get("/api/users").json()] == ["admin"]
        robot.client_of_new("eve", "viewer")
    (kept,) = installation.store.state.glob("interlock.db.replaced-*")
    assert kept.read_bytes() == contents
    first = installation.store.audit()[0]
    assert (first["kind"], first["actor"], first["detail"]["action"]) == (
        "restore",
        "command line",
        "new store",
    )
    with installation.run("--new-store") as robot:
        users = {user["name"] for user in robot.api.get("/api/users").json()}
        assert users == {"admin", "eve"}, "a sound store is not replaced"


def test_the_recorder_notes_the_head_and_verify_says_what_that_shows(installation: Installation) -> None:
    verified = installation.verify()
    assert verified.returncode == DONE, verified.stderr
    number, head = installation.heads.read_text().split()[-2:]
    assert installation.store.head() == head
    assert f"up to record {number} that the recorder noted in {installation.heads}" in verified.stdout
    assert "which the store's owner can change, too" in verified.stdout
    installation.heads.unlink()
    assert "records cut off or written anew do not show" in installation.verify().stdout


def test_records_cut_off_and_an_older_copy_are_named_and_stop_the_start(installation: Installation) -> None:
    older = installation.directory / "older.db"
    shutil.copy(installation.store.file, older)
    with installation.run() as robot:
        robot.client_of_new("eve", "viewer")
    number = int(installation.heads.read_text().split()[-2])
    installation.store.execute(UNGUARDED + f"DELETE FROM audit WHERE number >= {number - 1}")
    cut = installation.verify()
    assert cut.returncode == REFUSED
    assert re.search(rf"record {number} is missing: .* the recorder noted it at", cut.stderr), cut.stderr
    installation.delete()
    shutil.copy(older, installation.store.file)
    assert "an older copy of the store was put in place" in installation.verify().stderr
    assert "an older copy of the store was put in place" in installation.refused_start()


def test_a_role_that_was_changed_in_SQL_is_named_and_stops_the_start(installation: Installation) -> None:
    installation.store.execute("UPDATE users SET role = 'admin' WHERE name = 'bob'")
    verified = installation.verify()
    assert verified.returncode == REFUSED
    assert "user bob has another role" in verified.stderr
    assert "user bob has another role" in installation.refused_start()


@pytest.mark.parametrize(
    ("sql", "problem"),
    [
        ("DROP TABLE sessions", "table sessions is missing"),
        ("DROP TABLE settings", "table settings is missing"),
        ("DROP TABLE audit_anchor", "table audit_anchor is missing"),
        (UNGUARDED, "trigger audit_has_no_gaps is missing"),
        ("PRAGMA user_version = 0", "is not a sound store of schema 0"),
        ("PRAGMA user_version = 1", "table audit_anchor does not belong there"),
        ("PRAGMA user_version = -1", "has schema -1"),
    ],
)
def test_a_damaged_schema_stops_the_start(installation: Installation, sql: str, problem: str) -> None:
    installation.store.execute(sql)
    assert problem in installation.refused_start()
    verified = installation.verify()
    assert verified.returncode == REFUSED
    assert problem in verified.stderr


@pytest.mark.parametrize("make", [Path.mkdir, lambda path: os.mkfifo(path)])
def test_a_damaged_store_that_is_no_file_stops_the_start_and_is_replaced(
    installation: Installation, make: Callable[[Path], None]
) -> None:
    backup = installation.directory / "backup.db"
    assert installation.store("store", "backup", backup).returncode == DONE
    installation.delete()
    make(installation.store.file)
    assert "is not a regular file" in installation.refused_start()
    restored = installation.store("store", "restore", backup)
    assert restored.returncode == DONE, restored.stderr
    assert "bob" in installation.store.users()


def test_a_backup_that_the_next_start_would_refuse_is_not_restored(installation: Installation) -> None:
    backup = installation.directory / "backup.db"
    assert installation.store("store", "backup", backup).returncode == DONE
    with installation.run() as robot:
        robot.client_of_new("eve", "viewer")
    shutil.copy(backup, installation.store.file)
    before = installation.store.file.read_bytes()
    refused = installation.store("store", "restore", backup)
    assert refused.returncode == REFUSED
    assert f"a start would refuse the backup {backup}: " in refused.stderr
    assert "the recorder noted" in refused.stderr
    assert "nothing was replaced" in refused.stderr
    assert installation.store.file.read_bytes() == before
    assert not list(installation.store.state.glob("interlock.db.re*"))


def test_heads_that_a_restore_excuses_are_not_called_in_agreement(installation: Installation) -> None:
    backup = installation.directory / "backup.db"
    assert installation.store("store", "backup", backup).returncode == DONE
    with installation.run() as robot:
        robot.client_of_new("eve", "viewer")
    heads = len(installation.heads.read_text().splitlines())
    assert installation.store("store", "restore", backup).returncode == DONE
    record = installation.store.audit()[-1]
    excuse = f"excused by record {record['number']} (restore, store, {record['time']}, command line, "
    verified = installation.verify()
    assert verified.returncode == DONE, verified.stderr
    assert excuse in verified.stdout
    report = json.loads(installation.store("audit", "verify", "--json").stdout)
    noted = report["noted_heads"]
    (excused,) = noted["excused"]
    assert report["proven"]
    assert noted["noted"] > heads
    assert noted["compared"] + excused["heads"] == noted["noted"]
    assert f"in agreement with the {noted['compared']} head" in verified.stdout
    assert excused["heads"] >= 1
    assert (excused["record"], excused["kind"], excused["action"], excused["proven"]) == (
        record["number"],
        "restore",
        "store",
        True,
    )
    assert excused["os_user"] == record["detail"]["os_user"]
    with installation.run() as robot:
        check = robot.api.get("/api/audit/verify").raise_for_status().json()
    assert check["proven"]
    assert check["noted_heads"]["excused"] == [excused]
    assert excuse in check["noted_heads"]["summary"]


def test_a_restore_of_which_no_head_was_noted_is_not_proven(installation: Installation) -> None:
    """As somebody leaves it who can write the store, and not the recorder's file."""
    backup = installation.directory / "backup.db"
    assert installation.store("store", "backup", backup).returncode == DONE
    with installation.run() as robot:
        robot.client_of_new("eve", "viewer")
    noted = installation.heads.read_bytes()
    assert installation.store("store", "restore", backup).returncode == DONE
    installation.heads.write_bytes(noted)
    unproven = installation.verify()
    assert unproven.returncode == REFUSED
    assert "the audit is not proven: " in unproven.stderr
    assert "no head was noted since" in unproven.stderr


def test_the_app_compares_its_audit_with_the_noted_heads(installation: Installation) -> None:
    with installation.run() as robot:
        check = robot.api.get("/api/audit/verify").raise_for_status().json()
        heads = check["noted_heads"]
        assert (check["sound"], check["proven"], heads["file"]) == (True, True, str(installation.heads))
        assert heads["compared"] == heads["noted"] >= 1
        assert heads["excused"] == []
        number, head = 1, "0" * 64
        with installation.heads.open("a") as file:
            file.write(f"2026-01-01T00:00:00.000Z {number} {head}\n")
        check = robot.api.get("/api/audit/verify").raise_for_status().json()
    assert (check["sound"], check["proven"], check["noted_heads"]) == (False, False, None)
    assert check["broken"]["number"] == number
    problem = f"is not the one that the recorder noted at 2026-01-01T00:00:00.000Z as {head}"
    assert problem in check["broken"]["problem"]


def test_a_forged_new_store_is_not_called_in_agreement_with_any_head(installation: Installation) -> None:
    """Its only record excuses all heads."""
    with contextlib.closing(sqlite3.connect(installation.store.file)) as database:
        triggers = ";".join(
            sql for (sql,) in database.execute("SELECT sql FROM sqlite_schema WHERE type = 'trigger'")
        )
    detail = '{"action":"new store","os_user":"\\u001b[2Jroot (0)"}'
    fields = ("interlock-audit-1", "0" * 64, "1", "2026-01-01T00:00:00.000Z", "", "command line", "")
    encoded = "".join(f"{len(field)}:{field}," for field in (*fields, "restore", detail))
    forged = (fields[3], "command line", detail, hashlib.sha256(encoded.encode()).hexdigest())
    installation.store.execute(UNGUARDED + "DELETE FROM audit; DELETE FROM users WHERE name != 'admin'")
    with sqlite3.connect(installation.store.file) as database:
        database.execute("INSERT INTO audit VALUES (1, ?, NULL, ?, NULL, 'restore', ?, ?)", forged)
    heads = len(installation.heads.read_text().splitlines())
    installation.store.execute("DROP TRIGGER audit_anchor_moves_on; DROP TRIGGER audit_anchor_is_not_removed")
    installation.store.execute(triggers)
    verified = installation.store("audit", "verify", "--json")
    assert verified.returncode == REFUSED
    assert f"compared with none of the {heads} head" in verified.stderr
    assert "in agreement" not in verified.stderr
    assert "(restore, new store, 2026-01-01T00:00:00.000Z, command line, " in verified.stderr
    assert "\x1b" not in verified.stderr + verified.stdout
    report = json.loads(verified.stdout)
    assert (report["proven"], report["noted_heads"]["compared"]) == (False, 0)
    assert report["noted_heads"]["up_to"] is None


def test_a_folder_in_place_of_the_noted_heads_is_an_error_in_verify(installation: Installation) -> None:
    installation.heads.unlink()
    installation.heads.mkdir()
    verified = installation.verify()
    assert verified.returncode == PRECONDITION
    assert "is not a regular file" in verified.stderr


def test_a_damaged_hash_sends_no_control_characters_to_the_terminal(installation: Installation) -> None:
    installation.store.execute(
        UNGUARDED + "UPDATE audit SET hash = char(27) || ']0;title' || char(7) WHERE number = 2"
    )
    text = installation.refused_start()
    assert "\\x1b]0;title\\x07" in text
    assert "\x1b]0" not in text


def test_a_store_that_is_removed_under_a_running_app_refuses_changes(installation: Installation) -> None:
    user = {"name": "eve", "role": "viewer", "password": "correct horse battery"}
    with installation.run() as robot:
        hidden = installation.directory / "hidden.db"
        installation.store.file.rename(hidden)
        refused = robot.api.post("/api/users", json=user)
        assert (refused.status_code, refused.json()["code"]) == (503, "STORE")
        assert "was removed or replaced by another file" in refused.json()["detail"]
        hidden.rename(installation.store.file)
        robot.api.post("/api/users", json=user).raise_for_status()


def test_a_flood_of_STOPs_without_login_is_a_few_records_that_count_each(short_tmp_path: Path) -> None:
    installation = Installation(short_tmp_path)
    stops = 500
    with installation.run() as robot:
        visitor = robot.visitor()
        for _ in range(stops):
            visitor.post("/api/stop").raise_for_status()
    with contextlib.closing(sqlite3.connect(installation.store.file)) as database:
        found = database.execute(
            "SELECT count(*), sum(1 + coalesce(json_extract(detail, '$.unrecorded'), 0)), "
            "24 * 3600 * (julianday(max(time)) - julianday(min(time))) FROM audit WHERE kind = 'stop'"
        ).fetchone()
        verdicts = database.execute(
            "SELECT count(*) FROM audit WHERE kind = 'verdict' AND json_extract(detail, '$.request') = 'STOP'"
        ).fetchone()
    records, counted, seconds = found
    assert counted == stops
    assert records <= 3 + seconds / 5
    assert verdicts == (0,)


def test_programs_name_the_option_for_a_new_store() -> None:
    for program in (("interlock", "run"), ("interlock-app",)):
        told = subprocess.run([BIN / program[0], *program[1:], "--help"], capture_output=True, text=True)
        assert "--new-store" in told.stdout
