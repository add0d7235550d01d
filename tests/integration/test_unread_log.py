"""Nobody reads what the programs print: the app goes on all the same."""

import os
import subprocess
from pathlib import Path

import httpx
from bare_kernel import BIN, DEADLINE_S

# Twice what the pipes of app and supervisor hold together.
UNREAD_BYTES = 2 * 2 * 65536


def test_STOP_is_answered_while_nobody_reads_the_output(short_tmp_path: Path) -> None:
    command = [BIN / "interlock", "run", "--port", "0", "--state", short_tmp_path / "state", "--clock", "sim"]
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(short_tmp_path)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as run:
        try:
            assert run.stdout is not None
            password, url = "", ""
            while not url:
                match run.stdout.readline().split():
                    case ["first", "login:", "admin", password]:
                        pass
                    case ["ready", url]:
                        pass
            with httpx.Client(base_url=url, timeout=DEADLINE_S) as client:
                client.post("/api/login", json={"name": "admin", "password": password}).raise_for_status()
                client.put("/api/logs", json={"level": "debug"}).raise_for_status()
                logged = 0
                while logged < UNREAD_BYTES:
                    place = f"/api/motors/{'x' * 2000}{logged}"
                    assert client.get(place).status_code == 404
                    logged += len(place)
                assert client.post("/api/stop").status_code == 200
        finally:
            run.kill()
