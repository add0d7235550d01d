"""The app has nothing in its hands by which it could reach the bus: no descriptor, no mapping, no capability.

Each look is tried on the kernel as well, which does hold the bus: a look that finds nothing there is blind.
"""

import os
import re
import socket
import struct
from pathlib import Path

import pytest
from conftest import StackFactory
from stack import Stack

NETLINK_SOCK_DIAG, SOCK_DIAG_BY_FAMILY, NLMSG_DONE = 4, 20, 3
NLM_F_REQUEST_DUMP = 0x301
UDIAG_SHOW_NAME, UDIAG_SHOW_PEER = 1, 4
UNIX_DIAG_NAME, UNIX_DIAG_PEER = 0, 2
HEADER = struct.Struct("=IHHII")
UNIX_MESSAGE = struct.Struct("=BBBBIII")
ATTRIBUTE = struct.Struct("=HH")
CARD_DEVICE = re.compile(r"/dev/(spidev|gpiochip|mem|port|i2c|uio|vfio|kmem)")
HARMLESS_DEVICES = {"/dev/null", "/dev/urandom", "/dev/random"}


@pytest.fixture
def robot(stack: StackFactory) -> Stack:
    return stack(realtime=True)


def unix_sockets() -> dict[int, tuple[str, int]]:
    """Name and peer's inode of each Unix socket, by its inode, as the system tells it."""
    request = struct.pack(
        "=BBHIIIII", socket.AF_UNIX, 0, 0, 0xFFFFFFFF, 0, UDIAG_SHOW_NAME | UDIAG_SHOW_PEER, 0, 0
    )
    found: dict[int, tuple[str, int]] = {}
    with socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, NETLINK_SOCK_DIAG) as asked:
        head = HEADER.pack(HEADER.size + len(request), SOCK_DIAG_BY_FAMILY, NLM_F_REQUEST_DUMP, 1, 0)
        asked.send(head + request)
        while True:
            data = asked.recv(1 << 18)
            while data:
                length, kind, *_ = HEADER.unpack_from(data)
                if kind == NLMSG_DONE:
                    return found
                inode, told = socket_of(data[HEADER.size : length])
                found[inode] = told
                data = data[(length + 3) & ~3 :]


def socket_of(message: bytes) -> tuple[int, tuple[str, int]]:
    inode = UNIX_MESSAGE.unpack_from(message)[4]
    name, peer = "", 0
    place = UNIX_MESSAGE.size
    while place + ATTRIBUTE.size <= len(message):
        length, kind = ATTRIBUTE.unpack_from(message, place)
        value = message[place + ATTRIBUTE.size : place + length]
        if kind == UNIX_DIAG_NAME:
            name = value.rstrip(b"\0").decode(errors="replace")
        elif kind == UNIX_DIAG_PEER:
            peer = int.from_bytes(value, "little")
        place += (length + 3) & ~3
    return inode, (name, peer)


def descriptors(pid: int) -> list[str]:
    """What each descriptor of the process is open to."""
    return [str(entry.readlink()) for entry in Path(f"/proc/{pid}/fd").iterdir()]


def sockets_of(pid: int) -> list[int]:
    """Inodes of the sockets that the process holds."""
    return [int(match[1]) for each in descriptors(pid) if (match := re.fullmatch(r"socket:\[(\d+)\]", each))]


def sockets_reached(pid: int) -> set[str]:
    """Names of the Unix sockets at the other end of those of the process."""
    known = unix_sockets()
    peers = [known[inode][1] for inode in sockets_of(pid) if inode in known]
    return {Path(known[peer][0]).name for peer in peers if peer in known and known[peer][0]}


def mappings(pid: int) -> list[tuple[str, str]]:
    """Rights and file of each mapping that the process shares; programs and libraries are private."""
    maps = Path(f"/proc/{pid}/maps").read_text()
    found = re.findall(r"^\S+ (\S+) \S+ \S+ \d+ +(/.*)$", maps, re.MULTILINE)
    return [(rights, file) for rights, file in found if rights.endswith("s")]


def status_of(pid: int, field: str) -> int:
    match = re.search(rf"^{field}:\s+(\w+)$", Path(f"/proc/{pid}/status").read_text(), re.MULTILINE)
    assert match is not None, field
    return int(match[1], 16)


def test_no_descriptor_of_the_app_leads_to_the_bus(robot: Stack) -> None:
    assert "bus.sock" in sockets_reached(robot.pid("kernel"))
    known = unix_sockets()
    of_the_watchdog = {known[inode][0] for inode in sockets_of(robot.run.pid) if inode in known}
    assert sockets_reached(robot.pid("app")) <= {"link.sock", "control.sock"} | of_the_watchdog
    assert "link.sock" in sockets_reached(robot.pid("app"))


def test_no_descriptor_of_the_app_is_a_device_of_cards_or_of_the_kernels_memory(robot: Stack) -> None:
    opened = descriptors(robot.pid("app"))
    devices = {each for each in opened if each.startswith("/dev/")}
    assert devices <= HARMLESS_DEVICES
    assert not [each for each in opened if CARD_DEVICE.match(each) or "black-box" in each]
    assert [each for each in descriptors(robot.pid("kernel")) if "memfd:interlock-black-box" in each]
    memories = [each for each in opened if each.startswith("/memfd:")]
    assert len(memories) <= 2, "kernel to app and app to kernel; the bus has none"


def test_the_app_maps_of_the_kernel_only_what_the_link_gives_and_the_snapshot_unwritable(
    robot: Stack,
) -> None:
    app, kernel = mappings(robot.pid("app")), mappings(robot.pid("kernel"))
    shared = [(rights, file) for rights, file in app if file.startswith("/memfd:")]
    assert sorted(rights for rights, _ in shared) == ["r--s", "rw-s"]
    others = [file for _, file in app if not file.startswith("/memfd:")]
    assert all(file.startswith(str(robot.state)) for file in others), others
    assert [file for _, file in kernel if "memfd:interlock-black-box" in file]
    assert not [file for _, file in app if "black-box" in file or file.startswith("/dev/")]


def test_the_app_gives_up_every_capability_even_when_root_starts_it(robot: Stack) -> None:
    app = robot.pid("app")
    for thread in Path(f"/proc/{app}/task").iterdir():
        for held in ("CapInh", "CapPrm", "CapEff", "CapAmb"):
            assert status_of(int(thread.name), held) == 0, held
        assert status_of(int(thread.name), "NoNewPrivs") == 1
    if os.geteuid() == 0:
        assert status_of(robot.pid("kernel"), "CapEff") != 0
