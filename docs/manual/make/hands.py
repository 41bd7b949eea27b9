#!/usr/bin/python3
"""The hands of the manual's reader, where a page is run without one: what it does stands on the pages too.

A window is opened on a display of its own; its session begins by F5, Space squeezes, the mouse lifts, and after a
picture (window.png) it is closed. A session on real devices, which are fakes here, is ended by Ctrl-C when it has run
for two seconds. MATLAB is Octave.
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.environ["DIHAPTIC_PROGRAM"]
HERE = pathlib.Path(__file__).resolve().parent
SIZE = "1280x800"


class Display:
    """An X server of its own."""

    def __init__(self, home):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", SIZE + "x24"],
                                       pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ":" + pipe.readline().strip()
        self.environment = {**os.environ, "DISPLAY": self.name, "HOME": home, "XDG_RUNTIME_DIR": home}

    def do(self, *words):
        return subprocess.run(["xdotool", *words], env=self.environment, capture_output=True, text=True).stdout

    def picture(self, name):
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-f", "x11grab", "-video_size", SIZE, "-i", self.name,
                        "-frames:v", "1", name], check=True)

    def close(self):
        self.server.kill()
        self.server.wait()


def lift(display):
    """F5 begins, Space squeezes, the mouse lifts."""
    display.do("key", "F5")
    time.sleep(2)
    display.do("keydown", "space")
    time.sleep(1.5)
    for _ in range(60):
        display.do("mousemove_relative", "--", "0", "-2")
        time.sleep(0.016)
    time.sleep(1)


def use_window(arguments):
    with tempfile.TemporaryDirectory() as home:
        display = Display(home)
        window = subprocess.Popen([PROGRAM, *arguments], env=display.environment)
        try:
            title = " - Dihaptic" if len(arguments) > 1 else "^Dihaptic$"
            until = time.monotonic() + 60
            while not (found := display.do("search", "--onlyvisible", "--name", title).split()):
                if window.poll() is not None or time.monotonic() > until:
                    sys.exit("the window did not open")
                time.sleep(0.1)
            display.do("windowmove", found[-1], "0", "0", "windowsize", found[-1], *SIZE.split("x"),
                       "windowfocus", found[-1], "mousemove", "450", "450")
            time.sleep(2)
            if arguments[-1].endswith(".yaml"):
                lift(display)
            display.picture("window.png")
            display.do("keyup", "space", "key", "F7")
            time.sleep(1)
            display.do("key", "ctrl+q")
            return window.wait(60)
        finally:
            window.kill()
            display.close()


def use_devices(arguments):
    """A session that keeps real time is ended by Ctrl-C; it then is interrupted, as its reader is told."""
    with subprocess.Popen([PROGRAM, *arguments], stdout=subprocess.PIPE, text=True) as session:
        stopped = False
        for line in session.stdout:
            print(line, end="", flush=True)
            if "Ctrl-C switches force off" in line:
                time.sleep(2)
                session.send_signal(signal.SIGINT)
                stopped = True
    return 0 if stopped and session.returncode == 1 else session.returncode


def use_matlab(script):
    if shutil.which("octave") is None:
        print("Octave is not installed: what MATLAB does was not tried")
        return 0
    functions = HERE.parents[2] / "python/test/octave"
    return subprocess.run(["octave", "--no-gui", "--quiet", "--path", functions, "--eval", script]).returncode


def main():
    name, arguments = pathlib.Path(sys.argv[0]).name, sys.argv[1:]
    if name == "matlab":
        return use_matlab(arguments[-1])
    if arguments[:1] == ["gui"]:
        return use_window(arguments)
    if arguments[:1] == ["run"] and "--rig" in arguments:
        return use_devices(arguments)
    os.execv(PROGRAM, [PROGRAM, *arguments])


if __name__ == "__main__":
    sys.exit(main())
