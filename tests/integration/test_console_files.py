"""What the console costs on the wire, and how its files are kept by browsers: by the real app and build."""

import http.client
import re
from urllib.parse import urljoin

import httpx
import pytest
from stack import Stack

LIMIT_BYTES = 250_000
# As Chromium has it for a page of this machine.
BROWSER = {"Accept-Encoding": "gzip, deflate, br, zstd", "Host": "localhost"}
# What a file makes a browser load at once: no `import(...)`, which waits for the first look at a page.
LOADED = {
    "text/html": (r"<(?:script|link)\b[^>]*?\b(?:src|href)=\"([^\"]+)\"",),
    "text/css": (r"\burl\([\"']?([^\"')]+)", r"@import\s*[\"']([^\"']+)"),
    "text/javascript": (
        r"\b(?:import|from)\s*[\"']([^\"']+)[\"']",
        r"[\"'`](/assets/[^\"'`]+\.wasm)[\"'`]",
    ),
}


class FirstLoad:
    """The files of the first page, and the bytes that come for them, headers included."""

    def __init__(self, port: int) -> None:
        self._connection = http.client.HTTPConnection("127.0.0.1", port)
        self.bytes: dict[str, int] = {}
        self._load("/")

    def _load(self, path: str) -> None:
        if path in self.bytes:
            return
        self._connection.request("GET", path, headers=BROWSER)
        answer = self._connection.getresponse()
        body = answer.read()
        assert answer.status == 200, path
        self.bytes[path] = len(body) + len(str(answer.headers)) + len("HTTP/1.1 200 OK\r\n")
        for pattern in LOADED.get(answer.headers.get_content_type(), ()):
            for found in re.findall(pattern, self._text(path)):
                self._load(urljoin(path, found))

    def _text(self, path: str) -> str:
        """The file as it is: Python has no brotli."""
        self._connection.request("GET", path, headers={"Accept-Encoding": "identity"})
        return self._connection.getresponse().read().decode()


@pytest.fixture(scope="module")
def first_load(robot: Stack) -> FirstLoad:
    return FirstLoad(robot.port)


def script_of(first_load: FirstLoad) -> str:
    [script] = [path for path in first_load.bytes if re.fullmatch(r"/assets/index-.{8}\.js", path)]
    return script


def test_the_first_load_stays_small(first_load: FirstLoad) -> None:
    endings = {path.rpartition(".")[2] for path in first_load.bytes if path != "/"}
    assert endings == {"js", "css", "svg", "wasm", "woff2"}
    assert sum(first_load.bytes.values()) <= LIMIT_BYTES, first_load.bytes


def test_each_form_of_a_file_is_the_same_file(robot: Stack, first_load: FirstLoad) -> None:
    visitor = robot.visitor()
    for path in first_load.bytes:
        plain = visitor.get(path, headers={"Accept-Encoding": "identity"})
        zipped = visitor.get(path, headers={"Accept-Encoding": "gzip"})
        assert zipped.content == plain.content, path
        assert int(plain.headers["content-length"]) == len(plain.content)
        head = visitor.head(path, headers={"Accept-Encoding": "gzip"})
        assert dict(head.headers) == dict(zipped.headers)
        assert head.content == b""


def test_a_file_that_the_browser_has_is_not_sent_again(robot: Stack, first_load: FirstLoad) -> None:
    visitor = robot.visitor()
    for path in ("/", script_of(first_load)):
        whole = visitor.get(path)
        again = visitor.get(path, headers={"If-None-Match": whole.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
        assert "content-length" not in again.headers
        kept = ("etag", "cache-control", "vary")
        assert [again.headers[name] for name in kept] == [whole.headers[name] for name in kept]
    # The connection is of use after an answer without a body.
    assert visitor.get("/").status_code == 200


def test_only_files_that_are_named_by_their_content_are_kept_without_asking(
    robot: Stack, first_load: FirstLoad
) -> None:
    kept = {path: robot.visitor().head(path).headers["cache-control"] for path in first_load.bytes}
    for path, control in kept.items():
        named = path.startswith("/assets/")
        assert control == ("public, max-age=31536000, immutable" if named else "no-cache"), path


@pytest.mark.parametrize("ending", [".br", ".gz"])
def test_compressed_files_have_no_address(robot: Stack, first_load: FirstLoad, ending: str) -> None:
    answer: httpx.Response = robot.visitor().get(script_of(first_load) + ending)
    assert answer.status_code == 404
