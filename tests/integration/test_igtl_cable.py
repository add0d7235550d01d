"""A controller whose cable is pulled: it lives in a network namespace of its own, and its end of the link
goes down. Needs root and iproute2, hence `make test-network`; without these it fails and says so."""

import os
import subprocess
import sys
from collections.abc import Iterator

import pytest
from conftest import RobotFile, StackFactory
from controllers import assert_rest_and_fresh_consent, connections, make_controller, ticks_around
from motion import is_driven, proposal, propose, to_motion, wait_for_proposal, wait_until

pytestmark = pytest.mark.network

ROBOT, PROGRAM = "198.18.71.1", "198.18.71.2"  # of the range for tests of networks
LISTENER = """
import socket, sys
peer = socket.create_connection((sys.argv[1], int(sys.argv[2])))
while peer.recv(65536):
    pass
"""


class Cable:
    """A link between this machine and a namespace that stands for another one."""

    def __init__(self) -> None:
        self._name = f"ilk{os.getpid() % 100000}"

    def lay(self) -> None:
        near, far = f"{self._name}a", f"{self._name}b"
        ip("netns", "add", self._name)
        ip("link", "add", near, "type", "veth", "peer", "name", far, "netns", self._name)
        ip("address", "add", f"{ROBOT}/30", "dev", near)
        ip("link", "set", near, "up")
        ip("-netns", self._name, "address", "add", f"{PROGRAM}/30", "dev", far)
        ip("-netns", self._name, "link", "set", far, "up")

    def pull(self) -> None:
        """No packet passes any more, and nobody is told."""
        ip("-netns", self._name, "link", "set", f"{self._name}b", "down")

    def remove(self) -> None:
        subprocess.run(["ip", "netns", "delete", self._name], check=False)

    def start(self, code: str, *arguments: str) -> subprocess.Popen:
        """Python on the other machine."""
        return subprocess.Popen(["ip", "netns", "exec", self._name, sys.executable, "-c", code, *arguments])


def ip(*arguments: str) -> None:
    try:
        subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)
    except (OSError, subprocess.CalledProcessError) as error:
        reason = getattr(error, "stderr", "") or str(error)
        pytest.fail(
            f"ip {' '.join(arguments)}: {reason.strip()}. A pulled cable needs a network namespace: run "
            "`make test-network` as root, in a container with CAP_SYS_ADMIN and CAP_NET_ADMIN, where the "
            "package iproute2 is installed."
        )


@pytest.fixture
def cable() -> Iterator[Cable]:
    laid = Cable()
    try:
        laid.lay()
        yield laid
    finally:
        laid.remove()


def test_a_pulled_cable_pauses_the_motion_within_300_ms_and_every_program_behind_it_is_dropped(
    stack: StackFactory, robot_file: RobotFile, cable: Cable
) -> None:
    """None of them sends anything, so that only what TCP does not acknowledge tells."""
    robot = stack(speed=1, robot=robot_file(bind=ROBOT, allow=[PROGRAM]), igtl=True)
    port = robot.output.wait_for(rf"OpenIGTLink {ROBOT}:(\d+)$")[1]
    programs = [cable.start(LISTENER, ROBOT, port) for _ in range(2)]
    try:
        wait_until("both connected", lambda: len(connections(robot)) == 2)
        make_controller(robot, 0)
        to_motion(robot)
        number = propose(robot, -1900)
        wait_until("driven", lambda: is_driven(robot))
        pulled_between = ticks_around(robot, cable.pull)
        assert proposal(robot, number)["state"] == "executing", "not noticed before it was pulled"
        wait_for_proposal(robot, number, "paused")
        assert_rest_and_fresh_consent(robot, number, pulled_between)
        wait_until("both dropped", lambda: connections(robot) == [])
    finally:
        for program in programs:
            program.kill()
            program.wait()
