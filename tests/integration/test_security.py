"""What a hostile page, a borrowed cookie or a guesser of passwords gets from a whole robot.

Rights by route: test_roles.py."""

import concurrent.futures
import itertools
import re
import threading
from html.parser import HTMLParser

import httpx
import pytest
from interface import judge, paths
from stack import Stack
from test_roles import IN_PATH

POLICY = {
    "default-src": "'self'",
    "script-src": "'self' 'wasm-unsafe-eval'",
    "connect-src": "'self'",
    "img-src": "'self' data:",
    "object-src": "'none'",
    "base-uri": "'none'",
    "form-action": "'none'",
    "frame-ancestors": "'none'",
}
WRITING = [
    pytest.param(method, path, id=f"{method} {path}")
    for path, methods in paths().items()
    for method in methods
    if method != "get"
]
# Wrong passwords that cost no delay, and the longest delay: app/service/login_guard.cpp.
FREE_ATTEMPTS = 3
LONGEST_DELAY_S = 4


class Page(HTMLParser):
    """What a page loads, and what it would run by itself."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.inline: list[str] = []
        self._open = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._open = tag
        for name, value in attrs:
            if name in ("src", "href") and value:
                self.loaded.append(value)
            if name == "style" or name.startswith("on") or (value or "").startswith("javascript:"):
                self.inline.append(f"{tag} {name}")

    def handle_data(self, data: str) -> None:
        if self._open in ("script", "style") and data.strip():
            self.inline.append(f"{self._open}: {data}")

    def handle_endtag(self, tag: str) -> None:
        self._open = ""


def token_of(client: httpx.Client) -> str:
    [token] = [
        cookie.value for cookie in client.cookies.jar if re.fullmatch(r"interlock_session_\d+", cookie.name)
    ]
    assert token
    return token


def log_in(client: httpx.Client, name: str, password: str) -> httpx.Response:
    return judge(client.post("/api/login", json={"name": name, "password": password}))


def test_the_page_runs_nothing_inline_and_loads_nothing_from_elsewhere(robot: Stack) -> None:
    page = Page(robot.visitor().get("/").raise_for_status().text)
    assert page.inline == []
    assert page.loaded
    assert [each for each in page.loaded if not re.match(r"/(?!/)", each)] == []


def test_every_kind_of_answer_carries_the_strict_policy_and_opens_nothing_to_other_origins(
    robot: Stack,
) -> None:
    visitor = robot.visitor()
    scripts = [each for each in Page(visitor.get("/").text).loaded if each.endswith(".js")]
    assert scripts
    foreign = {"Origin": "http://evil.example", "Access-Control-Request-Method": "POST"}
    answers = [
        visitor.request(method, path, headers=headers)
        for headers in ({}, foreign)
        for method, path in (
            ("GET", "/"),
            *(("GET", script) for script in scripts),
            ("GET", "/api/status"),
            ("GET", "/api/motors"),
            ("GET", "/nothing"),
            ("OPTIONS", "/api/stop"),
        )
    ]
    for answer in answers:
        policy = dict(
            part.strip().split(" ", 1) for part in answer.headers["content-security-policy"].split(";")
        )
        assert policy == POLICY, answer.url
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "no-referrer"
        assert answer.headers["cross-origin-resource-policy"] == "same-origin"
        assert not [name for name in answer.headers if name.startswith("access-control-")]


def test_cookies_are_out_of_reach_of_scripts_and_other_sites(robot: Stack) -> None:
    visitor = robot.visitor()
    answer = log_in(visitor, "admin", robot.password)
    session, browser = answer.headers.get_list("set-cookie")
    for cookie, name, seconds in ((session, "", 43200), (browser, "_browser", 90 * 24 * 3600)):
        pair, *attributes = cookie.split("; ")
        assert re.fullmatch(rf"interlock_session_{robot.port}{name}=[\w-]{{32,}}", pair)
        assert sorted(attributes) == ["HttpOnly", f"Max-Age={seconds}", "Path=/", "SameSite=Strict"]
    assert token_of(visitor) not in answer.text


def test_a_session_that_somebody_else_chose_is_never_entered(robot: Stack) -> None:
    name = f"interlock_session_{robot.port}"
    attacker = robot.client("admin", robot.password)
    chosen = token_of(attacker)
    for fixed in (chosen, "A" * len(chosen), ""):
        victim = robot.visitor()
        victim.cookies.set(name, fixed)
        given = log_in(victim, "admin", robot.password).headers["set-cookie"]
        assert fixed == "" or fixed not in given
    assert judge(attacker.get("/api/session")).json()["user"] is None


def test_a_session_that_ended_is_not_entered_again(robot: Stack) -> None:
    client = robot.client("admin", robot.password)
    kept = token_of(client)
    judge(client.post("/api/logout"))
    thief = robot.visitor()
    thief.cookies.set(f"interlock_session_{robot.port}", kept)
    answer = thief.get("/api/motors")
    assert (judge(answer).status_code, answer.json()["code"]) == (401, "LOGIN")


@pytest.mark.parametrize("origin", ["http://evil.example", "null"])
@pytest.mark.parametrize(("method", "path"), WRITING)
def test_a_page_of_another_origin_can_do_nothing_with_the_holders_cookie(
    robot: Stack, method: str, path: str, origin: str
) -> None:
    target = re.sub(r"\{(\w+)\}", lambda name: IN_PATH[name[1]], path)
    answer = judge(robot.api.request(method, target, json={}, headers={"Origin": origin}))
    assert (answer.status_code, answer.json()["code"]) == (403, "ORIGIN")


def test_guesses_take_ever_longer_and_the_right_password_is_let_in_after_seconds(robot: Stack) -> None:
    robot.client_of_new("ann", "engineer")
    robot.client_of_new("bob", "engineer")
    guesser = robot.visitor()
    for _ in range(FREE_ATTEMPTS + 3):
        assert log_in(guesser, "ann", "a guess").status_code == 401
    assert log_in(guesser, "ann", "a guess").elapsed.total_seconds() >= LONGEST_DELAY_S
    answer = log_in(robot.visitor(), "ann", "password of ann")
    assert answer.status_code == 200
    assert answer.elapsed.total_seconds() >= LONGEST_DELAY_S
    assert log_in(robot.visitor(), "bob", "password of bob").status_code == 200


def test_guesses_at_the_same_time_are_no_way_around_the_delay(robot: Stack) -> None:
    robot.client_of_new("cleo", "engineer")
    for _ in range(FREE_ATTEMPTS):
        log_in(robot.visitor(), "cleo", "a guess")
    guessers = [robot.visitor() for _ in range(8)]
    with concurrent.futures.ThreadPoolExecutor(len(guessers)) as pool:
        answers = list(pool.map(log_in, guessers, itertools.repeat("cleo"), map(str, range(len(guessers)))))
    judged = [answer for answer in answers if answer.json()["code"] == "CREDENTIALS"]
    assert all(answer.elapsed.total_seconds() >= 1 for answer in judged)
    assert {answer.status_code for answer in answers if answer not in judged} <= {429}


def test_a_browser_that_its_user_has_used_is_not_kept_out_by_a_flood_of_guesses(robot: Stack) -> None:
    robot.client_of_new("dora", "engineer")
    browser = robot.visitor()
    assert log_in(browser, "dora", "password of dora").status_code == 200
    judge(browser.post("/api/logout"))
    end = threading.Event()

    def guess(guesser: httpx.Client) -> None:
        while not end.is_set():
            log_in(guesser, "dora", "a guess")

    stranger = robot.visitor()
    guessers = [robot.visitor() for _ in range(8)]
    with concurrent.futures.ThreadPoolExecutor(len(guessers)) as pool:
        guesses = [pool.submit(guess, guesser) for guesser in guessers]
        try:
            while log_in(stranger, "dora", "another guess").status_code != 429:
                pass
            assert log_in(browser, "dora", "password of dora").status_code == 200
        finally:
            end.set()
        for each in guesses:
            each.result()


def test_an_unknown_name_is_told_apart_from_a_wrong_password_by_nothing(robot: Stack) -> None:
    robot.client_of_new("dan", "engineer")
    known, unknown = (
        [log_in(robot.visitor(), name, "a wrong password") for _ in range(FREE_ATTEMPTS)]
        for name in ("dan", "nosuchuser2")
    )
    assert [answer.status_code for answer in known] == [401] * FREE_ATTEMPTS
    assert [answer.json() for answer in known] == [answer.json() for answer in unknown]
