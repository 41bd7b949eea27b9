"""Asks the kernel for the owner of the program at the other end of a UNIX socket."""

from __future__ import annotations

import socket
import struct
from typing import NamedTuple


class Peer(NamedTuple):
    pid: int
    uid: int


def peer(connection: socket.socket) -> Peer:
    form = struct.Struct("3i")  # struct ucred: pid, uid, gid
    pid, uid, _ = form.unpack(connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, form.size))
    return Peer(pid, uid)
