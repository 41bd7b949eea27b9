"""A program of another user, which answers where one of ours is expected."""

import subprocess


def stranger(test, code, where):
    """Runs Python code as nobody until `test` ends. It finds `where` in sys.argv[1], and has printed `there`."""
    process = subprocess.Popen(
        ["/usr/bin/python3", "-c", "import socket, sys;" + code + "; sys.stdin.read()", where],
        user=65534, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    test.addCleanup(process.wait)
    test.addCleanup(process.stdin.close)
    test.addCleanup(process.stdout.close)
    test.assertEqual(process.stdout.readline(), b"there\n")
