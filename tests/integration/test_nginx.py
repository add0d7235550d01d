"""The robot behind a real nginx with TLS, set up as docs/deployment.md says."""

import contextlib
import getpass
import re
import signal
import socket
import ssl
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest
from bare_kernel import DEADLINE_S, ROOT
from motion import wait_until
from stack import Stack
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

NAME = "robot.example"
CLIENT = "127.0.0.7"
"""Where the client connects to nginx from; nginx connects to the app from 127.0.0.1."""
MAIN = """
daemon off;
user {user};
pid {folder}/pid;
error_log {folder}/error.log;
events {{}}
http {{
    access_log off;
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
{site}}}
"""


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def documented_site(*changes: tuple[str, str]) -> str:
    """The site of the manual, with this test's ports and files."""
    [site] = re.findall(r"^```nginx\n(.*?)^```$", (ROOT / "docs/deployment.md").read_text(), re.M | re.S)
    for old, new in changes:
        assert old in site, old
        site = site.replace(old, new)
    return site


@dataclass
class Site:
    robot: Stack
    port: int
    trust: ssl.SSLContext
    client: httpx.Client

    @property
    def origin(self) -> str:
        return f"https://{NAME}:{self.port}"

    def send(self, method: str, path: str, body: object = None, origin: str = "") -> httpx.Response:
        """As a browser that was pointed to the public name does."""
        headers = {"Host": f"{NAME}:{self.port}"} | ({"Origin": origin} if origin else {})
        return self.client.request(
            method, path, json=body, headers=headers, extensions={"sni_hostname": NAME}
        )

    def stream(self, origin: str) -> ClientConnection:
        cookies = "; ".join(f"{each.name}={each.value}" for each in self.client.cookies.jar)
        plain = socket.create_connection(("127.0.0.1", self.port), DEADLINE_S, (CLIENT, 0))
        return connect(
            f"wss://{NAME}:{self.port}/api/stream",
            sock=plain,
            ssl=self.trust,
            origin=origin,
            additional_headers={"Cookie": cookies},
        )


@pytest.fixture(scope="module")
def site() -> Iterator[Site]:
    with tempfile.TemporaryDirectory(prefix="interlock-test-") as folder, site_in(Path(folder)) as started:
        yield started


@contextlib.contextmanager
def site_in(folder: Path) -> Iterator[Site]:
    key, certificate, port = folder / "key.pem", folder / "certificate.pem", free_port()
    subprocess.run(
        [
            *("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"),
            *("-subj", f"/CN={NAME}", "-addext", f"subjectAltName=DNS:{NAME}", "-days", "1"),
            *("-keyout", key, "-out", certificate),
        ],
        check=True,
        capture_output=True,
    )
    robot = Stack(
        folder / "robot",
        *("--clock", "sim", "--public-origin", f"https://{NAME}:{port}", "--trusted-proxy", "127.0.0.1"),
    )
    try:
        described = documented_site(
            ("listen 443", f"listen 127.0.0.1:{port}"),
            (f"/etc/ssl/certs/{NAME}.pem", str(certificate)),
            (f"/etc/ssl/private/{NAME}.key", str(key)),
            ("127.0.0.1:8080", f"127.0.0.1:{robot.port}"),
        )
        (folder / "nginx.conf").write_text(MAIN.format(user=getpass.getuser(), folder=folder, site=described))
        command = ["/usr/sbin/nginx", "-p", folder, "-c", folder / "nginx.conf", "-e", folder / "error.log"]
        subprocess.run([*command, "-t"], check=True, capture_output=True)
        with subprocess.Popen(command) as nginx:
            try:
                wait_until("nginx listens", lambda: is_listening(port))
                trust = ssl.create_default_context(cafile=certificate)
                transport = httpx.HTTPTransport(verify=trust, local_address=CLIENT)
                with httpx.Client(
                    base_url=f"https://127.0.0.1:{port}", transport=transport, timeout=DEADLINE_S
                ) as client:
                    yield Site(robot, port, trust, client)
            finally:
                nginx.send_signal(signal.SIGTERM)
    finally:
        robot.close()


def is_listening(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@pytest.fixture
def logged_in(site: Site) -> Site:
    site.client.cookies.clear()
    password = {"name": "admin", "password": site.robot.password}
    site.send("POST", "/api/login", password, site.origin).raise_for_status()
    return site


def test_page_login_and_STOP_get_through_and_name_the_client_behind_nginx(logged_in: Site) -> None:
    page = logged_in.send("GET", "/").raise_for_status()
    [script] = re.findall(r'src="(/assets/index-[^"]+)"', page.text)
    assert logged_in.send("GET", script).content == logged_in.robot.api.get(script).content
    assert logged_in.send("GET", "/api/session").json()["user"]["name"] == "admin"
    stopped = logged_in.send("POST", "/api/stop", origin=logged_in.origin).raise_for_status()
    assert stopped.json()["verdict"] == "ACCEPTED"

    def peers() -> set[str]:
        records = logged_in.robot.api.get("/api/audit").raise_for_status().json()
        return {each["detail"]["peer"].partition(":")[0] for each in records if each["kind"] == "stop"}

    wait_until("the STOP is recorded", lambda: peers() != set())
    assert peers() == {CLIENT}
    log = logged_in.robot.state / "log/interlock-app.log"
    came = rf"{CLIENT}:\d+: admin logged in"
    wait_until("the login is in the log", lambda: re.search(came, log.read_text()) is not None)


def test_the_cookies_of_a_login_by_nginx_stay_within_TLS(logged_in: Site) -> None:
    assert [each.secure for each in logged_in.client.cookies.jar] == [True, True]


def test_the_stream_gets_through(logged_in: Site) -> None:
    with logged_in.stream(logged_in.origin) as stream:
        assert stream.recv(DEADLINE_S)


@pytest.mark.parametrize("origin", ["https://evil.example", f"http://{NAME}", "https://127.0.0.1", "null"])
def test_a_forged_origin_is_refused(logged_in: Site, origin: str) -> None:
    for path in ("/api/stop", "/api/login", "/api/control/request"):
        refused = logged_in.send("POST", path, {}, origin)
        assert (refused.status_code, refused.json()["code"]) == (403, "ORIGIN"), path
    with pytest.raises(InvalidStatus) as answer:
        logged_in.stream(origin)
    assert answer.value.response.status_code == 403


def test_a_client_cannot_name_itself_by_a_header_of_its_own(logged_in: Site) -> None:
    headers = {"X-Forwarded-For": "10.9.9.9", "Origin": logged_in.origin}
    logged_in.client.post(
        "/api/logout", headers=headers, extensions={"sni_hostname": NAME}
    ).raise_for_status()
    guess = {"name": "nobody", "password": "a guess at it"}
    logged_in.client.post("/api/login", json=guess, headers=headers, extensions={"sni_hostname": NAME})
    log = logged_in.robot.state / "log/interlock-app.log"
    refused = rf"{CLIENT}:\d+: a login was refused"
    wait_until("the refusal is in the log", lambda: re.search(refused, log.read_text()) is not None)
    assert "10.9.9.9" not in log.read_text()


def test_what_is_no_origin_with_TLS_or_no_address_is_named(short_tmp_path: Path) -> None:
    for option, value in (("--public-origin", f"http://{NAME}"), ("--trusted-proxy", NAME)):
        with pytest.raises(AssertionError, match=f"{option} {value} is no"):
            Stack(short_tmp_path / option, option, value)
