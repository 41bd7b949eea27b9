#!/usr/bin/python3
"""The hands of the manual's reader, when a page is run without one; the pages describe the same actions.

A window opens on its own display; F5 starts its session, Space squeezes, the mouse lifts, and after a picture
(window.png) the window is closed. A session in real time (real devices are fakes here) is ended by Ctrl-C after two
seconds. Octave replaces MATLAB.
"""
import glob
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.environ["DIHAPTIC_PROGRAM"]
HERE = pathlib.Path(__file__).resolve().parent
PROJECT = HERE.parents[2]
SIZE = "1280x800"


class Display:
    """A separate X server."""

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

    def windows(self, title):
        return self.do("search", "--onlyvisible", "--name", title).split()

    def picture(self, name):
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-f", "x11grab", "-video_size", SIZE, "-i", self.name,
                        "-frames:v", "1", name], check=True)

    def close(self):
        self.server.kill()
        self.server.wait()


def move_up(display, pixels):
    """Sixty times per second, like a hand."""
    for _ in range(abs(pixels) // 2):
        display.do("mousemove_relative", "--", "0", "-2" if pixels > 0 else "2")
        time.sleep(0.016)


def wait(what, condition):
    """Waits until the condition holds: on a busy machine no fixed time would be long enough."""
    until = time.monotonic() + 60
    while not (value := condition()):
        if time.monotonic() > until:
            sys.exit(f"waited in vain for {what}")
        time.sleep(0.1)
    return value


def lift(display, window, file):
    """F5 starts, Space squeezes, the mouse lifts. A window with trials first asks for the participant; there the hand
    starts above the object."""
    before = len(glob.glob("sessions/*/raw.log"))
    display.do("key", "F5")
    at = pathlib.Path(file) if os.path.exists(file) else PROJECT / file  # one that comes with the program
    trials = "\ntask:" in at.read_text()
    if trials:
        asked = wait("the question who does the trials", lambda: display.windows("^Who does the trials"))
        display.do("windowfocus", asked[-1], "type", "--delay", "50", "S07")
        display.do("key", "Return")
        time.sleep(1)
        if display.windows("^Who does the trials"):  # asks whether this is the same person as before
            display.do("key", "space")
            display.do("key", "Return")
        wait("the answer", lambda: not display.windows("^Who does the trials"))
        display.do("windowfocus", window)  # there is no window manager that would
    wait("the session", lambda: len(glob.glob("sessions/*/raw.log")) > before)
    time.sleep(1)
    if trials:
        move_up(display, -120)
    display.do("keydown", "space")
    time.sleep(1.5)
    move_up(display, 120)
    time.sleep(1)


def use_window(arguments):
    with tempfile.TemporaryDirectory() as home:
        display = Display(home)
        program = subprocess.Popen([PROGRAM, *arguments], env=display.environment)
        try:
            title = " - Dihaptic" if len(arguments) > 1 else "^Dihaptic$"
            window = wait("the window", lambda: display.windows(title))[-1]
            display.do("windowmove", window, "0", "0", "windowsize", window, *SIZE.split("x"), "windowfocus", window,
                       "mousemove", "450", "450")
            time.sleep(2)
            if arguments[-1].endswith(".yaml"):
                lift(display, window, arguments[-1])
            display.picture("window.png")
            display.do("keyup", "space", "key", "F7")

            def closed():
                display.do("windowfocus", window, "key", "ctrl+q")
                time.sleep(1)
                return program.poll() is not None

            wait("the window's end", closed)
            return program.returncode
        except SystemExit:
            display.picture("waited-in-vain.png")
            raise
        finally:
            program.kill()
            display.close()


def use_devices(arguments):
    """A session in real time is ended by Ctrl-C; it is then interrupted, as described to the reader."""
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
    functions = HERE.parents[2] / "python/test/octave"
    return subprocess.run(["octave", "--no-gui", "--quiet", "--path", functions, "--eval", script]).returncode


def main():
    name, arguments = pathlib.Path(sys.argv[0]).name, sys.argv[1:]
    if name == "matlab":
        return use_matlab(arguments[-1])
    if arguments[:1] == ["gui"]:
        return use_window(arguments)
    if arguments[:1] == ["resume"] or "--rig" in arguments and "run" in arguments:
        return use_devices(arguments)
    os.execv(PROGRAM, [PROGRAM, *arguments])


if __name__ == "__main__":
    sys.exit(main())
