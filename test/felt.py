"""What the makers' fake libraries show of their devices, in a file that they and the tests share (DIHAPTIC_FAKE_FELT)."""
import mmap
import struct
import time

from patience import patient


class Felt:
    """Per device: force, when it was last told one, its firmware's watchdog, when force last went, how often it was opened."""
    DEVICE = struct.Struct("5d")

    def __init__(self, file):
        with open(file, "w+b") as f:
            f.truncate(8 * self.DEVICE.size)
            self.map = mmap.mmap(f.fileno(), 0)

    def devices(self):
        return [self.DEVICE.unpack_from(self.map, i * self.DEVICE.size) for i in range(2)]

    def forces(self):
        """The forces that the devices were last told to exert [N]."""
        return [force for force, *_ in self.devices()]

    def opened(self):
        """How often each device was opened, by any process."""
        return [opened for *_, opened in self.devices()]

    def acting(self):
        """What pushes the hands now [N]."""
        now = time.monotonic()
        return [0 if watchdog > 0 and now - told > watchdog else force for force, told, watchdog, *_ in self.devices()]

    def wait_for_force(self, seconds=60, settle=0.1):
        end = time.monotonic() + patient(seconds)
        while time.monotonic() < end:
            if min(self.forces()) > 3.3:
                time.sleep(settle)
                return self.forces()
            time.sleep(0.0005)
        raise AssertionError(f"no force came: {self.devices()}")

    def gone_after(self, since, seconds):
        """Time from `since` until nothing pushes any hand [s]; None: something still does after so many seconds."""
        while time.monotonic() - since < seconds:
            if max(self.acting()) == 0:
                times = []
                for force, told, watchdog, gone, _ in self.devices():
                    times.append(told + watchdog - since if force > 0 else gone - since)
                return max(0, *times)  # a force that lasts one tick may already have ended
            time.sleep(0.0005)
        return None
