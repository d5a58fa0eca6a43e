"""Fails unless a DrmProjector in a guest shows the right pixels on its connector and outlives all that can happen
to a projector's cable: drm_test.py DRM_GUEST KERNEL. The guest has a touchscreen at Virtual-1, never touched by
the test, and a projector at Virtual-2."""

import json
import pathlib
import re
import shutil
import sys
import tempfile
import time

import initramfs
import machine

QEMU = "qemu-system-x86_64"
MODULES = ("virtio_pci", "virtio_console", "virtio_gpu")
SKIPPED = 77
HOTPLUG_LIMIT_S = 10
WIDTH, HEIGHT = 1024, 768
EDID = "RHT 1234"  # of every QEMU display
# Offered only by a display that prefers this size, unlike the same size at 60 Hz.
CALIBRATED = f"{WIDTH} {HEIGHT} 75"
LOST = "error: projector at Virtual-2: "


def check(name, found, expected):
    if found != expected:
        sys.exit(f"{name}: found\n  {found}\nnot\n  {expected}")
    print(f"{name}: as expected", flush=True)


def until(name, attempt, pattern, meanwhile="ok.*"):
    """Repeats a question until its answer is the expected one; `meanwhile` is what it may be before."""
    end = time.monotonic() + HOTPLUG_LIMIT_S
    answer = attempt()
    while not re.fullmatch(pattern, answer) and re.fullmatch(meanwhile, answer) and time.monotonic() < end:
        time.sleep(0.1)
        answer = attempt()
    if not re.fullmatch(pattern, answer):
        sys.exit(f"{name}: the answer is\n  {answer}\nnot\n  {pattern}")
    print(f"{name}: {answer}", flush=True)


def gray_level(pattern, x, y):
    """Of a pattern as drm_guest names it, 0 to 255: the definition of the Gray code, not our renderer."""
    kind, *parts = pattern.split()
    if kind == "ramp":
        return (x + y) % 256
    if kind != "gray":
        return {"white": 255, "black": 0}[kind]
    index = y if parts[0] == "row" else x
    lit = (index ^ index >> 1) >> int(parts[1]) & 1
    return 255 * (lit ^ (parts[2:] == ["inverted"]))


def rendered(pattern):
    if pattern.startswith("gray column"):
        rows = [bytes(gray_level(pattern, x, 0) for x in range(WIDTH) for _ in range(3))] * HEIGHT
    elif pattern == "ramp":
        rows = [bytes(gray_level(pattern, x, y) for x in range(WIDTH) for _ in range(3)) for y in range(HEIGHT)]
    else:
        rows = [bytes([gray_level(pattern, 0, y)]) * 3 * WIDTH for y in range(HEIGHT)]
    return b"".join(rows)


class Test:
    def __init__(self, guest):
        self.guest = guest
        self.touchscreen = guest.screenshot(0).rgb

    def open(self, mode=CALIBRATED):
        return self.guest.ask(f"open {mode} Virtual-2 {EDID}")

    def check_wall(self, pattern):
        """QEMU draws what the guest flipped to a moment later."""
        expected = rendered(pattern)
        end = time.monotonic() + HOTPLUG_LIMIT_S
        picture = self.guest.screenshot(1)
        while picture.rgb != expected and time.monotonic() < end:
            time.sleep(0.05)
            picture = self.guest.screenshot(1)
        check(f"size of {pattern}", picture.size, (WIDTH, HEIGHT))
        wrong = sum(a != b for a, b in zip(picture.rgb, expected)) if picture.rgb != expected else 0
        check(f"wrong bytes of {pattern}", wrong, 0)

    def check_show(self, pattern):
        status, flip_us, now_us = self.guest.ask(f"show {pattern}").split()
        check(f"show {pattern}", (status, 0 <= int(now_us) - int(flip_us) < 1_000_000), ("ok", True))
        self.check_wall(pattern)

    def nothing_plugged_in(self):
        outputs = json.loads(self.guest.ask("list").removeprefix("ok "))
        check("outputs", [(output["connector"], output["edid"]) for output in outputs],
              [("Virtual-1", EDID), ("Virtual-2", "")])
        check("open without a projector", self.open(),
              f"error: projector: needs the projector {EDID} at Virtual-2, but nothing is plugged in; plugged in: "
              f"Virtual-1: {EDID}, Virtual-2: nothing")

    def plug_in(self, name):
        self.guest.projector.resize(WIDTH, HEIGHT)
        until(name, self.open, "ok", "error: projector: needs .*")

    def shows_patterns(self):
        self.check_wall("black")
        for pattern in ("white", "gray column 9", "gray column 0", "gray row 3 inverted", "ramp", "black"):
            self.check_show(pattern)
        check("two masters", self.guest.ask("second"),
              "error: /dev/dri/card0: the displays are driven by another program, such as a desktop: "
              "Device or resource busy")

    def survives_unplugging(self):
        self.check_show("gray column 4")
        self.guest.projector.unplug()
        until("unplugged", lambda: self.guest.ask("show white"), LOST + "was unplugged or switched off")
        check("still unplugged", self.guest.ask("show white"), LOST + "was lost and must be opened again")
        self.nothing_plugged_in()
        self.plug_in("plugged in again")
        self.check_show("gray row 4")

    def refuses_another_mode(self):
        self.guest.projector.resize(1280, 800)
        until("another mode", lambda: self.guest.ask("show white"),
              LOST + "changed its mode: it asks for 1280 x 800 at 74.99 Hz, and was opened when it asked for "
              "1024 x 768 at 74.99 Hz")
        until("open in another mode", self.open,
              "error: projector: needs 1024 x 768 at 75 Hz, the mode of the calibration; RHT 1234 at Virtual-2 "
              "offers 1280 x 800 at 74.99 Hz, .*1024 x 768 at 60 Hz.*")
        self.plug_in("the calibrated mode again")
        self.check_show("gray column 2 inverted")

    def stays_lit_and_black(self):
        check("close", self.guest.ask("close"), "ok")
        self.check_wall("black")
        check("closed", self.guest.ask("show white"), "error: projector: is closed, not open")
        check("open again", self.open(), "ok")
        self.check_show("white")

    def leaves_nothing_open(self):
        before = self.guest.ask("descriptors")
        for lost in (False, True) * 5:
            if lost:
                self.guest.projector.unplug()
                until("unplugged once more", lambda: self.guest.ask("show black"),
                      LOST + "was unplugged or switched off")
                self.plug_in("plugged in once more")
            check("close and open", (self.guest.ask("close"), self.open()), ("ok", "ok"))
        check("open descriptors", self.guest.ask("descriptors"), before)

    def run(self):
        self.nothing_plugged_in()
        self.plug_in("plugged in")
        self.shows_patterns()
        self.survives_unplugging()
        self.refuses_another_mode()
        self.stays_lit_and_black()
        self.leaves_nothing_open()
        check("touchscreen shows something", len(set(self.touchscreen)) > 1, True)
        check("touchscreen untouched", self.guest.screenshot(0).rgb == self.touchscreen, True)


def main(program, kernel):
    if shutil.which(QEMU) is None:
        print(f"SKIPPED: {QEMU} is missing, so the DRM projector was NOT tested; run tools/setup --tests")
        sys.exit(SKIPPED)
    kernel = pathlib.Path(kernel)
    with tempfile.TemporaryDirectory() as folder:
        boot = machine.Machine(QEMU, kernel, initramfs.build(program, kernel, MODULES), folder)
        try:
            with boot as guest:
                check("greeting", guest.greeting, "ok")
                Test(guest).run()
        except BaseException:
            print(boot.console())
            raise


main(*sys.argv[1:])
